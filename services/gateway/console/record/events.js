// The timeline of decisions, newest first. Headings come every step and are hidden unless asked for.

import { $, html } from "../page/dom.js";
import { TEXT } from "../page/text.js";

const KEPT = 2000;
const SHOWN = 200;
const EVERY_STEP = ["heading", "hold"];
const BAD = ["failed", "lost_mode", "edge_suspended", "edge_failed", "edge_deleted", "travel_failed", "replan", "blocked", "place_shut"];
const GOOD = ["succeeded", "found_again", "goal_located", "node_added", "edge_restored"];

export class Events {
  /** `chosen(event)` hears which decision somebody wants to see. */
  constructor(chosen) {
    this.chosen = chosen;
    this.events = [];
    for (const id of ["all-events", "kind", "event-text"]) $(id).addEventListener("input", () => this.draw());
  }

  clear() {
    this.events = [];
    this.draw();
  }

  take(event) {
    const newest = this.events[0];
    if (newest && newest.mission_id === event.mission_id && event.seq <= newest.seq && this.has(event)) return;
    this.events.unshift(event);
    this.events.length = Math.min(this.events.length, KEPT);
    if (!this.waiting) this.waiting = requestAnimationFrame(() => { this.waiting = null; this.draw(); });
  }

  has(event) { // after a reconnect the gateway repeats what it remembers
    return this.events.some((old) => old.seq === event.seq && old.stamp_ns === event.stamp_ns && old.kind === event.kind);
  }

  kinds() {
    const kinds = [...new Set(this.events.map((event) => event.kind))].sort();
    const shown = [...$("kind").options].slice(1).map((option) => option.value);
    if (kinds.join() === shown.join()) return;
    const chosen = $("kind").value;
    $("kind").replaceChildren($("kind").options[0], ...kinds.map((kind) => html("option", { value: kind }, kind.replaceAll("_", " "))));
    $("kind").value = kinds.includes(chosen) ? chosen : "";
  }

  draw() {
    this.kinds();
    const [all, kind, text] = [$("all-events").checked, $("kind").value, $("event-text").value.toLowerCase()];
    const shown = this.events.filter((event) =>
      (kind ? event.kind === kind : all || !EVERY_STEP.includes(event.kind)) &&
      (!text || `${event.kind} ${event.reason}`.toLowerCase().includes(text)));
    const none = html("li", { class: "quiet" }, this.events.length ? TEXT.nothingFits : TEXT.nothingDecided);
    $("events").replaceChildren(...(shown.length ? shown.slice(0, SHOWN).map((event) => this.row(event)) : [none]));
  }

  row(event) {
    const kind = BAD.includes(event.kind) ? "bad" : GOOD.includes(event.kind) ? "good" : "";
    const values = event.values.map(({ name, value }) => `${name} ${typeof value === "number" ? +value.toFixed(3) : value}`);
    const step = html("button", { type: "button", class: "link quiet", onclick: () => this.chosen(event) }, TEXT.step(event.step));
    return html("li", { class: kind, title: values.join(", ") }, step, html("b", {}, event.kind.replaceAll("_", " ")), ` ${event.reason}`);
  }
}
