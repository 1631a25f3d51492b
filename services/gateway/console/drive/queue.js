// The queue of a robot and its schedules: listed, added to from the mission's form, moved, cancelled.

import { call, get, post } from "../page/api.js";
import { confirmed } from "../page/ask.js";
import { $, html, table } from "../page/dom.js";
import { TEXT } from "../page/text.js";

const PERIOD_MS = 2000;
const PRIORITIES = [9, 8, 7, 6, 5, 4, 3, 2, 1, 0];
const OPEN = ["queued", "running"];

const when = (text) => (text ? html("time", { datetime: text }, new Date(text).toLocaleString()) : "–");

export class Queue {
  /** `wanted()` is the mission that its form describes; `say(text)` of refusals; `shown()` whether this is looked at. */
  constructor(where, wanted, say, shown) {
    Object.assign(this, { where, wanted, say, shown, seen: "" });
    $("queue-it").addEventListener("click", () => this.add());
    $("schedule-form").addEventListener("submit", (event) => { event.preventDefault(); this.schedule(); });
    $("schedule-zone").value = Intl.DateTimeFormat().resolvedOptions().timeZone || "UTC";
    $("whole-fleet").addEventListener("change", () => this.clear());
    setInterval(() => !document.hidden && shown() && this.show(), PERIOD_MS);
  }

  clear() {
    this.seen = "";
    $("queue-why").textContent = "";
    for (const id of ["task-list", "ended-tasks", "schedules"]) $(id).replaceChildren();
    if (this.shown()) this.show();
  }

  /** Tasks are those of the robot, or of the whole fleet; schedules are a robot's. */
  url(path) {
    const robot = this.ofFleet() && path.startsWith("tasks") ? "any" : this.where().robot;
    return `/api/robots/${robot}/${path}`;
  }

  ofFleet() {
    return $("whole-fleet").checked;
  }

  async show() {
    const [robot, ofFleet] = [this.where().robot, this.ofFleet()];
    if (!robot) return;
    try {
      const [queue, schedules] = await Promise.all([get(this.url("tasks?ended=8")), get(this.url("schedules"))]);
      const seen = JSON.stringify([queue, schedules]);
      const busy = document.activeElement?.closest("#task-list select");
      if (robot !== this.where().robot || ofFleet !== this.ofFleet() || seen === this.seen || busy) return;
      this.seen = seen;
      this.list(queue);
      this.listSchedules(schedules);
    } catch (problem) {
      $("queue-why").textContent = problem.message;
      $("queue-why").classList.add("bad");
    }
  }

  list(queue) {
    $("queue-why").textContent = TEXT.queueWhy(queue);
    $("queue-why").classList.toggle("bad", Boolean(queue.alarm));
    const rows = queue.tasks.map((task) => [this.what(task), this.state(task),
      task.state === "running" ? String(task.priority) : this.priority(task), this.canceller(task)]);
    $("task-list").replaceChildren(rows.length ? table(TEXT.taskColumns, rows) : html("p", { class: "quiet" }, TEXT.noTasks));
    const ended = queue.ended.map((task) => [this.what(task), this.state(task), when(task.ended), task.reason]);
    $("ended-tasks").replaceChildren(...(ended.length ? [table(TEXT.endedColumns, ended)] : []));
  }

  what(task) {
    return html("span", { title: `${task.task_id}${task.by ? `, ${task.by}` : ""}` }, TEXT.task(task) + (this.ofFleet() ? TEXT.taskOf(task) : ""));
  }

  state(task) {
    return html("span", { class: `state ${OPEN.includes(task.state) ? "" : task.state}` }, task.failure.replaceAll("_", " ") || task.state);
  }

  priority(task) {
    const options = PRIORITIES.map((value) => html("option", { value, selected: value === task.priority }, String(value)));
    const change = (event) => {
      event.target.blur();
      this.write("PATCH", `tasks/${task.task_id}`, { priority: Number(event.target.value) });
    };
    return html("select", { "aria-label": TEXT.priorityOf(task), onchange: change }, ...options);
  }

  canceller(task) {
    const cancel = async () => {
      if (task.state === "running" && !(await confirmed(TEXT.cancelRunning(task), TEXT.cancelIt))) return;
      await this.write("DELETE", `tasks/${task.task_id}`);
    };
    return html("button", { type: "button", class: "danger", "aria-label": TEXT.cancelTask(task), onclick: cancel }, TEXT.cancelIt);
  }

  listSchedules(schedules) {
    const rows = schedules.map((one) => {
      const remove = async () => {
        if (await confirmed(TEXT.removeSchedule(one.name), TEXT.remove)) await this.write("DELETE", `schedules/${one.name}`);
      };
      const toggle = () => {
        const { cron, time_zone, task, enabled } = one;
        return this.write("PUT", `schedules/${one.name}`, { cron, time_zone, task, enabled: !enabled });
      };
      return [one.name, TEXT.schedule(one), one.enabled ? when(one.next) : TEXT.off,
        html("span", { class: "row" },
          html("button", { type: "button", onclick: toggle }, one.enabled ? TEXT.turnOff : TEXT.turnOn),
          html("button", { type: "button", class: "danger", onclick: remove }, TEXT.remove))];
    });
    $("schedules").replaceChildren(rows.length ? table(TEXT.scheduleColumns, rows) : html("p", { class: "quiet" }, TEXT.noSchedules));
  }

  async add() {
    const { action: kind, ...rest } = this.wanted();
    if (await this.write("POST", "tasks", { kind, ...rest })) this.say(this.shown() ? "" : TEXT.queued);
  }

  schedule() {
    const { action: kind, ...rest } = this.wanted();
    const [cron, zone] = [$("schedule-cron").value.trim(), $("schedule-zone").value.trim()];
    return this.write("PUT", `schedules/${$("schedule-name").value.trim()}`, { cron, time_zone: zone, task: { kind, ...rest } });
  }

  /** Whether it was done. */
  async write(method, path, content) {
    try {
      if (method === "POST") await post(this.url(path), content);
      else await call(method, this.url(path), content && JSON.stringify(content), content && "application/json");
      this.say("");
      return true;
    } catch (problem) {
      this.say(problem.message);
      return false;
    } finally {
      await this.show();
    }
  }
}
