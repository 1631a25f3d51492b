// The view of all maps: make, rename, bring in and out, delete, merge; and the history of the chosen one.

import { call, get, post } from "../page/api.js";
import { asked, confirmed } from "../page/ask.js";
import { $, html, table } from "../page/dom.js";
import { TEXT } from "../page/text.js";

const MERGE_MS = 1000;
const DONE = ["done", "refused", "failed"];

export class MapTable {
  constructor(maps) {
    this.maps = maps;
    this.picked = [];
    $("create-form").addEventListener("submit", (event) => { event.preventDefault(); this.create(); });
    $("merge-form").addEventListener("submit", (event) => { event.preventDefault(); this.merge(); });
    $("import").addEventListener("change", (event) => this.load(event.target));
    $("undo").addEventListener("click", () => this.undo());
    $("compare").addEventListener("click", () => this.compare());
  }

  say(text, bad = false) {
    $("maps-answer").textContent = text;
    $("maps-answer").classList.toggle("bad", bad);
  }

  /** Do something and show the result, or why not. */
  async act(job) {
    try {
      this.say("");
      await job();
    } catch (problem) {
      this.say(problem.message, true);
    }
    await this.maps.refresh();
    await this.show();
  }

  async show() {
    const rows = this.maps.all.map((map) => [
      html("button", { type: "button", class: "link", "aria-pressed": String(map.name === this.maps.name), onclick: () => this.choose(map.name) }, map.name),
      String(map.nodes), String(map.edges), String(map.revision),
      html("time", {}, new Date(map.changed_ns / 1e6).toLocaleString()),
      html("span", { class: "row" },
        html("button", { type: "button", onclick: () => this.rename(map.name) }, TEXT.rename),
        html("a", { class: "button", href: `/api/maps/${map.name}/export`, download: "" }, TEXT.export),
        html("button", { type: "button", class: "danger", onclick: () => this.remove(map.name) }, TEXT.confirmDelete)),
    ]);
    $("maps-table").replaceChildren(rows.length
      ? table(TEXT.mapColumns, rows)
      : html("p", { class: "quiet" }, TEXT.noMaps));
    for (const id of ["merge-into", "merge-other"]) {
      const chosen = $(id).value;
      $(id).replaceChildren(...this.maps.names.map((name) => html("option", { value: name }, name)));
      if (this.maps.names.includes(chosen)) $(id).value = chosen;
    }
    await this.revisions();
  }

  choose(name) {
    this.maps.choose(name);
    this.picked = [];
    return this.show();
  }

  async revisions() {
    const { name } = this.maps;
    $("revisions-title").textContent = TEXT.historyOf(name);
    for (const id of ["undo", "compare"]) $(id).disabled = !name;
    if (!name) return $("revisions").replaceChildren();
    let revisions = [];
    try {
      revisions = await get(`/api/maps/${name}/revisions?limit=100`);
    } catch (problem) {
      this.say(problem.message, true);
    }
    this.newest = revisions[0]?.revision;
    const rows = revisions.map((revision) => [
      html("input", { type: "checkbox", "aria-label": `revision ${revision.revision}`, value: revision.revision,
        checked: this.picked.includes(revision.revision), onchange: (event) => this.pick(revision.revision, event.target.checked) }),
      String(revision.revision), revision.author || "–", html("time", {}, new Date(revision.stamp_ns / 1e6).toLocaleString()),
      revision.undoes ? TEXT.undoes(revision.undoes) : TEXT.revision(revision),
    ]);
    return $("revisions").replaceChildren(table(TEXT.revisionColumns, rows));
  }

  pick(revision, on) {
    this.picked = this.picked.filter((other) => other !== revision);
    if (on) this.picked.push(revision);
  }

  create() {
    const name = $("create-name").value.trim();
    return this.act(async () => { await post("/api/maps", { name }); this.maps.want(name); $("create-name").value = ""; });
  }

  async rename(name) {
    const next = await asked(TEXT.renameMap(name), name, TEXT.mapName, TEXT.rename, TEXT.mapPattern);
    if (!next || next === name) return;
    await this.act(async () => {
      await call("PATCH", `/api/maps/${name}`, JSON.stringify({ name: next }), "application/json");
      this.maps.want(next);
    });
  }

  async remove(name) {
    if (await confirmed(TEXT.deleteMap(name), TEXT.confirmDelete)) await this.act(() => call("DELETE", `/api/maps/${name}`));
  }

  async undo() {
    const { name } = this.maps;
    if (await confirmed(TEXT.undoMap(name), $("undo").textContent)) await this.act(() => call("POST", `/api/maps/${name}/undo`));
  }

  async load(input) {
    const file = input.files[0];
    if (!file) return;
    await this.act(async () => { this.maps.want((await call("POST", "/api/maps/import", file, "application/zip")).name); });
    input.value = "";
  }

  compare() {
    const [from, to] = this.picked.length === 2 ? [...this.picked].sort((a, b) => a - b) : [this.picked[0] ?? 0, this.newest];
    return this.act(async () => {
      const changes = await get(`/api/maps/${this.maps.name}/compare?from=${from}&to=${to}`);
      $("comparison").textContent = TEXT.compared(changes);
    });
  }

  async merge() {
    const [into, other] = [$("merge-into").value, $("merge-other").value];
    try {
      let job = await post(`/api/maps/${into}/merge`, { other });
      while (!DONE.includes(job.state)) {
        this.say(TEXT.merging(job));
        await new Promise((resolve) => { setTimeout(resolve, MERGE_MS); });
        job = await get(`/api/maps/${into}/merge`);
      }
      this.say(job.state === "done" ? TEXT.merged(job) : job.reason, job.state !== "done");
    } catch (problem) {
      this.say(problem.message, true);
    }
    await this.maps.refresh();
    await this.show();
  }
}
