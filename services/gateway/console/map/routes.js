// Routes of the shown map: listed, drawn when chosen, driven there and back, removed.

import { call } from "../page/api.js";
import { confirmed } from "../page/ask.js";
import { $, html, table } from "../page/dom.js";
import { TEXT } from "../page/text.js";

export class Routes {
  /** `drive(name, reverse)` starts a mission, `say(text)` of refusals. */
  constructor(graph, drive, say) {
    Object.assign(this, { graph, drive, say });
    graph.onMarks.push(() => this.show());
  }

  show() {
    const rows = this.graph.routes.map((route) => [
      html("button", { type: "button", class: "link", "aria-pressed": String(route.name === this.graph.route),
        onclick: () => this.choose(route.name) }, route.name),
      TEXT.route(route),
      html("span", { class: "row" },
        html("button", { type: "button", onclick: () => this.drive(route.name, false) }, TEXT.driveRoute),
        html("button", { type: "button", title: TEXT.backwards, onclick: () => this.drive(route.name, true) }, TEXT.driveBack),
        html("button", { type: "button", class: "danger", onclick: () => this.remove(route.name) }, TEXT.remove)),
    ]);
    $("routes").replaceChildren(...(rows.length ? [table(TEXT.routeColumns, rows)] : []));
  }

  /** Draw it; once more, and it is drawn no longer. */
  choose(name) {
    this.graph.showRoute(name === this.graph.route ? null : name);
    this.show();
  }

  async remove(name) {
    if (!(await confirmed(TEXT.removeRoute(name), TEXT.remove))) return;
    try {
      await call("DELETE", `/api/maps/${this.graph.map}/routes?name=${encodeURIComponent(name)}`);
      this.say("");
    } catch (problem) {
      this.say(problem.message);
    }
    await this.graph.load();
  }
}
