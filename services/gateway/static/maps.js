// Choosing a map, and what can be done to one.

import { call, get } from "./api.js";
import { $, html } from "./dom.js";

const POLL_MS = 5000;

export class Maps {
  constructor(chosen, say) {
    this.chosen = chosen;
    this.say = say;
    this.names = [];
    this.wanted = "";
    $("map").addEventListener("change", (event) => this.choose(event.target.value));
    $("undo").addEventListener("click", () => this.act("POST", "/undo"));
    $("rename").addEventListener("click", () => this.rename());
    $("delete").addEventListener("click", () => this.remove());
    $("import").addEventListener("change", (event) => this.load(event.target));
    setInterval(() => document.hidden || this.refresh(), POLL_MS);
  }

  get name() {
    return $("map").value;
  }

  /** Show this map, now or as soon as it exists. */
  want(name) {
    this.wanted = name;
    if (this.names.includes(name)) this.choose(name);
    else this.refresh();
  }

  async refresh() {
    let maps;
    try {
      maps = await get("/api/maps");
    } catch {
      return; // the graph says what is wrong
    }
    const names = maps.map((map) => map.name);
    const same = names.join() === this.names.join();
    if (!same) {
      this.names = names;
      const before = this.name;
      $("map").replaceChildren(...names.map((name) => html("option", { value: name }, name)));
      $("map-names").replaceChildren(...names.map((name) => html("option", { value: name })));
      const next = names.includes(this.wanted) ? this.wanted : names.includes(before) ? before : names[0] || "";
      this.choose(next);
    }
  }

  choose(name) {
    if (this.names.includes(this.wanted)) this.wanted = "";
    $("map").value = name;
    for (const id of ["undo", "rename", "delete"]) $(id).disabled = !name;
    $("export").classList.toggle("off", !name);
    if (name) $("export").href = `/api/maps/${name}/export`;
    else $("export").removeAttribute("href");
    this.chosen(name);
  }

  async act(method, path, content) {
    try {
      const url = `/api/maps/${this.name}${path}`;
      await (content ? call(method, url, JSON.stringify(content), "application/json") : call(method, url));
      this.say("");
    } catch (problem) {
      this.say(problem.message, true);
    }
    await this.refresh();
    this.chosen(this.name);
  }

  rename() {
    const name = prompt(`New name of ${this.name} (a to z, 0 to 9, _ and -)`, this.name);
    if (!name || name === this.name) return undefined;
    this.wanted = name;
    return this.act("PATCH", "", { name });
  }

  remove() {
    if (!confirm(`Delete the map ${this.name} with all its places? Export it first if in doubt.`)) return undefined;
    return this.act("DELETE", "");
  }

  async load(input) {
    const file = input.files[0];
    if (!file) return;
    try {
      const made = await call("POST", "/api/maps/import", file, "application/zip");
      this.want(made.name);
    } catch (problem) {
      this.say(problem.message, true);
    }
    input.value = "";
  }
}

