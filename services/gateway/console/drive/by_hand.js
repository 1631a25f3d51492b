// Driving by hand: keys, a stick to touch or drag, or a gamepad; said again until one lets go.

import { post } from "../page/api.js";
import { $ } from "../page/dom.js";
import { TEXT } from "../page/text.js";

const PERIOD_MS = 130; // a wish holds for TTL_MS: one of three has to arrive
const TTL_MS = 400;
const FASTEST_MPS = 0.4;
const FASTEST_RADPS = 1.0;
const DEAD = 0.12; // a gamepad's stick at rest is not quite in its middle
const KEYS = {
  KeyW: [1, 0, 0], ArrowUp: [1, 0, 0], KeyS: [-1, 0, 0], ArrowDown: [-1, 0, 0],
  KeyQ: [0, 1, 0], KeyE: [0, -1, 0],
  KeyA: [0, 0, 1], ArrowLeft: [0, 0, 1], KeyD: [0, 0, -1], ArrowRight: [0, 0, -1],
};
const NOTHING = [0, 0, 0];

const summed = (parts) =>
  parts.reduce((sum, part) => sum.map((value, k) => Math.max(-1, Math.min(1, value + part[k]))), NOTHING);
const live = (value) => (Math.abs(value) < DEAD ? 0 : value);

export class ByHand {
  /** `where()` gives the robot, `say(text)` hears of refusals. */
  constructor(where, say) {
    this.where = where;
    this.say = say;
    this.pressed = new Set();
    this.stick = NOTHING;
    this.timer = 0;
    this.sending = null;
    $("by-hand").addEventListener("change", (event) => (event.target.checked ? this.take() : this.release()));
    document.addEventListener("keydown", (event) => this.key(event, true));
    document.addEventListener("keyup", (event) => this.key(event, false));
    window.addEventListener("blur", () => this.release());
    document.addEventListener("visibilitychange", () => document.hidden && this.release());
    const pad = $("stick");
    pad.addEventListener("pointerdown", (event) => this.drag(event));
    pad.addEventListener("pointermove", (event) => pad.hasPointerCapture(event.pointerId) && this.drag(event));
    for (const end of ["pointerup", "pointercancel"]) pad.addEventListener(end, () => this.point(NOTHING));
  }

  get driving() {
    return this.timer !== 0;
  }

  take() {
    if (this.driving) return;
    $("stick").hidden = false;
    this.timer = setInterval(() => this.wish(), PERIOD_MS);
    this.wish();
  }

  release() {
    if (!this.driving) return;
    clearInterval(this.timer);
    this.timer = 0;
    this.pressed.clear();
    this.point(NOTHING);
    $("stick").hidden = true;
    $("by-hand").checked = false;
    $("hand-facts").textContent = "";
    this.send({ action: "release" });
  }

  key(event, down) {
    const typing = event.target.closest?.("input:not([type=checkbox]), select, textarea, [role=application]");
    if (!this.driving || !(event.code in KEYS) || typing || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    if (down) this.pressed.add(event.code);
    else this.pressed.delete(event.code);
    if (!event.repeat) this.wish();
  }

  drag(event) {
    event.target.setPointerCapture?.(event.pointerId);
    const box = $("stick").getBoundingClientRect();
    const across = (2 * (event.clientX - box.left)) / box.width - 1;
    const down = (2 * (event.clientY - box.top)) / box.height - 1;
    const far = Math.max(1, Math.hypot(across, down));
    this.point([-down / far, 0, -across / far]);
  }

  point(stick) {
    this.stick = stick;
    const [forward, , turn] = stick;
    $("stick-knob").style.transform = `translate(${-turn * 36}px, ${-forward * 36}px)`;
  }

  /** Left stick: ahead and aside; right stick: turn. */
  gamepad() {
    const pad = [...(navigator.getGamepads?.() ?? [])].find((one) => one?.connected);
    if (!pad) return NOTHING;
    const [x = 0, y = 0, turn = 0] = pad.axes;
    return [-live(y), -live(x), -live(turn)];
  }

  wish() {
    if (!this.driving) return;
    const wished = summed([...[...this.pressed].map((code) => KEYS[code]), this.stick, this.gamepad()]);
    const [forward, left, turn] = wished;
    $("hand-facts").textContent = TEXT.byHand(forward * FASTEST_MPS, left * FASTEST_MPS, turn * FASTEST_RADPS);
    this.send({
      forward_mps: forward * FASTEST_MPS, left_mps: left * FASTEST_MPS, turn_radps: turn * FASTEST_RADPS,
      ttl_ms: TTL_MS,
    });
  }

  /**
   * One at a time: a slow line must not pile up wishes that are old when they arrive. To let go waits for the wish
   * before it, which would take the robot again if it came later.
   */
  async send(wish) {
    if (this.sending && wish.action !== "release") return;
    const path = `/api/robots/${this.where().robot}/drive`;
    const before = this.sending?.catch(() => {});
    const sending = Promise.resolve(before).then(() => post(path, { who: "console", ...wish }));
    this.sending = sending;
    try {
      await sending;
    } catch (problem) {
      this.say(problem.message);
      this.release();
    } finally {
      if (this.sending === sending) this.sending = null;
    }
  }
}
