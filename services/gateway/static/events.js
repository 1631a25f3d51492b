// The decision log, newest first. Headings come every step and are hidden unless asked for.

import { $, html } from "./dom.js";

const KEPT = 200;
const EVERY_STEP = ["heading", "hold"];
const BAD = ["failed", "lost_mode", "edge_suspended", "edge_failed", "edge_deleted", "travel_failed", "replan", "blocked"];
const GOOD = ["succeeded", "found_again", "goal_located", "node_added"];

export class Events {
  constructor() {
    this.events = [];
    $("all-events").addEventListener("change", () => this.draw());
  }

  clear() {
    this.events = [];
    this.draw();
  }

  take(event) {
    const newest = this.events[0];
    if (newest && newest.mission_id === event.mission_id && event.seq <= newest.seq && this.has(event)) return;
    this.events.unshift(event);
    this.events.length = Math.min(this.events.length, KEPT * 3);
    if (!this.waiting) this.waiting = requestAnimationFrame(() => { this.waiting = null; this.draw(); });
  }

  has(event) { // after a reconnect the gateway repeats what it remembers
    return this.events.some((old) => old.seq === event.seq && old.stamp_ns === event.stamp_ns && old.kind === event.kind);
  }

  draw() {
    const all = $("all-events").checked;
    const shown = this.events.filter((event) => all || !EVERY_STEP.includes(event.kind)).slice(0, KEPT);
    $("events").replaceChildren(...(shown.length ? shown.map(row) : [html("li", { class: "quiet" }, "Nothing decided yet.")]));
  }
}

function row(event) {
  const kind = BAD.includes(event.kind) ? "bad" : GOOD.includes(event.kind) ? "good" : "";
  const values = event.values.map(({ name, value }) => `${name} ${typeof value === "number" ? +value.toFixed(3) : value}`);
  return html("li", { class: kind, title: values.join(", ") },
    html("span", { class: "quiet" }, `step ${event.step}`), html("b", {}, event.kind.replaceAll("_", " ")), ` ${event.reason}`);
}
