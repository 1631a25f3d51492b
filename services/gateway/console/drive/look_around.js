// Looking around in the live panorama by dragging: pannellum, loaded when first wanted.

import { $, script, style } from "../page/dom.js";

const FIELD_DEG = 100;

export class LookAround {
  constructor() {
    this.viewer = null;
    this.canvas = document.createElement("canvas");
  }

  async open(image) {
    style("/static/vendor/pannellum.css");
    await script("/static/vendor/pannellum.js");
    if (!image.naturalWidth) await new Promise((resolve) => { image.addEventListener("load", resolve, { once: true }); });
    $("around").hidden = false;
    this.draw(image);
    if (this.viewer) return;
    this.viewer = window.pannellum.viewer("around", {
      type: "equirectangular", panorama: this.canvas, dynamic: true, autoLoad: true, showZoomCtrl: false,
      showFullscreenCtrl: false, hfov: FIELD_DEG, compass: false, keyboardZoom: false,
    });
  }

  close() {
    $("around").hidden = true;
  }

  /** Show the newest picture. */
  draw(image) {
    if (!image.naturalWidth) return;
    if (this.canvas.width !== image.naturalWidth) {
      this.canvas.width = image.naturalWidth;
      this.canvas.height = image.naturalHeight;
    }
    this.canvas.getContext("2d").drawImage(image, 0, 0);
    if (!this.viewer) return;
    this.viewer.setUpdate(true);
    requestAnimationFrame(() => this.viewer.setUpdate(false));
  }
}
