// Which maps there are and which one is shown.

import { get } from "../page/api.js";
import { $, html } from "../page/dom.js";

const POLL_MS = 5000;

export class Maps {
  /** `chosen(name)` hears which map is shown, `listed()` that some map changed. */
  constructor(chosen, listed) {
    this.chosen = chosen;
    this.listed = listed;
    this.all = [];
    this.wanted = "";
    $("map-name").addEventListener("change", (event) => this.choose(event.target.value));
    setInterval(() => document.hidden || this.refresh(), POLL_MS);
  }

  get name() {
    return $("map-name").value;
  }

  get names() {
    return this.all.map((map) => map.name);
  }

  /** Show this map, now or as soon as it exists. */
  want(name) {
    this.wanted = name;
    if (this.names.includes(name)) this.choose(name);
    else this.refresh();
  }

  async refresh() {
    const [before, told] = [this.names.join(), JSON.stringify(this.all)];
    try {
      this.all = await get("/api/maps");
    } catch {
      return; // the graph says what is wrong
    }
    if (JSON.stringify(this.all) !== told) this.listed();
    if (this.names.join() === before) return;
    const shown = this.name;
    $("map-name").replaceChildren(...this.names.map((name) => html("option", { value: name }, name)));
    $("map-names").replaceChildren(...this.names.map((name) => html("option", { value: name })));
    this.choose([this.wanted, shown].find((name) => this.names.includes(name)) ?? this.names[0] ?? "");
  }

  choose(name) {
    if (this.names.includes(this.wanted)) this.wanted = "";
    $("map-name").value = name;
    this.chosen(name);
  }
}
