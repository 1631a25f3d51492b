// Positions for a map that has none: from the headings between its nodes, then relaxed. Pure.
//
// Edge a-b: heading_ab in a's camera frame, heading_ba in b's, yaw_ab the turn from a's camera to b's. With theta_a the
// direction a's camera looks to, b lies at theta_a + heading_ab and looks to theta_a + yaw_ab. Lengths are unknown: 1.

const ROUNDS = 120;
const FEW_ROUNDS = 25;
const PULL = 0.18;
const PUSH = 0.035;
const CLOSE = 0.8;
const AROUND = [-1, 0, 1].flatMap((i) => [-1, 0, 1].map((j) => [i, j]));

/** Returns Map id -> {x, y}, y up; `before` keeps a growing map from jumping. */
export function place(nodes, edges, before = new Map()) {
  const ids = nodes.map((node) => node.node_id);
  const known = new Set(ids);
  const links = edges.filter((edge) => known.has(edge.a) && known.has(edge.b));
  const views = orient(ids, links);
  const spots = new Map();
  for (const id of ids) spots.set(id, { ...(before.get(id) || first(id, views, spots)) });
  const grown = ids.filter((id) => !before.has(id)).length;
  const rounds = grown * 10 < ids.length ? FEW_ROUNDS : ROUNDS; // a map that grew a little hardly moves
  for (let round = 0; round < rounds; round += 1) relax(ids, links, views, spots, 1 - round / rounds);
  return spots;
}

/** Which way every node's camera looked, along a spanning tree of the surest edges; with the parent it hangs on. */
function orient(ids, links) {
  const sure = [...links].sort((one, two) => (two.confidence || 0) - (one.confidence || 0));
  const around = new Map(ids.map((id) => [id, []]));
  for (const edge of sure) {
    around.get(edge.a).push(edge);
    around.get(edge.b).push(edge);
  }
  const views = new Map();
  for (const root of ids) {
    if (views.has(root)) continue;
    views.set(root, { theta: 0, parent: null, bearing: 0 });
    const waiting = [root];
    while (waiting.length) {
      const at = waiting.shift();
      for (const edge of around.get(at)) {
        const next = edge.a === at ? edge.b : edge.a;
        if (views.has(next)) continue;
        const theta = views.get(at).theta;
        const bearing = towards(edge, at, theta);
        views.set(next, { theta: theta + turned(edge, at), parent: at, bearing });
        waiting.push(next);
      }
    }
  }
  return views;
}

function towards(edge, from, theta) {
  const heading = from === edge.a ? edge.heading_ab_rad : edge.heading_ba_rad;
  return heading === null || heading === undefined ? null : theta + heading;
}

/** The turn from `from`'s camera to the other end's. */
function turned(edge, from) {
  const { yaw_ab_rad: yaw, heading_ab_rad: ab, heading_ba_rad: ba } = edge;
  let turn = 0;
  if (yaw !== null && yaw !== undefined) turn = yaw;
  else if (ab !== null && ab !== undefined && ba !== null && ba !== undefined) turn = ab + Math.PI - ba;
  return from === edge.a ? turn : -turn;
}

function first(id, views, spots) {
  const view = views.get(id);
  const base = view.parent === null ? null : spots.get(view.parent);
  const angle = view.bearing ?? spread(id);
  if (!base) return { x: 0.3 * Math.cos(spread(id)), y: 0.3 * Math.sin(spread(id)) };
  return { x: base.x + Math.cos(angle), y: base.y + Math.sin(angle) };
}

const spread = (id) => (id * 2.399963) % (2 * Math.PI); // golden angle: even, and the same every time

function relax(ids, links, views, spots, heat) {
  for (const edge of links) pull(edge, views, spots);
  for (const [one, two] of closePairs(ids, spots)) push(one, two, heat);
}

/** Pairs of spots in the same or neighbouring cells of a grid: nothing farther apart is pushed. */
function* closePairs(ids, spots) {
  const cells = new Map();
  for (const id of ids) {
    const spot = spots.get(id);
    const [column, row] = [Math.floor(spot.x / CLOSE), Math.floor(spot.y / CLOSE)];
    for (const [i, j] of AROUND) {
      for (const other of cells.get(`${column + i},${row + j}`) || []) yield [other, spot];
    }
    const own = `${column},${row}`;
    if (cells.has(own)) cells.get(own).push(spot);
    else cells.set(own, [spot]);
  }
}

function pull(edge, views, spots) {
  const a = spots.get(edge.a);
  const b = spots.get(edge.b);
  const bearings = [towards(edge, edge.a, views.get(edge.a).theta), towards(edge, edge.b, views.get(edge.b).theta)];
  let wanted = { x: 0, y: 0 };
  if (bearings[0] !== null) wanted = { x: Math.cos(bearings[0]), y: Math.sin(bearings[0]) };
  if (bearings[1] !== null) wanted = { x: wanted.x - Math.cos(bearings[1]), y: wanted.y - Math.sin(bearings[1]) };
  let size = Math.hypot(wanted.x, wanted.y);
  if (size < 0.2) {
    wanted = { x: b.x - a.x || 0.01, y: b.y - a.y || 0.01 };
    size = Math.hypot(wanted.x, wanted.y);
  }
  const dx = PULL * (wanted.x / size - (b.x - a.x));
  const dy = PULL * (wanted.y / size - (b.y - a.y));
  b.x += dx; b.y += dy; a.x -= dx; a.y -= dy;
}

function push(one, two, heat) {
  let dx = two.x - one.x;
  let dy = two.y - one.y;
  let apart = Math.hypot(dx, dy);
  if (apart > CLOSE) return;
  if (apart < 1e-3) { dx = 0.01; dy = 0.013; apart = 0.0164; }
  const by = (PUSH * heat * (CLOSE - apart)) / apart;
  one.x -= dx * by; one.y -= dy * by; two.x += dx * by; two.y += dy * by;
}
