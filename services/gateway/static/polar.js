// Twelve distances seen from above, ahead is up, counter-clockwise is left; the arrow is the heading.

import { $, degrees, side, svg } from "./dom.js";

const RADIUS = 92;
const NEAR_M = 0.5;

const point = (rad, radius) => [-Math.sin(rad) * radius, -Math.cos(rad) * radius];

export class Polar {
  constructor() {
    this.clear();
  }

  clear() {
    this.ranges = null;
    this.heading = null;
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
    shapes.push(svg("path", { class: "body", d: "M0 -9 L7 8 L0 4 L-7 8 Z" }));
    if (this.heading && this.heading.action === "go") shapes.push(...this.arrow());
    const labels = [["ahead", 0, -102], ["left", -104, 3], ["right", 104, 3], ["behind", 0, 110]];
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
    return parts.join(", ");
  }
}
