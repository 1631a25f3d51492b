// The WebSocket: reconnects by itself and says when it is silent.

import { enter } from "./session.js";

const FULL = 1013; // the gateway has no room, or this page was too slow
const SILENT_MS = 7000; // the gateway speaks at least every 2 s
const FIRST_WAIT_MS = 500;
const LONGEST_WAIT_MS = 8000;

export class Live {
  /** `heard(type, data)` for every message, `changed(up, full)` when the connection comes or goes. */
  constructor(heard, changed) {
    this.heard = heard;
    this.changed = changed;
    this.wait = FIRST_WAIT_MS;
    this.socket = null;
    this.last = 0;
    setInterval(() => this.check(), 1000);
  }

  follow(robot) {
    this.robot = robot;
    this.wait = FIRST_WAIT_MS;
    this.open();
  }

  async open() {
    clearTimeout(this.timer);
    this.last = performance.now();
    if (!(await enter())) return this.lost();
    const old = this.socket;
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}/api/robots/${this.robot}/live`);
    this.socket = socket;
    if (old) old.close();
    socket.addEventListener("open", () => {
      if (socket !== this.socket) return;
      this.wait = FIRST_WAIT_MS;
      this.changed(true);
    });
    socket.addEventListener("message", (message) => {
      if (socket !== this.socket) return;
      this.last = performance.now();
      const { type, data } = JSON.parse(message.data);
      this.heard(type, data);
    });
    socket.addEventListener("close", (event) => {
      if (socket === this.socket) this.lost(event.code === FULL);
    });
    return undefined;
  }

  lost(full = false) {
    this.changed(false, full);
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.open(), this.wait);
    this.wait = Math.min(this.wait * 1.7, LONGEST_WAIT_MS);
  }

  check() {
    const open = this.socket && this.socket.readyState === WebSocket.OPEN;
    if (open && performance.now() - this.last > SILENT_MS) this.open();
  }
}
