// The map as a drawing (cytoscape): drag to pan, wheel to zoom, click a node or an edge.

import { get } from "../page/api.js";
import { $ } from "../page/dom.js";
import { look } from "./graph_style.js";
import { place } from "./layout.js";
import { TEXT } from "../page/text.js";
import cytoscape from "../vendor/cytoscape.esm.min.js";

const GOAL = -1;
const POLL_MS = 5000;
const EACH_MS = 1200;
const UNIT_PX = 70;
const MANY = 1500;
const KEY_PAN_PX = 60;
const DARK = matchMedia("(prefers-color-scheme: dark)");

export class Graph {
  /** `chosen({node})` or `chosen({edge: [a, b]})` hears of clicks. */
  constructor(chosen) {
    this.cy = cytoscape({
      container: $("graph"), style: look(), minZoom: 0.03, maxZoom: 4, autoungrabify: true, boxSelectionEnabled: false,
      textureOnViewport: true, pixelRatio: Math.min(devicePixelRatio, 2),
    });
    this.cy.on("tap", "node", (event) => {
      const id = event.target.data("number");
      if (id === undefined) return; // the goal, or a robot
      if (this.picking) this.take(id, !this.picked.has(id));
      else chosen({ node: id });
    });
    this.cy.on("boxselect", "node", (event) => this.picking && event.target.data("number") !== undefined && this.take(event.target.data("number"), true));
    this.cy.on("select", (event) => event.target.unselect());
    this.cy.on("tap", "edge", (event) => !this.picking && event.target.data("ends") && chosen({ edge: event.target.data("ends") }));
    this.cy.on("dragpan scrollzoom pinchzoom", () => { this.moved = true; });
    DARK.addEventListener("change", () => this.cy.style(look()));
    $("graph").addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.resized()).observe($("graph"));
    setInterval(() => this.load(), POLL_MS);
    this.onMarks = []; // called when places, rules, routes or signs may be others
    this.clear("");
  }

  clear(map) {
    Object.assign(this, { map, nodes: [], edges: [], spots: new Map(), revision: null, truth: null, moved: false });
    Object.assign(this, { places: [], rules: [], routes: [], signs: [], route: null, seen: new Set(), picked: new Set() });
    this.picks?.();
    this.onMarks.forEach((hear) => hear());
    this.cy.elements().remove();
    $("no-graph").hidden = false;
  }

  show(map) {
    if (map !== this.map) this.clear(map);
    return this.load();
  }

  resized() {
    this.cy.resize();
    if (!this.moved) this.fit();
  }

  fit() {
    if (!this.nodes.length || !$("graph").clientWidth) return;
    this.cy.fit(undefined, 40);
    if (this.cy.zoom() > 1.4) { this.cy.zoom(1.4); this.cy.center(); }
    this.moved = false;
  }

  zoomBy(factor) {
    this.moved = true;
    const box = $("graph").getBoundingClientRect();
    this.cy.zoom({ level: this.cy.zoom() * factor, renderedPosition: { x: box.width / 2, y: box.height / 2 } });
  }

  panBy(right, down) {
    this.moved = true;
    this.cy.panBy({ x: right * KEY_PAN_PX, y: down * KEY_PAN_PX });
  }

  key(event) {
    const pans = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const pan = pans[event.key];
    if (pan) this.panBy(...pan);
    else if (event.key === "+") this.zoomBy(1.25);
    else if (event.key === "-") this.zoomBy(0.8);
    else if (event.key === "0") this.fit();
    else return;
    event.preventDefault();
  }

  takeStatus(status) {
    const changed = this.status && (status.nodes !== this.status.nodes || status.edges !== this.status.edges);
    this.status = status;
    this.paint();
    if (changed && status.map === this.map) this.loadSoon();
  }

  /** Halo the nodes a goal picture resembles. */
  highlight(ids) {
    this.seen = new Set(ids);
    this.paint();
  }

  /** Nodes are picked, by clicks and by dragging a frame round them, instead of shown; off forgets those picked. */
  pick(on) {
    this.picking = on;
    this.picked = new Set();
    this.cy.userPanningEnabled(!on);
    this.cy.boxSelectionEnabled(on);
    this.paintMarks();
  }

  take(id, on) {
    if (on) this.picked.add(id);
    else this.picked.delete(id);
    this.cy.getElementById(`n${id}`).toggleClass("picked", on);
    this.picks?.();
  }

  /** Draw one route of the map; null draws none. */
  showRoute(name) {
    this.route = name;
    this.paintMarks();
  }

  /** Nodes that a keep-out is about, by itself or by its areas. */
  forbidden() {
    const areas = new Map(this.places.map((place) => [place.name.toLowerCase(), place.nodes]));
    return this.rules.filter((rule) => rule.kind === "keep_out")
      .flatMap((rule) => [...rule.nodes, ...rule.areas.flatMap((area) => areas.get(area.toLowerCase()) || [])]);
  }

  /** Mark a node or an edge and bring it into sight. */
  choose({ node, edge }) {
    this.cy.elements(".chosen").removeClass("chosen");
    const id = node !== undefined ? `n${node}` : edge ? `e${edge[0]}-${edge[1]}` : null;
    const element = id ? this.cy.getElementById(id) : null;
    if (!element?.length) return;
    element.addClass("chosen");
    const box = this.cy.extent();
    const at = element.boundingBox();
    if (at.x1 < box.x1 || at.x2 > box.x2 || at.y1 < box.y1 || at.y2 > box.y2) this.cy.center(element);
  }

  /** True positions instead of the drawing made from bearings; null goes back. */
  place(truth) {
    this.truth = truth;
    this.arrange();
    this.fit();
  }

  loadSoon() {
    if (this.soon) return;
    this.soon = setTimeout(() => { this.soon = null; this.load(); }, EACH_MS);
  }

  /** Fetch what changed; the promise ends when the drawing shows it, or why not. */
  load() {
    const map = this.map;
    if (!map || document.hidden) return Promise.resolve();
    if (this.loading?.map !== map) this.loading = { map, done: this.fetch(map) };
    return this.loading.done;
  }

  async fetch(map) {
    try {
      const facts = await get(`/api/maps/${map}`);
      if (map !== this.map || facts.revision === this.revision) return;
      const [nodes, edges, places, rules, routes, signs] = await Promise.all(
        ["nodes", "edges", "places", "rules", "routes", "signs"].map((part) => get(`/api/maps/${map}/${part}`)));
      if (map !== this.map) return;
      const spots = await this.layOut(nodes, edges);
      if (map !== this.map) return;
      Object.assign(this, { revision: facts.revision, nodes, edges, spots, places, rules, routes, signs });
      this.draw();
      this.onMarks.forEach((hear) => hear());
      $("graph-facts").textContent = TEXT.graphFacts(nodes.length, edges.length, facts.revision);
    } catch (problem) {
      $("graph-facts").textContent = problem.status === 404 ? TEXT.graphNone : problem.message;
      if (problem.status === 404 && this.nodes.length) this.clear(map);
    } finally {
      if (this.loading?.map === map) this.loading = null;
    }
  }

  /** A large map takes seconds: a worker does it, one map at a time. */
  layOut(nodes, edges) {
    if (nodes.length <= MANY) return place(nodes, edges, this.spots);
    this.worker?.terminate();
    this.worker = new Worker("/static/map/layout_worker.js", { type: "module" });
    return new Promise((resolve) => {
      this.worker.addEventListener("message", ({ data }) => resolve(data), { once: true });
      this.worker.postMessage({ nodes, edges, before: this.spots });
    });
  }

  draw() {
    $("no-graph").hidden = this.nodes.length > 0;
    $("graph").dataset.nodes = this.nodes.length;
    $("graph").dataset.edges = this.edges.length;
    this.cy.renderer().hideEdgesOnViewport = this.nodes.length > MANY;
    const known = new Set(this.nodes.map((node) => node.node_id));
    const drawn = this.edges.filter((edge) => known.has(edge.a) && known.has(edge.b));
    const wanted = new Map([
      ...this.nodes.map(({ node_id: id }) => [`n${id}`, { group: "nodes", data: { id: `n${id}`, number: id, label: String(id) } }]),
      ...drawn.map(({ a, b }) => [`e${a}-${b}`, { group: "edges", data: { id: `e${a}-${b}`, source: `n${a}`, target: `n${b}`, ends: [a, b] } }]),
    ]);
    this.cy.batch(() => {
      this.cy.elements().filter((element) => !wanted.has(element.id()) && element.id() !== "goal" && !element.hasClass("robot")).remove();
      this.cy.add([...wanted.values()].filter((element) => !this.cy.getElementById(element.data.id).length));
      for (const { a, b, suspended } of drawn) this.cy.getElementById(`e${a}-${b}`).toggleClass("suspended", suspended);
      this.cy.elements().toggleClass("many", this.nodes.length > MANY);
    });
    this.arrange();
    this.paint();
    this.paintMarks();
    if (!this.moved) this.fit();
  }

  arrange() {
    const at = (id) => {
      const [x, y] = this.truth?.[id] || [];
      if (this.truth) return x === undefined ? null : { x: x * UNIT_PX * 1.5, y: -y * UNIT_PX * 1.5 };
      const spot = this.spots.get(id);
      return { x: spot.x * UNIT_PX, y: -spot.y * UNIT_PX };
    };
    this.cy.batch(() => this.nodes.forEach(({ node_id: id }) => {
      const spot = at(id);
      const element = this.cy.getElementById(`n${id}`);
      element.toggleClass("unplaced", !spot);
      if (spot) element.position(spot);
    }));
  }

  /** Colours of the path, the robot's nearest node and the goal. */
  paint() {
    const path = this.path();
    this.cy.getElementById("goal").remove();
    this.cy.batch(() => {
      this.cy.elements().removeClass("start via path near seen");
      path.nodes.forEach((id, index) => this.cy.getElementById(`n${id}`).addClass(index ? "via" : "start"));
      path.nodes.slice(1).forEach((id, index) => {
        const [a, b] = [path.nodes[index], id].sort((one, two) => one - two);
        this.cy.getElementById(`e${a}-${b}`).addClass("path");
      });
      for (const id of this.seen) this.cy.getElementById(`n${id}`).addClass("seen");
      if (path.nearest !== null) this.cy.getElementById(`n${path.nearest}`).addClass("near");
    });
    if (path.goal) this.addGoal(path.nodes.at(-1) ?? path.nearest);
    const text = TEXT.path(path);
    if ($("path-text").textContent !== text) $("path-text").textContent = text;
  }

  /** Names in place of numbers, areas, and what rules are about. */
  paintMarks() {
    const names = new Map(this.places.map(({ name, nodes: [first] }) => [first, name]));
    const areas = new Set(this.places.flatMap(({ nodes }) => (nodes.length > 1 ? nodes : [])));
    const forbidden = new Set(this.forbidden());
    const ruled = new Set(this.rules.flatMap((rule) => rule.edges || []).map(([a, b]) => `e${Math.min(a, b)}-${Math.max(a, b)}`));
    const driven = this.routes.find((route) => route.name === this.route)?.nodes || [];
    const stops = new Set(driven);
    const legs = new Set(driven.slice(1).map((id, k) => `e${Math.min(driven[k], id)}-${Math.max(driven[k], id)}`));
    this.cy.batch(() => {
      for (const { node_id: id } of this.nodes) {
        const element = this.cy.getElementById(`n${id}`);
        element.data("label", names.get(id) ?? String(id));
        element.toggleClass("area", areas.has(id)).toggleClass("forbidden", forbidden.has(id)).toggleClass("picked", this.picked.has(id));
        element.toggleClass("on-route", stops.has(id)).toggleClass("route-start", id === driven[0]);
      }
      this.cy.edges().forEach((edge) => { edge.toggleClass("ruled", ruled.has(edge.id())).toggleClass("on-route", legs.has(edge.id())); });
    });
    Object.assign($("graph").dataset, { places: this.places.length, forbidden: forbidden.size, routes: this.routes.length, route: driven.length });
  }

  addGoal(last) {
    const from = this.cy.getElementById(`n${last}`);
    if (!from.length) return;
    const { x, y } = from.position();
    const spot = { x: x + UNIT_PX * 0.5, y: y - UNIT_PX * 0.5 };
    this.cy.add([
      { group: "nodes", data: { id: "goal", label: TEXT.goal }, classes: "target", position: spot },
      { group: "edges", data: { id: "to-goal", source: `n${last}`, target: "goal" }, classes: "guess" },
    ]);
  }

  path() {
    const status = this.status;
    const running = status && status.map === this.map && ["running", "paused"].includes(status.state);
    const via = running ? status.via_points : [];
    const nearest = running ? (status.nearest_node ?? null) : null;
    return { nodes: via.filter((id) => id !== GOAL), goal: via.includes(GOAL), nearest };
  }
}
