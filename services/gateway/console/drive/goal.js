// Goal pictures: choose or drop one, see how well the map knows it, drive there.

import { upload } from "../page/api.js";
import { $, html, side, table } from "../page/dom.js";
import { TEXT } from "../page/text.js";

export class Goal {
  /** `where()` gives robot and map, `found(ids)` hears which nodes match, `started(status)` of the mission. */
  constructor(where, found, started) {
    this.where = where;
    this.found = found;
    this.started = started;
    this.file = null;
    $("picture").addEventListener("change", (event) => this.take(event.target.files[0]));
    $("go").addEventListener("click", () => this.go());
    $("from-here").addEventListener("click", () => this.fromHere());
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

  /** What the robot sees now, as a goal for later. */
  async fromHere() {
    const answer = await fetch(`/api/robots/${this.where().robot}/frame.jpg`, { cache: "no-store" }).catch(() => null);
    if (!answer?.ok) return this.say(TEXT.noLivePicture, "bad");
    return this.take(new File([await answer.blob()], "here.jpg", { type: "image/jpeg" }));
  }

  async preview(file) {
    const canvas = $("preview");
    try {
      const bitmap = await createImageBitmap(file, { resizeHeight: canvas.height });
      const context = canvas.getContext("2d");
      context.clearRect(0, 0, canvas.width, canvas.height);
      context.drawImage(bitmap, (canvas.width - bitmap.width) / 2, 0);
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
    if (!map) return this.say(TEXT.noMap, "bad");
    this.say(TEXT.comparing);
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
    const rows = answer.nodes.map((node) => {
      const same = node.status === "no_baseline";
      const trust = html("meter", { min: 0, max: 1, low: 0.25, high: 0.5, optimum: 1, value: node.confidence,
        "aria-label": `confidence ${node.confidence.toFixed(2)}` });
      const picture = html("img", { src: `/api/maps/${map}/nodes/${node.node_id}/thumbnail`, alt: "", width: 74, height: 37,
        onerror: (event) => event.target.remove() });
      return [html("span", {}, picture, ` ${node.node_id}`), `${node.inliers} of ${answer.max_similarity || node.raw_matches}`,
        same ? TEXT.sameSpot : trust, same ? TEXT.here : node.heading_rad === null ? "–" : side(node.heading_rad)];
    });
    $("goal-answer").replaceChildren(
      html("p", { class: `verdict ${answer.verdict}` }, TEXT.verdict[answer.verdict], TEXT.places(answer.places)),
      rows.length ? table(TEXT.goalColumns, rows) : html("p", { class: "answer" }, TEXT.noNode),
    );
    $("go").disabled = false;
    this.found(answer.nodes.filter((node) => node.status === "ok" || node.status === "no_baseline").map((node) => node.node_id));
  }
}
