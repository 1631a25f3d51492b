// S, heading and speed over the last steps, for the charts; and the charts (uPlot), loaded when first wanted.

import { $, script, style } from "../page/dom.js";
import { TEXT } from "../page/text.js";

const KEPT = 4000;
const EACH_MS = 500;
const HEIGHT_PX = 170;
const DEG = 180 / Math.PI;

export class History {
  constructor() {
    this.rows = [];
    this.now = { heading: null, speed: null };
    this.charts = [];
    setInterval(() => this.draw(), EACH_MS);
    new ResizeObserver(() => this.resize()).observe($("charts"));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.rebuild());
  }

  clear() {
    this.rows = [];
    this.changed = true;
  }

  takeHeading(heading) {
    this.now.heading = heading.action === "go" ? Math.atan2(Math.sin(heading.heading_rad), Math.cos(heading.heading_rad)) * DEG : null;
  }

  takeVelocity(velocity) {
    this.now.speed = Math.hypot(velocity.forward_mps, velocity.left_mps);
  }

  takeStatus(status) {
    const last = this.rows.at(-1);
    if (last && status.mission_id !== this.mission) this.rows = [];
    this.mission = status.mission_id;
    if (this.rows.length && status.step <= this.rows.at(-1)[0]) return;
    this.rows.push([status.step, status.similarity, this.now.heading, this.now.speed]);
    if (this.rows.length > KEPT) this.rows.splice(0, this.rows.length - KEPT);
    this.changed = true;
  }

  /** Point at one step. */
  async mark(step) {
    await this.open();
    this.draw(true);
    for (const chart of this.charts) {
      const left = chart.valToPos(step, "x");
      chart.setCursor({ left, top: 10 });
    }
  }

  async open() {
    style("/static/vendor/uPlot.min.css");
    await script("/static/vendor/uPlot.iife.min.js");
    if (this.charts.length) return;
    const colours = getComputedStyle(document.documentElement);
    const colour = (name) => colours.getPropertyValue(`--${name}`).trim();
    const steps = { incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000] };
    const axis = { stroke: colour("quiet"), grid: { stroke: colour("line"), width: 1 }, ticks: { stroke: colour("line") } };
    const lines = [["similarity", colour("place")], ["heading", colour("warn")], ["speed", colour("good")]];
    this.charts = lines.map(([name, stroke]) => new window.uPlot({
      width: Math.max(200, $("charts").clientWidth), height: HEIGHT_PX, title: TEXT.chart[name],
      cursor: { sync: { key: "steps" } }, scales: { x: { time: false } }, axes: [{ ...axis, ...steps }, axis],
      series: [{ label: "step" }, { label: TEXT.chart[name], stroke, width: 1.5, spanGaps: false }],
    }, [[], []], $("charts")));
    this.changed = true;
    this.draw();
  }

  rebuild() {
    if (!this.charts.length) return;
    for (const chart of this.charts) chart.destroy();
    this.charts = [];
    this.open();
  }

  resize() {
    const width = Math.max(200, $("charts").clientWidth);
    for (const chart of this.charts) if (chart.width !== width) chart.setSize({ width, height: HEIGHT_PX });
  }

  draw(now = false) {
    const seen = document.body.dataset.view === "why" && !document.hidden;
    if (!this.charts.length || !(this.changed && seen) && !now) return;
    this.changed = false;
    const steps = this.rows.map((row) => row[0]);
    this.charts.forEach((chart, index) => chart.setData([steps, this.rows.map((row) => row[index + 1])]));
    $("charts").dataset.points = steps.length;
  }
}
