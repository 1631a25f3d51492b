// Keypoints of the live picture that match the node nearest to the robot, once a second while somebody looks.

import { get } from "../page/api.js";
import { $, svg } from "../page/dom.js";
import { TEXT } from "../page/text.js";

const EACH_MS = 1000;

export class Matches {
  /** `where()` gives robot and map, `heard(match)` the newest comparison or null. */
  constructor(where, heard) {
    this.where = where;
    this.heard = heard;
    this.nearest = -1;
    setInterval(() => this.ask(), EACH_MS);
    $("show-matches").addEventListener("change", () => this.clear());
  }

  takeStatus(status) {
    this.nearest = status.nearest_node ?? -1;
    this.map = status.map;
  }

  clear() {
    $("frame-matches").replaceChildren();
    $("match-facts").textContent = "";
    this.heard(null);
  }

  async ask() {
    const wanted = $("show-matches").checked && document.body.dataset.view === "drive" && !document.hidden;
    const { robot } = this.where();
    if (!wanted || this.asking || !robot) return;
    if (!(this.nearest >= 0)) return this.show(null); // nothing near, or the goal itself
    this.asking = true;
    try {
      this.show(await get(`/api/robots/${robot}/matches?map=${this.map}&node=${this.nearest}`));
    } catch {
      this.show(null); // the frame is gone, or the node: the next one may do
    } finally {
      this.asking = false;
    }
  }

  show(match) {
    if (!$("show-matches").checked) return;
    $("match-facts").textContent = match ? TEXT.matched(match) : TEXT.nothingMatched;
    $("frame-matches").replaceChildren(...(match ? dots(match) : []));
    this.heard(match);
  }
}

/** In a 360 by 180 picture: longitude grows to the left, latitude upwards. */
function dots(match) {
  return match.matches_rad.map(([lon, lat], index) => svg("circle", {
    class: match.inlier[index] ? "inlier" : "outlier", r: 0.9,
    cx: 180 - (lon * 180) / Math.PI, cy: 90 - (lat * 180) / Math.PI,
  }));
}
