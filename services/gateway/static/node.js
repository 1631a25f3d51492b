// What is known of one chosen place: picture, connections with their evidence, and the order to go there.

import { $, html, side } from "./dom.js";

export function showNode(graph, map, id, goThere, closed) {
  const panel = $("node");
  const node = graph.nodes.find((candidate) => candidate.node_id === id);
  if (!node) return hideNode();
  const edges = graph.edges.filter((edge) => edge.a === id || edge.b === id);
  const close = html("button", { type: "button", "aria-label": "Close", onclick: closed }, "✕");
  const picture = html("img", {
    src: `/api/maps/${map}/nodes/${id}/thumbnail`, alt: `View from place ${id}`, width: 256, height: 128,
    onerror: (event) => event.target.remove(),
  });
  const open = (node.open || []).filter((is, sector) => is && !(node.explored || [])[sector]).length;
  panel.replaceChildren(
    html("div", { class: "head" }, html("h2", {}, `Place ${id}`), close),
    picture,
    html("p", { class: "quiet" }, `${node.keypoints ?? 0} keypoints, ${open} unexplored directions`),
    edges.length ? edgeTable(edges, id, graph) : html("p", { class: "quiet" }, "No connections."),
    html("button", { type: "button", class: "primary", id: "go-there", onclick: () => goThere(id) }, "Go there"),
  );
  panel.hidden = false;
}

export function hideNode() {
  $("node").hidden = true;
}

function edgeTable(edges, id) {
  const rows = edges.map((edge) => {
    const there = edge.a === id ? edge.b : edge.a;
    const heading = edge.a === id ? edge.heading_ab_rad : edge.heading_ba_rad;
    return html("tr", {}, html("td", {}, `${there}${edge.suspended ? " (suspended)" : ""}`),
      html("td", {}, side(heading)), html("td", {}, String(edge.inliers ?? "–")),
      html("td", {}, edge.confidence === undefined ? "–" : edge.confidence.toFixed(2)));
  });
  const head = ["to", "direction", "inliers", "trust"].map((text) => html("th", { scope: "col" }, text));
  return html("table", {}, html("thead", {}, html("tr", {}, ...head)), html("tbody", {}, ...rows));
}
