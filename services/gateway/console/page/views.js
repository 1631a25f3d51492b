// Which cards show: one view at a time, named in the address, so that it can be linked and the back button works.

import { $ } from "./dom.js";

const FIRST = "drive";

export class Views {
  /** `shown(view)` hears of every change. */
  constructor(shown) {
    this.shown = shown;
    this.tabs = [...document.querySelectorAll("nav a[data-view]")];
    addEventListener("hashchange", () => this.show());
    addEventListener("keydown", (event) => this.key(event));
    this.show();
  }

  get name() {
    const wanted = location.hash.slice(1);
    return this.tabs.some((tab) => tab.dataset.view === wanted) ? wanted : FIRST;
  }

  show() {
    const view = this.name;
    document.body.dataset.view = view;
    for (const tab of this.tabs) {
      if (tab.dataset.view === view) tab.setAttribute("aria-current", "page");
      else tab.removeAttribute("aria-current");
    }
    for (const card of document.querySelectorAll("main > [data-views]")) {
      card.hidden = !card.dataset.views.split(" ").includes(view);
    }
    this.shown(view);
  }

  go(view) {
    location.hash = view;
  }

  /** Alt and a digit choose a view; "/" goes to the search of nodes. */
  key(event) {
    const typing = event.target.closest?.("input, select, textarea, dialog");
    if (event.altKey && this.tabs[Number(event.key) - 1]) {
      event.preventDefault();
      this.go(this.tabs[Number(event.key) - 1].dataset.view);
    } else if (event.key === "/" && !typing) {
      event.preventDefault();
      if (this.name !== "map") this.go("map");
      setTimeout(() => $("find").focus());
    }
  }
}
