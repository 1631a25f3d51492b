// Explorations, drives and evaluations, newest first, with their figures.

import { get } from "../page/api.js";
import { $, html, table } from "../page/dom.js";
import { TEXT } from "../page/text.js";

const number = (value) => (typeof value === "number" ? String(+value.toFixed(3)) : String(value ?? "–"));

export class Runs {
  async show() {
    let runs;
    try {
      runs = await get("/api/runs");
    } catch (problem) {
      $("runs").replaceChildren(html("p", { class: "answer bad" }, problem.message));
      return;
    }
    const rows = runs.map((run) => [
      html("time", { datetime: run.ended }, run.ended ? new Date(run.ended).toLocaleString() : "–"),
      run.title, run.map || run.world || "–",
      html("span", { class: `state ${run.outcome || ""}` }, run.outcome || "–"),
      Object.entries(run.figures).map(([name, value]) => `${name.replaceAll("_", " ")} ${number(value)}`).join(", "),
    ]);
    $("runs").replaceChildren(rows.length
      ? table(TEXT.runColumns, rows)
      : html("p", { class: "quiet" }, TEXT.noRuns));
  }
}
