// What is known of one node or one edge: pictures, evidence, and what can be done with it.

import { call, get } from "../page/api.js";
import { confirmed } from "../page/ask.js";
import { $, html, side, table } from "../page/dom.js";
import { drawPair } from "./pair.js";
import { TEXT } from "../page/text.js";

export class Inspector {
  /** `goThere(node)` starts a mission, `name(node)` names it, `changed()` hears of edits, `say(text)` of refusals. */
  constructor(graph, goThere, name, changed, say) {
    Object.assign(this, { graph, goThere, name, changed, say, shown: {} });
    $("find-form").addEventListener("submit", (event) => { event.preventDefault(); this.find($("find").value.trim()); });
    addEventListener("keydown", (event) => event.key === "Escape" && !event.target.closest("dialog") && this.close());
  }

  close() {
    this.shown = {};
    this.graph.choose({});
    $("inspector").hidden = true;
    this.uncover();
  }

  /** Beside the live picture it lies over other cards: what was opened elsewhere must not cover them. */
  uncover() {
    document.body.classList.remove("inspecting");
  }

  /** "12" is a node, "3-12" an edge. A map that is still on its way is waited for. */
  async find(text) {
    if (this.graph.revision === null) await this.graph.load();
    const [a, b] = text.split(/[\s,-]+/).map(Number);
    const edge = b !== undefined && this.graph.edges.find((one) => one.a === Math.min(a, b) && one.b === Math.max(a, b));
    if (edge) this.open({ edge: [edge.a, edge.b] });
    else if (b === undefined && this.graph.nodes.some((node) => node.node_id === a)) this.open({ node: a });
    else this.say(TEXT.unknown(text));
  }

  open(what) {
    this.shown = what;
    this.graph.choose(what);
    const content = what.edge ? this.edge(...what.edge) : this.node(what.node);
    if (!content) return this.close();
    const title = what.edge ? TEXT.edge(...what.edge) : TEXT.node(what.node);
    const close = html("button", { type: "button", "aria-label": TEXT.close, onclick: () => this.close() }, "✕");
    $("inspector").replaceChildren(html("div", { class: "head" }, html("h2", { id: "inspector-title" }, title), close), ...content);
    $("inspector").hidden = false;
    document.body.classList.add("inspecting");
    return undefined;
  }

  node(id) {
    const node = this.graph.nodes.find((candidate) => candidate.node_id === id);
    if (!node) return null;
    const open = (node.open || []).filter((is, sector) => is && !(node.explored || [])[sector]).length;
    const picture = this.picture(id);
    this.overlay(picture, id);
    return [
      picture,
      html("p", { class: "quiet" }, TEXT.nodeFacts(node.keypoints ?? 0, open)),
      this.edgesOf(id),
      html("div", { class: "row" },
        html("button", { type: "button", class: "primary", id: "go-there", onclick: () => this.goThere(id) }, TEXT.goThere),
        html("button", { type: "button", id: "name-node", onclick: () => this.name(id) }, TEXT.nameIt),
        this.deleter(TEXT.deleteNode(id), `nodes/${id}`)),
    ];
  }

  picture(id) {
    const image = html("img", { src: `/api/maps/${this.graph.map}/nodes/${id}/thumbnail`, alt: TEXT.view(id),
      width: 256, height: 128, onerror: (event) => event.target.remove() });
    return html("figure", { class: "panorama" }, image);
  }

  /** The keypoints over the thumbnail, as they arrive. */
  async overlay(figure, id) {
    try {
      const { lonlat_rad: points } = await get(`/api/maps/${this.graph.map}/nodes/${id}/keypoints`);
      const canvas = html("canvas", { width: 720, height: 360, "aria-hidden": "true" });
      const context = canvas.getContext("2d");
      context.fillStyle = "#facc15";
      for (const [lon, lat] of points) context.fillRect(360 - (lon * 360) / Math.PI - 1.5, 180 - (lat * 360) / Math.PI - 1.5, 3, 3);
      figure.append(canvas);
    } catch {
      // the picture without its keypoints is still worth seeing
    }
  }

  edgesOf(id) {
    const edges = this.graph.edges.filter((edge) => edge.a === id || edge.b === id);
    if (!edges.length) return html("p", { class: "quiet" }, TEXT.noEdges);
    const rows = edges.sort((one, two) => two.inliers - one.inliers).map((edge) => {
      const there = edge.a === id ? edge.b : edge.a;
      const heading = edge.a === id ? edge.heading_ab_rad : edge.heading_ba_rad;
      const walk = html("button", { type: "button", class: "link", onclick: () => this.open({ edge: [edge.a, edge.b] }) }, String(there));
      return [walk, `${side(heading)}${edge.suspended ? `, ${TEXT.suspended}` : ""}`, String(edge.inliers ?? "–"), (edge.confidence ?? 0).toFixed(2)];
    });
    return html("div", { class: "scroll", tabindex: 0 }, table(TEXT.edgeColumns, rows));
  }

  edge(a, b) {
    const edge = this.graph.edges.find((one) => one.a === a && one.b === b);
    if (!edge) return null;
    const canvas = html("canvas", { class: "pair", width: 720, height: 740, role: "img", "aria-label": `${TEXT.view(a)}, ${TEXT.view(b)}` });
    const answer = html("p", { class: "answer", id: "pair-answer", role: "status" }, TEXT.loadingMatches);
    this.compare(a, b, canvas, answer);
    const facts = ["why", "traversals", "failures", "clear", "raw_matches", "inliers", "confidence", "revision"].map((name) =>
      [name.replaceAll("_", " "), typeof edge[name] === "number" ? String(+edge[name].toFixed(2)) : String(edge[name] ?? "–")]);
    const ends = [a, b].map((id) => html("button", { type: "button", onclick: () => this.open({ node: id }) }, TEXT.node(id)));
    return [canvas, answer,
      html("p", {}, `${TEXT.headings(side(edge.heading_ab_rad), side(edge.heading_ba_rad))}${edge.suspended ? `; ${TEXT.suspended}` : ""}`),
      table(TEXT.evidenceColumns, facts),
      html("div", { class: "row" }, ...ends, this.deleter(TEXT.deleteEdge(a, b), `edges/${a}/${b}`))];
  }

  async compare(a, b, canvas, answer) {
    const { map } = this.graph;
    try {
      const match = await get(`/api/maps/${map}/edges/${a}/${b}/matches`);
      await drawPair(canvas, [a, b].map((id) => `/api/maps/${map}/nodes/${id}/thumbnail`), match);
      answer.textContent = TEXT.evidence(match);
      answer.dataset.drawn = match.inliers;
    } catch (problem) {
      answer.textContent = problem.message;
      answer.classList.add("bad");
    }
  }

  deleter(question, path) {
    const remove = async () => {
      if (!(await confirmed(question, TEXT.confirmDelete))) return;
      try {
        await call("DELETE", `/api/maps/${this.graph.map}/${path}`);
        this.say("");
        this.close();
      } catch (problem) {
        this.say(problem.message);
      }
      this.changed();
    };
    return html("button", { type: "button", class: "danger", id: "remove", onclick: remove }, TEXT.confirmDelete);
  }
}
