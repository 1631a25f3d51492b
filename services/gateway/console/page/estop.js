// The emergency stop: one button that always works; only a person with a name lets the robot go again.

import { call, post } from "./api.js";
import { asked } from "./ask.js";
import { $ } from "./dom.js";
import { TEXT } from "./text.js";

export class EStop {
  /** `where()` gives the robot, `say(text)` hears of refusals. */
  constructor(where, say) {
    this.where = where;
    this.say = say;
    $("estop").addEventListener("click", () => this.engage());
    $("estop-clear").addEventListener("click", () => this.release());
    this.clear();
  }

  clear() {
    $("estop-notice").hidden = true;
  }

  take(state) {
    $("estop-notice").hidden = !state.engaged;
    const since = state.since ? new Date(state.since).toLocaleTimeString() : "";
    $("estop-text").textContent = state.engaged ? TEXT.stopped(state, since) : "";
  }

  engage() {
    return this.ask(() => post(`/api/robots/${this.where().robot}/estop`, { who: "console", why: TEXT.stopWhy }));
  }

  async release() {
    const who = await asked(TEXT.releaseWho, "", TEXT.releaseHint, TEXT.release);
    if (who) await this.ask(() => call("DELETE", `/api/robots/${this.where().robot}/estop?who=${encodeURIComponent(who)}`));
  }

  async ask(question) {
    try {
      this.take(await question());
    } catch (problem) {
      this.say(problem.message);
    }
  }
}
