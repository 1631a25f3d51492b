// Twelve distances seen from above, ahead is up, counter-clockwise is left; the arrow is the heading. Outside: where
// the bearings point that match the nearest node.

import { $, degrees, side, svg } from "../page/dom.js";

const RADIUS = 92;
const NEAR_M = 0.5;
const BINS = 36;
const BAR = 14;

const point = (rad, radius) => [-Math.sin(rad) * radius, -Math.cos(rad) * radius];

export class Polar {
  constructor() {
    this.clear();
  }

  clear() {
    this.ranges = null;
    this.heading = null;
    this.match = null;
    this.velocity = null;
    this.draw();
  }

  takeVelocity(velocity) {
    this.velocity = velocity;
    $("polar-facts").textContent = this.words();
  }

  takeMatch(match) {
    this.match = match;
    this.draw();
  }

  takeRanges(ranges) {
    this.ranges = ranges;
    this.draw();
  }

  takeHeading(heading) {
    this.heading = heading;
    this.draw();
  }

  draw() {
    const shapes = [0.25, 0.5, 0.75, 1].map((part) => svg("circle", { class: "ring", r: RADIUS * part }));
    if (this.ranges) shapes.push(...this.sectors());
    if (this.match) shapes.push(...this.histogram());
    shapes.push(svg("path", { class: "body", d: "M0 -9 L7 8 L0 4 L-7 8 Z" }));
    if (this.heading && this.heading.action === "go") shapes.push(...this.arrow());
    const labels = [["ahead", 0, -76], ["left", -72, 3], ["right", 72, 3], ["behind", 0, 82]];
    shapes.push(...labels.map(([text, x, y]) => svg("text", { x, y }, text)));
    $("polar").replaceChildren(...shapes);
    $("polar-facts").textContent = this.words();
  }

  sectors() {
    const { angles_rad: angles, distances_m: distances, max_range_m: reach } = this.ranges;
    const half = Math.PI / angles.length;
    return angles.map((angle, index) => {
      const radius = Math.max(6, RADIUS * Math.min(1, distances[index] / reach));
      const [x1, y1] = point(angle - half, radius);
      const [x2, y2] = point(angle + half, radius);
      const d = `M0 0 L${x1} ${y1} A${radius} ${radius} 0 0 0 ${x2} ${y2} Z`;
      const near = distances[index] < NEAR_M ? " near" : "";
      return svg("path", { class: `sector${near}`, d }, svg("title", {}, `${degrees(angle)}: ${distances[index].toFixed(2)} m`));
    });
  }

  /** How many matches that agree lie in each direction, as bars round the ring. */
  histogram() {
    const counts = new Array(BINS).fill(0);
    this.match.matches_rad.forEach(([lon], index) => {
      if (this.match.inlier[index]) counts[Math.floor(((lon / (2 * Math.PI)) * BINS + BINS) % BINS) % BINS] += 1;
    });
    const most = Math.max(1, ...counts);
    const wide = (2 * Math.PI) / BINS;
    return counts.map((count, bin) => {
      const [inner, outer] = [RADIUS + 1, RADIUS + 1 + (BAR * count) / most];
      const corners = [point(bin * wide, inner), point((bin + 0.9) * wide, inner), point((bin + 0.9) * wide, outer), point(bin * wide, outer)];
      return svg("polygon", { class: "bar", points: corners.join(" ") }, svg("title", {}, `${count}`));
    });
  }

  arrow() {
    const [x, y] = point(this.heading.heading_rad, 58);
    const tip = point(this.heading.heading_rad, 76);
    const left = point(this.heading.heading_rad + 0.22, 56);
    const right = point(this.heading.heading_rad - 0.22, 56);
    return [
      svg("line", { class: "arrow", x1: 0, y1: 0, x2: x, y2: y }),
      svg("polygon", { class: "arrow-head", points: `${tip} ${left} ${right}` }),
    ];
  }

  words() {
    const parts = [];
    if (this.ranges) parts.push(`nearest ${Math.min(...this.ranges.distances_m).toFixed(2)} m`);
    if (this.heading) parts.push(this.heading.action === "hold" ? "holding" : `going ${side(this.heading.heading_rad)}`);
    if (this.velocity) parts.push(`${Math.hypot(this.velocity.forward_mps, this.velocity.left_mps).toFixed(2)} m/s${this.velocity.avoiding ? ", avoiding" : ""}`);
    return parts.join(", ");
  }
}
