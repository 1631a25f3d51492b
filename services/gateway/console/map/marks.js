// Places, rules and inspections of the shown map: listed, searched, driven to, and set from nodes that were picked.

import { call, get } from "../page/api.js";
import { asked, confirmed } from "../page/ask.js";
import { $, html, table } from "../page/dom.js";
import { TEXT } from "../page/text.js";

export class Marks {
  /** `goTo(name)` starts a mission, `open(node)` shows a node, `say(text)` of refusals. */
  constructor(graph, goTo, open, say) {
    Object.assign(this, { graph, goTo, open, say });
    $("place-search").addEventListener("input", () => this.show());
    $("places-form").addEventListener("submit", (event) => event.preventDefault());
    $("pick").addEventListener("click", () => this.pick(!graph.picking));
    $("name-picked").addEventListener("click", () => this.name([...graph.picked]));
    $("forbid-picked").addEventListener("click", () => this.forbid([...graph.picked]));
    graph.onMarks.push(() => this.show());
    graph.picks = () => this.picks();
    this.picks();
  }

  pick(on) {
    this.graph.pick(on);
    $("pick").setAttribute("aria-pressed", String(on));
    this.picks();
  }

  picks() {
    const count = this.graph.picked.size;
    $("pick").textContent = this.graph.picking ? TEXT.picked(count) : TEXT.pick;
    for (const id of ["name-picked", "forbid-picked"]) $(id).disabled = !count;
  }

  async show() {
    const { map } = this.graph;
    const text = $("place-search").value.trim();
    let { places } = this.graph;
    try {
      if (text && map) places = await get(`/api/maps/${map}/places?search=${encodeURIComponent(text)}`);
    } catch (problem) {
      this.say(problem.message);
    }
    if (map !== this.graph.map || text !== $("place-search").value.trim()) return;
    const rows = places.map((place) => [
      html("button", { type: "button", class: "link", onclick: () => place.nodes.length && this.open(place.nodes[0]) }, place.name),
      place.nodes.length > 1 ? TEXT.area(place.nodes.length) : place.nodes.length ? TEXT.node(place.nodes[0]) : TEXT.emptied,
      html("span", { class: "row" },
        html("button", { type: "button", onclick: () => this.goTo(place.name) }, TEXT.goThere),
        this.remover("places", place.name, TEXT.forgetPlace(place.name), TEXT.forget)),
    ]);
    $("places").replaceChildren(rows.length ? table(TEXT.placeColumns, rows) : html("p", { class: "quiet" }, TEXT.noPlaces));
    const rules = this.graph.rules.map((rule) => [rule.name, TEXT.rule(rule),
      this.remover("rules", rule.name, TEXT.liftRule(rule.name), TEXT.lift)]);
    $("rules").replaceChildren(...(rules.length ? [table(TEXT.ruleColumns, rules)] : []));
    await this.inspections();
  }

  /** A round changes nothing in the map: they are asked for whenever the view comes up, too. */
  async inspections() {
    const { map } = this.graph;
    let rounds = [];
    try {
      if (map) rounds = await get(`/api/maps/${map}/inspections`);
    } catch (problem) {
      this.say(problem.message);
    }
    if (map !== this.graph.map) return;
    const rows = rounds.map((round) => [
      html("a", { href: `/api/maps/${map}/inspections/${round.round}/report`, target: "_blank" }, round.round),
      String(round.visits.length), String(round.changes)]);
    $("inspections").replaceChildren(...(rows.length ? [table(TEXT.inspectionColumns, rows)] : []));
  }

  remover(what, name, question, yes) {
    const remove = async () => {
      if (await confirmed(question, yes)) await this.write("DELETE", `${what}?name=${encodeURIComponent(name)}`);
    };
    return html("button", { type: "button", class: "danger", onclick: remove }, yes);
  }

  async name(nodes) {
    const name = await asked(TEXT.namePlace(nodes), "", TEXT.placeName, TEXT.nameIt);
    if (name) await this.write("PUT", "places", { name, nodes });
  }

  async forbid(nodes) {
    const name = await asked(TEXT.forbidNodes(nodes), "", TEXT.placeName, TEXT.forbid);
    if (name) await this.write("PUT", "rules", { kind: "keep_out", name, nodes });
  }

  async write(method, path, content) {
    try {
      await call(method, `/api/maps/${this.graph.map}/${path}`, content && JSON.stringify(content), content && "application/json");
      this.say("");
      this.pick(false);
    } catch (problem) {
      this.say(problem.message);
    }
    await this.graph.load();
  }
}
