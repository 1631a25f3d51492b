// The map as a drawing: pan by dragging, zoom by wheel, choose a place by click or Enter.

import { get } from "./api.js";
import { $, svg } from "./dom.js";
import { place } from "./layout.js";

const GOAL = -1;
const POLL_MS = 5000;
const EACH_MS = 1200;

export class Graph {
  constructor(chosen) {
    this.root = $("graph");
    this.chosenTell = chosen;
    this.clear("");
    this.root.addEventListener("wheel", (event) => this.zoomBy(event), { passive: false });
    this.root.addEventListener("pointerdown", (event) => this.grab(event));
    new ResizeObserver(() => this.draw()).observe(this.root);
    setInterval(() => this.load(), POLL_MS);
  }

  clear(map) {
    this.map = map;
    this.nodes = [];
    this.edges = [];
    this.spots = new Map();
    this.revision = null;
    this.chosen = null;
    this.seen = new Set();
    this.zoom = 1;
    this.pan = { x: 0, y: 0 };
    this.draw();
  }

  show(map) {
    if (map !== this.map) this.clear(map);
    return this.load();
  }

  takeStatus(status) {
    const changed = this.status && (status.nodes !== this.status.nodes || status.edges !== this.status.edges);
    this.status = status;
    this.draw();
    if (changed && status.map === this.map) this.loadSoon();
  }

  /** Halo the places a goal picture resembles. */
  highlight(ids) {
    this.seen = new Set(ids);
    this.draw();
  }

  loadSoon() {
    if (this.soon) return;
    this.soon = setTimeout(() => { this.soon = null; this.load(); }, EACH_MS);
  }

  async load() {
    const map = this.map;
    if (!map || document.hidden) return;
    try {
      const facts = await get(`/api/maps/${map}`);
      if (map !== this.map || facts.revision === this.revision) return;
      const [nodes, edges] = await Promise.all([get(`/api/maps/${map}/nodes`), get(`/api/maps/${map}/edges`)]);
      if (map !== this.map) return;
      this.revision = facts.revision;
      this.nodes = nodes;
      this.edges = edges;
      this.spots = place(nodes, edges, this.spots);
      $("graph-facts").textContent = `${nodes.length} places, ${edges.length} connections, revision ${facts.revision}`;
    } catch (problem) {
      $("graph-facts").textContent = problem.status === 404 ? "not made yet" : problem.message;
      if (problem.status === 404 && this.nodes.length) this.clear(map);
    }
    this.draw();
  }

  draw() {
    $("no-graph").hidden = this.nodes.length > 0;
    const box = this.root.getBoundingClientRect();
    if (!this.nodes.length || !box.width) return this.root.replaceChildren();
    const focused = document.activeElement?.dataset?.node;
    const at = this.fit(box);
    const path = this.path();
    const shapes = [...this.drawEdges(at, path), ...this.drawNodes(at, path)];
    this.root.replaceChildren(...shapes);
    if (focused !== undefined) this.root.querySelector(`[data-node="${focused}"]`)?.focus();
  }

  path() {
    const status = this.status;
    const running = status && status.map === this.map && ["running", "paused"].includes(status.state);
    const via = running ? status.via_points : [];
    return { nodes: via.filter((id) => id !== GOAL), goal: via.includes(GOAL), nearest: running ? status.nearest_node : null };
  }

  /** From layout units to pixels. */
  fit(box) {
    const spots = [...this.spots.values()];
    const xs = spots.map((spot) => spot.x);
    const ys = spots.map((spot) => spot.y);
    const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    const scale = Math.min(110, (box.width - 80) / Math.max(0.5, right - left), (box.height - 80) / Math.max(0.5, high - low));
    this.scale = scale * this.zoom;
    return (spot) => [
      box.width / 2 + (spot.x - (left + right) / 2) * this.scale + this.pan.x,
      box.height / 2 - (spot.y - (low + high) / 2) * this.scale + this.pan.y,
    ];
  }

  drawEdges(at, path) {
    const pairs = new Set(path.nodes.slice(1).map((id, index) => [path.nodes[index], id].sort((a, b) => a - b).join()));
    const lines = this.edges.filter((edge) => this.spots.has(edge.a) && this.spots.has(edge.b)).map((edge) => {
      const [x1, y1] = at(this.spots.get(edge.a));
      const [x2, y2] = at(this.spots.get(edge.b));
      const kinds = `${pairs.has(`${edge.a},${edge.b}`) ? " path" : ""}${edge.suspended ? " suspended" : ""}`;
      const title = `${edge.a} to ${edge.b}: ${edge.inliers} inliers${edge.suspended ? ", suspended" : ""}`;
      return svg("line", { class: `edge${kinds}`, x1, y1, x2, y2 }, svg("title", {}, title));
    });
    const goal = this.goalSpot(path);
    if (goal) {
      const [x1, y1] = at(goal.from);
      const [x2, y2] = at(goal);
      lines.push(svg("line", { class: "edge guess", x1, y1, x2, y2 }));
    }
    return lines;
  }

  goalSpot(path) {
    const last = path.nodes.at(-1) ?? path.nearest;
    const from = path.goal ? this.spots.get(last) : undefined;
    return from ? { x: from.x + 0.35, y: from.y + 0.35, from } : null;
  }

  drawNodes(at, path) {
    const marks = this.nodes.map((node) => this.mark(node.node_id, at(this.spots.get(node.node_id)), path));
    const goal = this.goalSpot(path);
    if (goal) {
      const [x, y] = at(goal);
      const dot = svg("circle", { class: "dot", r: 9 });
      marks.push(svg("g", { class: "node-mark target", transform: `translate(${x} ${y})` }, dot, svg("text", { y: 22 }, "goal")));
    }
    return marks;
  }

  mark(id, [x, y], path) {
    const index = path.nodes.indexOf(id);
    const kind = index === 0 ? " start" : index > 0 ? " via" : "";
    const more = `${id === this.chosen ? " chosen" : ""}${this.seen.has(id) ? " seen" : ""}`;
    const role = ["", ", start of the path", ", via point"][index === 0 ? 1 : index > 0 ? 2 : 0];
    const near = id === path.nearest ? ", nearest to the robot" : "";
    const choose = () => { this.chosen = id; this.draw(); this.chosenTell(id); };
    return svg("g", {
      class: `node-mark${kind}${more}`, transform: `translate(${x} ${y})`, tabindex: 0, role: "button",
      "data-node": id, "aria-label": `Place ${id}${role}${near}`, onclick: choose,
      onkeydown: (event) => { if (event.key === "Enter" || event.key === " ") { event.preventDefault(); choose(); } },
    },
    this.seen.has(id) ? svg("circle", { class: "halo", r: 19 }) : null,
    id === path.nearest ? svg("circle", { class: "ring", r: 13 }) : null,
    svg("circle", { class: "dot", r: 8.5 }), svg("text", { y: 22 }, String(id)));
  }

  zoomBy(event) {
    event.preventDefault();
    this.zoom = Math.min(8, Math.max(0.3, this.zoom * Math.exp(-event.deltaY * 0.0015)));
    this.draw();
  }

  grab(event) {
    if (event.target.closest(".node-mark")) return;
    const from = { x: event.clientX - this.pan.x, y: event.clientY - this.pan.y };
    const move = (next) => { this.pan = { x: next.clientX - from.x, y: next.clientY - from.y }; this.draw(); };
    const end = () => { removeEventListener("pointermove", move); removeEventListener("pointerup", end); };
    addEventListener("pointermove", move);
    addEventListener("pointerup", end);
  }
}
