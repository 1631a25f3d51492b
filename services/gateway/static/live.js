// The WebSocket: reconnects by itself and says when it is silent.

const SILENT_MS = 7000; // the gateway speaks at least every 2 s
const FIRST_WAIT_MS = 500;
const LONGEST_WAIT_MS = 8000;

export class Live {
  /** `heard(type, data)` for every message, `changed(up)` when the connection comes or goes. */
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

  open() {
    clearTimeout(this.timer);
    const old = this.socket;
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}/api/robots/${this.robot}/live`);
    this.socket = socket;
    if (old) old.close();
    this.last = performance.now();
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
    socket.addEventListener("close", () => {
      if (socket === this.socket) this.lost();
    });
  }

  lost() {
    this.changed(false);
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.open(), this.wait);
    this.wait = Math.min(this.wait * 1.7, LONGEST_WAIT_MS);
  }

  check() {
    const open = this.socket && this.socket.readyState === WebSocket.OPEN;
    if (open && performance.now() - this.last > SILENT_MS) this.open();
  }
}
