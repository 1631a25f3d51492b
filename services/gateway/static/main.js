// The page: connects the parts.

import { get } from "./api.js";
import { $, html } from "./dom.js";
import { Events } from "./events.js";
import { Goal } from "./goal.js";
import { Graph } from "./graph.js";
import { Live } from "./live.js";
import { Maps } from "./maps.js";
import { Mission } from "./mission.js";
import { hideNode, showNode } from "./node.js";
import { Panorama } from "./panorama.js";
import { Polar } from "./polar.js";

const SERVICES = ["simulator", "features", "map_store", "planner", "drive", "gateway"];
const DEFAULT_ROBOT = "r1";
const ROBOTS_MS = 5000;

let robot = "";
let connected = false;

const where = () => ({ robot, map: maps.name });
const panorama = new Panorama();
const polar = new Polar();
const events = new Events();
const graph = new Graph((id) => showNode(graph, maps.name, id, (node) => mission.goToNode(node), closeNode));
const mission = new Mission(where, (status) => maps.want(status.map));
const goal = new Goal(where, (ids) => graph.highlight(ids), (status) => mission.take(status));
const maps = new Maps(showMap, (text, bad) => mission.say(text, bad));
const live = new Live(heard, changed);

let shownMap = "";
function showMap(name) {
  graph.show(name);
  if (name === shownMap) return;
  shownMap = name;
  closeNode();
  if (name) goal.check();
}

function closeNode() {
  graph.chosen = null;
  graph.draw();
  hideNode();
}

function heard(type, data) {
  if (type === "frame") panorama.take(robot, data);
  else if (type === "ranges") polar.takeRanges(data);
  else if (type === "heading") { polar.takeHeading(data); panorama.mark(data); }
  else if (type === "event") events.take(data);
  else if (type === "services") showServices(data);
  else if (type === "status") {
    mission.take(data);
    graph.takeStatus(data);
    if (data.state === "running" && data.map !== maps.name && !maps.names.includes(data.map)) maps.want(data.map);
  }
}

function changed(up) {
  connected = up;
  $("connection").textContent = up ? "live" : "reconnecting";
  $("connection").classList.toggle("up", up);
  if (!up) showServices(null);
}

function showServices(counts) {
  const names = [...SERVICES, ...Object.keys(counts || {}).filter((name) => !SERVICES.includes(name))];
  $("services").replaceChildren(...names.map((name) => {
    const count = counts?.[name] || 0;
    const state = counts === null ? "unknown" : count ? "alive" : "missing";
    const label = `${name.replace("_", " ")}${count > 1 ? ` × ${count}` : ""}`;
    return html("li", { class: state, "aria-label": `${label}: ${state}`, title: state }, label);
  }));
}

/** Say what on the page is old. */
function checkAge() {
  const age = panorama.stale();
  let text = "";
  if (!connected) text = "Connection to the gateway lost. What you see is old; trying again …";
  else if (age) text = `No new picture for ${Math.round(age / 1000)} s: what you see is old.`;
  if ($("notice").textContent !== text) $("notice").textContent = text;
  $("notice").hidden = !text;
}

function follow(name) {
  robot = name;
  for (const part of [panorama, polar, events, mission]) part.clear();
  graph.status = null;
  live.follow(name);
}

async function listRobots() {
  let names = [];
  try {
    names = (await get("/api/robots")).map((entry) => entry.robot);
  } catch {
    return;
  }
  const all = [...new Set([robot || names[0] || DEFAULT_ROBOT, ...names])].sort();
  const shown = [...$("robot").options].map((option) => option.value);
  if (all.join() !== shown.join()) {
    $("robot").replaceChildren(...all.map((name) => html("option", { value: name }, name)));
    $("robot").value = robot || all[0];
  }
  if (!robot) follow($("robot").value);
}

$("robot").addEventListener("change", (event) => follow(event.target.value));
showServices(null);
setInterval(checkAge, 1000);
setInterval(() => document.hidden || listRobots(), ROBOTS_MS);
await listRobots();
if (!robot) follow(DEFAULT_ROBOT);
await maps.refresh();
