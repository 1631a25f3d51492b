// What a robot says of its body, where it has anything to say: battery, wheels, lean, and how its camera does.

import { $ } from "../page/dom.js";
import { TEXT } from "../page/text.js";

export class Body {
  constructor() {
    this.clear();
  }

  clear() {
    this.known = {};
    this.show();
  }

  take(kind, data) {
    this.known[kind] = data;
    this.show();
  }

  show() {
    const { battery, odometry, imu, camera } = this.known;
    const parts = [
      battery && TEXT.battery(battery),
      odometry && TEXT.odometry(odometry),
      imu?.gravity && TEXT.lean((Math.acos(Math.max(-1, Math.min(1, -imu.gravity[2]))) * 180) / Math.PI),
      camera && TEXT.camera(camera),
    ].filter(Boolean);
    $("body-facts").hidden = parts.length === 0;
    $("body-facts").textContent = parts.join(" \u00b7 ");
    $("body-facts").classList.toggle("bad", Boolean(camera?.problem));
  }
}
