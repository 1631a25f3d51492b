// The mission: what it is, how it stands, and the buttons that steer it.

import { post } from "../page/api.js";
import { $, html } from "../page/dom.js";
import { TEXT } from "../page/text.js";

const BUSY = ["running", "paused"];

export class Mission {
  constructor(where, started) {
    this.where = where;
    this.started = started;
    $("explore-form").addEventListener("submit", (event) => { event.preventDefault(); this.explore(); });
    for (const action of ["pause", "resume", "cancel"]) $(action).addEventListener("click", () => this.steer(action));
    this.clear();
  }

  clear() {
    this.status = null;
    $("state").textContent = "unknown";
    $("state").className = "state";
    $("mission-facts").textContent = TEXT.missionUnheard;
    this.enable();
  }

  take(status) {
    this.status = status;
    $("state").textContent = status.failure ? `${status.state}: ${status.failure.replaceAll("_", " ")}` : status.state;
    $("state").className = `state ${status.state}`;
    $("mission-facts").replaceChildren(...this.facts(status));
    this.enable();
  }

  facts(status) {
    if (!status.mission_id) return [TEXT.missionNone];
    const what = TEXT.missionWhat[status.action] || TEXT.missionAny;
    return [html("b", {}, `${what} in ${status.map}`), html("br"), TEXT.missionFacts(status), html("br"),
      html("span", { class: "quiet" }, status.reason || ""), ];
  }

  enable() {
    const state = this.status?.state;
    $("explore").disabled = BUSY.includes(state);
    $("pause").disabled = state !== "running";
    $("resume").disabled = state !== "paused";
    $("cancel").disabled = !BUSY.includes(state);
  }

  explore() {
    const map = $("new-map").value.trim();
    const seed = Number.parseInt($("seed").value, 10) || 0;
    return this.ask("missions", { action: "explore", map, seed });
  }

  goToNode(id) {
    return this.ask("missions", { action: "goto", map: this.where().map, goal_node: id });
  }

  steer(action) {
    return this.ask(`missions/${action}`);
  }

  async ask(path, content) {
    try {
      const status = await post(`/api/robots/${this.where().robot}/${path}`, content);
      this.say("");
      this.take(status);
      this.started(status);
    } catch (problem) {
      this.say(problem.message, true);
    }
  }

  say(text, bad = false) {
    $("answer").textContent = text;
    $("answer").classList.toggle("bad", bad);
  }
}
