// The page: connects the parts.

import { get } from "./page/api.js";
import { $, html } from "./page/dom.js";
import { Body } from "./drive/body.js";
import { ByHand } from "./drive/by_hand.js";
import { EStop } from "./page/estop.js";
import { Events } from "./record/events.js";
import { Goal } from "./drive/goal.js";
import { Graph } from "./map/graph.js";
import { History } from "./record/history.js";
import { Inspector } from "./map/inspector.js";
import { Live } from "./page/live.js";
import { MapTable } from "./map/map_table.js";
import { Maps } from "./map/maps.js";
import { Marks } from "./map/marks.js";
import { Matches } from "./drive/matches.js";
import { Mission } from "./drive/mission.js";
import { Panorama } from "./drive/panorama.js";
import { Queue } from "./drive/queue.js";
import { Polar } from "./drive/polar.js";
import { Robots } from "./map/robots.js";
import { Routes } from "./map/routes.js";
import { Signs } from "./map/signs.js";
import { Runs } from "./record/runs.js";
import { locked } from "./page/session.js";
import { TEXT } from "./page/text.js";
import { Views } from "./page/views.js";

const SERVICES = ["simulator", "features", "map_store", "planner", "drive", "gateway"]; // no robot drives without
const REAL = ["ros", "camera"]; // in whose place no simulator is missed
const BODY = ["odometry", "imu", "battery", "camera"];
const DEFAULT_ROBOT = "r1";
const ROBOTS_MS = 2000;
const SAID_MS = 8000;

let robot = "";
let connected = false;
let turnedAway = false;
let shownMap = "";
let saying = 0;

const met = new Set(); // other services, which are missed once they were there
const where = () => ({ robot, map: maps.name });
const panorama = new Panorama();
const polar = new Polar();
const history = new History();
const events = new Events(showMoment);
const matches = new Matches(where, (match) => polar.takeMatch(match));
const graph = new Graph((what) => inspector.open(what));
const robots = new Robots(graph, choose);
const inspector = new Inspector(graph, (node) => mission.goToNode(node), (node) => marks.name([node]), () => graph.load(), say);
const marks = new Marks(graph, (name) => mission.goToPlace(name), (node) => inspector.open({ node }), say);
const routes = new Routes(graph, (name, reverse) => mission.driveRoute(name, reverse), say);
const signs = new Signs(graph, (name) => mission.goToSign(name), (node) => inspector.open({ node }), say);
const mission = new Mission(where, (status) => maps.want(status.map));
const goal = new Goal(where, (ids) => graph.highlight(ids), (status) => mission.take(status));
const maps = new Maps(showMap, () => views.name === "maps" && mapTable.show());
const mapTable = new MapTable(maps);
const runs = new Runs();
const estop = new EStop(where, say);
const byHand = new ByHand(where, say);
const queue = new Queue(where, () => mission.wanted(), say, () => document.body.dataset.view === "tasks");
const body = new Body();
const live = new Live(heard, changed);
const views = new Views(viewChanged);

function viewChanged(view) {
  if (view !== "drive") byHand.release(); // nobody drives what he does not see
  if (view === "drive") {
    inspector.uncover();
    panorama.resume();
  } else if (view === "why") history.open();
  else if (view === "maps") maps.refresh().then(() => mapTable.show());
  else if (view === "runs") runs.show();
  else if (view === "tasks") queue.show();
  else if (view === "map") marks.inspections();
}

function showMap(name) {
  graph.show(name);
  if (name === shownMap) return;
  shownMap = name;
  mission.mapShown(name);
  $("true-positions").checked = false;
  inspector.close();
  if (name) goal.check();
}

/** A decision in the timeline: its step in the charts, its nodes in the map. */
function showMoment(event) {
  if (views.name !== "why") views.go("why");
  history.mark(event.step);
  const value = (name) => event.values.find((entry) => entry.name === name)?.value;
  const [node, a, b] = [value("node"), value("a"), value("b")];
  if (a !== undefined && b !== undefined) inspector.open({ edge: [Math.min(a, b), Math.max(a, b)] });
  else if (typeof node === "number" && node >= 0) inspector.open({ node });
}

async function placeTruly(wanted) {
  if (!wanted) return graph.place(null);
  try {
    const { positions } = await get(`/api/robots/${robot}/true-positions?map=${maps.name}`);
    if (Object.keys(positions).length) return graph.place(positions);
    say(TEXT.noTruth);
  } catch (problem) {
    say(problem.message);
  }
  $("true-positions").checked = false;
  return undefined;
}

/** A refusal, in every view, for a while; an empty text takes it back. */
function say(text) {
  clearTimeout(saying);
  $("said").textContent = text;
  $("said").hidden = !text;
  if (text) saying = setTimeout(() => say(""), SAID_MS);
}

function heard(type, data) {
  if (type === "frame") panorama.take(robot, data);
  else if (type === "ranges") polar.takeRanges(data);
  else if (type === "heading") { polar.takeHeading(data); panorama.mark(data); history.takeHeading(data); }
  else if (type === "velocity") { polar.takeVelocity(data); history.takeVelocity(data); }
  else if (type === "estop") estop.take(data);
  else if (BODY.includes(type)) body.take(type, data);
  else if (type === "event") events.take(data);
  else if (type === "services") {
    showServices(data);
    if (data.planner) mission.learn();
  }
  else if (type === "status") {
    mission.take(data);
    graph.takeStatus(data);
    matches.takeStatus(data);
    history.takeStatus(data);
    $("travel").textContent = TEXT.travel(data.travel, data.travel_reason);
    if (data.state === "running" && data.map !== maps.name && !maps.names.includes(data.map)) maps.want(data.map);
  }
}

function changed(up, full = false) {
  connected = up;
  turnedAway = full;
  $("connection").textContent = up ? TEXT.live : TEXT.reconnecting;
  $("connection").classList.toggle("up", up);
  if (!up) showServices(null);
}

function showServices(counts) {
  const told = Object.keys(counts || {});
  const real = REAL.some((name) => told.includes(name)) && !counts.simulator;
  const expected = SERVICES.filter((name) => name !== "simulator" || !real);
  for (const name of told) if (!SERVICES.includes(name)) met.add(name);
  const names = [...expected, ...met];
  $("services").replaceChildren(...names.map((name) => {
    const count = counts?.[name] || 0;
    const state = counts === null ? "unknown" : count ? "alive" : "missing";
    const label = `${name.replace("_", " ")}${count > 1 ? ` × ${count}` : ""}`;
    return html("li", { class: state, title: state }, label, html("span", { class: "hidden" }, ` ${state}`));
  }));
}

/** Say what on the page is old. */
function checkAge() {
  const age = panorama.stale(mission.status?.state === "running");
  const lost = locked ? TEXT.tokenNeeded : turnedAway ? TEXT.full : TEXT.lost;
  const text = !connected ? lost : age ? TEXT.old(Math.round(age / 1000)) : "";
  if ($("notice").textContent !== text) $("notice").textContent = text;
  $("notice").hidden = !text;
}

function follow(name) {
  byHand.release();
  robot = name;
  for (const part of [panorama, polar, body, events, mission, history, matches, estop, queue]) part.clear();
  graph.status = null;
  $("travel").textContent = "";
  live.follow(name);
}

/** Follow another robot, as if it was chosen above. */
function choose(name) {
  $("robot").value = name;
  follow(name);
}

async function listRobots() {
  let heard = [];
  try {
    heard = await get("/api/robots");
  } catch {
    return;
  }
  const names = heard.map((entry) => entry.robot);
  const first = names.includes(DEFAULT_ROBOT) ? DEFAULT_ROBOT : names[0] || DEFAULT_ROBOT; // not a recording that was played
  const all = [...new Set([robot || first, ...names])].sort();
  const shown = [...$("robot").options].map((option) => option.value);
  if (all.join() !== shown.join()) {
    $("robot").replaceChildren(...all.map((name) => html("option", { value: name }, name)));
    $("robot").value = robot || first;
  }
  if (!robot) follow($("robot").value);
  robots.take(heard, robot);
}

$("robot").addEventListener("change", (event) => follow(event.target.value));
$("fit").addEventListener("click", () => graph.fit());
$("zoom-in").addEventListener("click", () => graph.zoomBy(1.25));
$("zoom-out").addEventListener("click", () => graph.zoomBy(0.8));
$("true-positions").addEventListener("change", (event) => placeTruly(event.target.checked));
showServices(null);
setInterval(checkAge, 1000);
setInterval(() => document.hidden || listRobots(), ROBOTS_MS);
await listRobots();
if (!robot) follow(DEFAULT_ROBOT);
await maps.refresh();
