// Goal pictures: choose or drop one, see how well the map knows it, drive there.

import { upload } from "./api.js";
import { $, html, side } from "./dom.js";

const WORDS = {
  found: "The map knows this place.",
  weak: "The map may know this place, but is not sure.",
  not_found: "The map does not know this place.",
};

export class Goal {
  /** `where()` gives robot and map, `found(ids)` hears which places match, `started(status)` of the mission. */
  constructor(where, found, started) {
    this.where = where;
    this.found = found;
    this.started = started;
    this.file = null;
    $("picture").addEventListener("change", (event) => this.take(event.target.files[0]));
    $("go").addEventListener("click", () => this.go());
    const drop = $("drop");
    for (const kind of ["dragenter", "dragover"]) drop.addEventListener(kind, (event) => this.over(event, true));
    for (const kind of ["dragleave", "drop"]) drop.addEventListener(kind, (event) => this.over(event, false));
    drop.addEventListener("drop", (event) => this.take(event.dataTransfer.files[0]));
    for (const kind of ["dragover", "drop"]) addEventListener(kind, (event) => event.preventDefault());
  }

  over(event, on) {
    event.preventDefault();
    $("drop").classList.toggle("over", on);
  }

  async take(file) {
    if (!file) return;
    this.file = file;
    $("go").disabled = true;
    this.preview(file);
    await this.check();
  }

  async preview(file) {
    const canvas = $("preview");
    try {
      const bitmap = await createImageBitmap(file, { resizeWidth: canvas.width, resizeHeight: canvas.height });
      canvas.getContext("2d").drawImage(bitmap, 0, 0);
      canvas.hidden = false;
      $("drop-text").hidden = true;
    } catch {
      canvas.hidden = true;
      $("drop-text").hidden = false;
    }
  }

  /** Ask how well the picture localises; the newest question wins. */
  async check() {
    const { robot, map } = this.where();
    const file = this.file;
    if (!file) return;
    if (!map) return this.say("There is no map yet: explore first.", "bad");
    this.say("Comparing with the map …");
    try {
      const answer = await upload(`/api/robots/${robot}/goal-check?map=${map}`, file);
      if (file === this.file) this.show(answer, map);
    } catch (problem) {
      if (file === this.file) this.say(problem.message, "bad");
    }
  }

  async go() {
    const { robot, map } = this.where();
    $("go").disabled = true;
    try {
      this.started(await upload(`/api/robots/${robot}/missions/goto?map=${map}`, this.file));
    } catch (problem) {
      this.say(problem.message, "bad");
    } finally {
      $("go").disabled = false;
    }
  }

  say(text, kind = "") {
    $("goal-answer").replaceChildren(html("p", { class: `answer ${kind}` }, text));
  }

  show(answer, map) {
    const rows = answer.nodes.map((node) => html("tr", {},
      html("td", {}, html("img", { src: `/api/maps/${map}/nodes/${node.node_id}/thumbnail`, alt: "", width: 74, height: 37,
        onerror: (event) => event.target.remove() }), ` ${node.node_id}`),
      html("td", {}, `${node.inliers} of ${answer.max_similarity || node.raw_matches}`),
      html("td", {}, node.status === "no_baseline" ? "same spot" : html("meter", { min: 0, max: 1, low: 0.25, high: 0.5, optimum: 1, value: node.confidence,
        "aria-label": `confidence ${node.confidence.toFixed(2)}` })),
      html("td", {}, node.status === "no_baseline" ? "here" : node.heading_rad === null ? "–" : side(node.heading_rad))));
    const head = ["place", "agree", "trust", "direction"].map((text) => html("th", { scope: "col" }, text));
    $("goal-answer").replaceChildren(
      html("p", { class: `verdict ${answer.verdict}` }, WORDS[answer.verdict]),
      rows.length
        ? html("table", {}, html("thead", {}, html("tr", {}, ...head)), html("tbody", {}, ...rows))
        : html("p", { class: "answer" }, "No place to compare with."),
    );
    $("go").disabled = false;
    this.found(answer.nodes.filter((node) => node.status === "ok" || node.status === "no_baseline").map((node) => node.node_id));
  }
}
