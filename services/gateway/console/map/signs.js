// Signs that robots read in the shown map: listed, searched with the places, driven to, forgotten.

import { call, get } from "../page/api.js";
import { confirmed } from "../page/ask.js";
import { $, html, table } from "../page/dom.js";
import { TEXT } from "../page/text.js";

const SHOWN = 20; // a hospital has hundreds: the others are searched

export class Signs {
  /** `goTo(sign)` starts a mission, `open(node)` shows a node, `say(text)` of refusals. */
  constructor(graph, goTo, open, say) {
    Object.assign(this, { graph, goTo, open, say });
    $("place-search").addEventListener("input", () => this.show());
    graph.onMarks.push(() => this.show());
  }

  async show() {
    const { map } = this.graph;
    const text = $("place-search").value.trim();
    let { signs } = this.graph;
    try {
      if (text && map && signs.length) signs = await get(`/api/maps/${map}/signs?search=${encodeURIComponent(text)}`);
    } catch (problem) {
      this.say(problem.message);
    }
    if (map !== this.graph.map || text !== $("place-search").value.trim()) return;
    const rows = signs.slice(0, SHOWN).map((sign) => this.row(sign));
    const more = signs.length > SHOWN ? [html("p", { class: "quiet" }, TEXT.moreSigns(signs.length - SHOWN))] : [];
    $("signs").replaceChildren(...(rows.length ? [table(TEXT.signColumns, rows), ...more] : []));
  }

  row({ name, sightings: [best] }) {
    return [
      html("button", { type: "button", class: "link", onclick: () => best && this.open(best.node) }, name),
      best ? TEXT.node(best.node) : TEXT.emptied,
      html("span", { class: "row" },
        html("button", { type: "button", onclick: () => this.goTo(name) }, TEXT.goThere),
        html("button", { type: "button", class: "danger", onclick: () => this.forget(name) }, TEXT.forget)),
    ];
  }

  async forget(name) {
    if (!(await confirmed(TEXT.forgetSign(name), TEXT.forget))) return;
    try {
      await call("DELETE", `/api/maps/${this.graph.map}/signs?name=${encodeURIComponent(name)}`);
      this.say("");
    } catch (problem) {
      this.say(problem.message);
    }
    await this.graph.load();
  }
}
