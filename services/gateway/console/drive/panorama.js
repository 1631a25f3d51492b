// The live panorama. A new picture is fetched when the last one has arrived, so slow links just see fewer.

import { $, svg } from "../page/dom.js";
import { LookAround } from "./look_around.js";
import { TEXT } from "../page/text.js";

const WIDTH_PX = 1280;
const STALE_MS = 4000;

export class Panorama {
  constructor() {
    this.image = $("frame");
    this.around = new LookAround();
    this.image.addEventListener("load", () => this.arrived());
    this.image.addEventListener("error", () => this.arrived());
    $("look-around").addEventListener("change", (event) => this.turn(event.target.checked));
    this.clear();
  }

  clear() {
    this.facts = null;
    this.shown = null;
    this.loading = false;
    this.at = 0;
    this.rate = 0;
    this.image.hidden = true;
    $("no-frame").hidden = false;
    $("frame-facts").textContent = "";
    $("frame-matches").replaceChildren();
    this.mark(null);
  }

  take(robot, facts) {
    const now = performance.now();
    if (this.facts && facts.seq > this.facts.seq) {
      const rate = (1000 * (facts.seq - this.facts.seq)) / Math.max(1, now - this.at);
      this.rate = this.rate ? 0.9 * this.rate + 0.1 * rate : rate;
    }
    this.robot = robot;
    this.facts = facts;
    this.at = now;
    $("frame-facts").textContent = TEXT.frame(facts, this.rate);
    if (!this.loading && document.body.dataset.view === "drive") this.load();
  }

  /** The card shows again. */
  resume() {
    if (this.facts && !this.loading) this.load();
  }

  load() {
    this.loading = true;
    this.shown = this.facts.seq;
    const width = Math.min(WIDTH_PX, Math.round(this.image.parentElement.clientWidth * devicePixelRatio) || WIDTH_PX);
    this.image.src = `/api/robots/${this.robot}/frame.jpg?width=${Math.max(64, width)}&seq=${this.facts.seq}`;
  }

  arrived() {
    this.loading = false;
    if (this.image.naturalWidth) {
      this.image.hidden = false;
      $("no-frame").hidden = true;
      if ($("look-around").checked) this.around.draw(this.image);
    }
    if (this.facts && this.facts.seq !== this.shown) setTimeout(() => this.facts && !this.loading && this.load(), 60);
  }

  turn(around) {
    $("flat").classList.toggle("under", around);
    $("compass").hidden = around;
    if (around) this.around.open(this.image);
    else this.around.close();
  }

  /** Draw left, ahead, right, and where the robot is heading. Longitude grows to the left. */
  mark(heading) {
    const lines = [90, 180, 270].map((x) => svg("line", { class: "tick", x1: x, x2: x, y1: 0, y2: 180 }));
    if (heading && heading.action === "go") {
      const turn = Math.atan2(Math.sin(heading.heading_rad), Math.cos(heading.heading_rad));
      const x = 180 - (turn * 180) / Math.PI;
      lines.push(svg("line", { class: "heading", x1: x, x2: x, y1: 60, y2: 180 }));
    }
    $("frame-marks").replaceChildren(...lines);
  }

  /** Milliseconds since the last new picture when that is too long, else 0. In lockstep time stands while nothing runs. */
  stale(running) {
    const due = this.facts && (running || !this.facts.lockstep);
    const age = due ? performance.now() - this.at : 0;
    const old = age > STALE_MS;
    $("flat").classList.toggle("stale", old);
    return old ? age : 0;
  }
}
