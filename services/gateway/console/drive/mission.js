// The mission: what it is, how it stands, and the buttons that steer it.

import { get, post } from "../page/api.js";
import { $, html } from "../page/dom.js";
import { TEXT } from "../page/text.js";
import { field, values } from "./parameters.js";

const BUSY = ["running", "paused"];

export class Mission {
  constructor(where, started) {
    this.where = where;
    this.started = started;
    this.kinds = [];
    $("mission-form").addEventListener("submit", (event) => { event.preventDefault(); this.start(); });
    $("mission-kind").addEventListener("change", () => this.choose());
    $("new-map").addEventListener("input", () => { this.otherMap = true; });
    for (const action of ["pause", "resume", "cancel", "finish"]) $(action).addEventListener("click", () => this.steer(action));
    this.clear();
  }

  clear() {
    this.status = null;
    this.kinds = [];
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
    return [html("b", {}, TEXT.missionWhat(this.title(status.action), status.map)), html("br"), TEXT.missionFacts(status), html("br"),
      html("span", { class: "quiet" }, status.reason || ""), ];
  }

  enable() {
    const state = this.status?.state;
    $("start").disabled = BUSY.includes(state) || !this.kinds.length;
    for (const id of ["queue-it", "set-schedule"]) $(id).disabled = !this.kinds.length;
    $("pause").disabled = state !== "running";
    $("resume").disabled = state !== "paused";
    $("cancel").disabled = !BUSY.includes(state);
    $("finish").hidden = !BUSY.includes(state) || !this.kinds.find(({ name }) => name === this.status.action)?.by_hand;
  }

  /** What the planner can be asked to do; asked again while it is away. */
  async learn() {
    if (this.kinds.length || this.learning) return;
    this.learning = true;
    try {
      this.kinds = await get(`/api/robots/${this.where().robot}/mission-kinds`);
    } catch {
      return; // the list of services says who is missing
    } finally {
      this.learning = false;
    }
    $("mission-kind").replaceChildren(...this.kinds.map(({ name, title }) => html("option", { value: name }, title || name)));
    this.choose();
    this.enable();
  }

  choose() {
    const properties = this.kind()?.parameters.properties || {};
    $("mission-parameters").replaceChildren(...Object.entries(properties).map(([name, schema]) => field(name, schema)));
  }

  kind() {
    return this.kinds.find(({ name }) => name === $("mission-kind").value);
  }

  title(name) {
    return this.kinds.find((kind) => kind.name === name)?.title || name;
  }

  /** The map that is shown is meant, until somebody writes the name of another. */
  mapShown(name) {
    if (name && !this.otherMap) $("new-map").value = name;
  }

  start() {
    return this.ask("missions", this.wanted());
  }

  /** What the form describes. */
  wanted() {
    const map = $("new-map").value.trim();
    const seed = Number.parseInt($("seed").value, 10) || 0;
    return { action: this.kind().name, map, seed, parameters: values($("mission-parameters")) };
  }

  goToNode(id) {
    return this.ask("missions", { action: "goto", map: this.where().map, goal_node: id });
  }

  goToPlace(place) {
    return this.ask("missions", { action: "goto", map: this.where().map, parameters: { place } });
  }

  goToSign(sign) {
    return this.ask("missions", { action: "goto", map: this.where().map, parameters: { sign } });
  }

  driveRoute(route, reverse) {
    return this.ask("missions", { action: "route", map: this.where().map, parameters: { route, reverse } });
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
