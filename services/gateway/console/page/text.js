// Every sentence that scripts put on the page, in one place.

export const TEXT = {
  live: "live",
  reconnecting: "reconnecting",
  lost: "Connection to the gateway lost. What you see is old; trying again …",
  full: "The gateway has no room for this page now; trying again …",
  tokenNeeded: "This gateway shows nothing without a token.",
  tokenRefused: "The gateway does not take this token (any more).",
  enterToken: "Enter token",
  identity: (name, role) => `${name || "gateway token"}, ${role}`,
  roleTooLow: ({ needed, role, got }) => `Not with this token: it takes role ${needed}, yours is ${got || role}.`,
  old: (seconds) => `No new picture for ${seconds} s: what you see is old.`,
  gatewaySilent: "the gateway does not answer",
  frame: ({ seq, width_px: width, height_px: height, lockstep }, rate) =>
    `frame ${seq}, ${width} × ${height}${lockstep ? ", lockstep" : ""}${rate ? `, ${rate.toFixed(1)} per s` : ""}`,
  matched: ({ node_id: node, inliers, raw_matches: raw }) => `${inliers} of ${raw} matches with node ${node} agree`,
  nothingMatched: "no node of the map in sight",
  missionNone: "No mission yet.",
  missionUnheard: "Nothing heard of the planner yet.",
  missionWhat: (title, map) => `${title}, map ${map}`,
  travel: (state, reason) => (state ? `travel: ${state}, as ${reason || "the mission began"}` : ""),
  missionFacts: (s) =>
    `step ${s.step}, ${s.nodes} nodes, ${s.edges} edges, ${s.open_directions} directions open, ` +
    `similarity ${s.similarity}${s.via_points.length ? `, via ${s.via_index + 1} of ${s.via_points.length}` : ""}`,
  verdict: {
    found: "The map knows this place.",
    ambiguous: "Several places of the map look like this.",
    weak: "The map may know this place, but is not sure.",
    not_found: "The map does not know this place.",
  },
  places: (places) => (places.length > 1 ? ` Near node ${places.map((place) => place.nodes[0]).join(", or ")}.` : ""),
  noMap: "There is no map yet: explore first.",
  comparing: "Comparing with the map …",
  noNode: "No node to compare with.",
  noLivePicture: "The robot has sent no picture yet.",
  sameSpot: "same spot",
  here: "here",
  graphFacts: (nodes, edges, revision) => `${nodes} nodes, ${edges} edges, revision ${revision}`,
  graphNone: "not made yet",
  noTruth: "No true positions: this gateway saw none of these nodes made.",
  goal: "goal",
  path: ({ nodes, goal, nearest }) => [
    nodes.length || goal ? `path ${[...nodes, ...(goal ? ["goal"] : [])].join(" → ")}` : "",
    nearest === null ? "" : `robot near node ${nearest}`,
  ].filter(Boolean).join("; "),
  robots: (places) => places.map(([robot, node]) => `${robot} near node ${node}`).join(", "),
  node: (id) => `Node ${id}`,
  nodeFacts: (keypoints, open) => `${keypoints} keypoints, ${open} unexplored directions`,
  view: (id) => `View from node ${id}`,
  edge: (a, b) => `From node ${a} to node ${b}`,
  noEdges: "No edges.",
  nameIt: "Name it",
  namePlace: (nodes) => (nodes.length > 1 ? `Name of these ${nodes.length} nodes` : `Name of node ${nodes[0]}`),
  placeName: "Up to 64 characters; case tells no two apart.",
  noPlaces: "No place has such a name. Choose a node and name it.",
  placeColumns: ["place", "nodes", ""],
  area: (count) => `area of ${count} nodes`,
  emptied: "its nodes are gone",
  forget: "Forget",
  forgetPlace: (name) => `Forget the name ${name}? Its nodes stay; an undo brings it back.`,
  pick: "Pick nodes",
  picked: (count) => `${count} picked: click nodes or drag round them`,
  forbid: "Keep out",
  forbidNodes: (nodes) => `Name of the rule that keeps robots out of ${nodes.length > 1 ? `these ${nodes.length} nodes` : `node ${nodes[0]}`}`,
  ruleColumns: ["rule", "", ""],
  rule: (rule) => {
    const edges = (rule.edges || []).map(([a, b]) => `${a}–${b}`).join(", ");
    if (rule.kind === "keep_out") return `keep out: ${[...rule.areas, ...rule.nodes].join(", ") || "nothing left"}`;
    if (rule.kind === "one_way") return `one way: ${(rule.edges || []).map(([a, b]) => `${a} → ${b}`).join(", ")}`;
    if (rule.kind === "slow") return `slow: ${edges}, ${Math.round(rule.speed_share * 100)} % of the speed`;
    const hours = rule.hours.map((span) => `${span.days.join(" ")} ${span.opens}–${span.closes}`).join("; ");
    return `open ${hours || "never"} (${rule.time_zone}): ${edges}`;
  },
  signColumns: ["sign", "best read at", ""],
  moreSigns: (count) => `${count} more: search for them.`,
  forgetSign: (name) => `Forget the sign ${name}? It is read again where a robot maps anew; an undo brings it back.`,
  routeColumns: ["route", "nodes", ""],
  route: ({ nodes, gaps }) =>
    gaps.length ? `broken between ${gaps.map(([a, b]) => `${a} and ${b}`).join(", ")}: teach it anew` : `${nodes.length} nodes`,
  driveRoute: "Drive",
  driveBack: "Back",
  backwards: "from its end to its beginning",
  removeRoute: (name) => `Remove the route ${name}? Its nodes stay; an undo brings it back.`,
  lift: "Lift",
  liftRule: (name) => `Lift the rule ${name}? Robots go there again from then on.`,
  goThere: "Go there",
  close: "Close",
  suspended: "suspended",
  headings: (there, back) => `direction ${there}, back ${back}`,
  evidence: (m) => `${m.inliers} of ${m.raw_matches} matches agree, trust ${m.confidence.toFixed(2)}`,
  loadingMatches: "Matching the two pictures …",
  unknown: (text) => `There is no node or edge ${text} in this map.`,
  deleteNode: (id) => `Delete node ${id} and its edges? An undo brings it back.`,
  deleteEdge: (a, b) => `Delete the edge between ${a} and ${b}? An undo brings it back.`,
  deleteMap: (name) => `Delete the map ${name} with all its nodes? Nothing brings it back: export it first if in doubt.`,
  undoMap: (name) => `Take back the newest change of ${name}?`,
  renameMap: (name) => `New name of ${name}`,
  mapName: "a to z, 0 to 9, _ and -",
  confirmDelete: "Delete",
  noMaps: "No maps yet.",
  merging: (job) => `${job.state}: ${job.matched} of ${job.nodes} nodes compared. ${job.reason || ""}`,
  merged: (job) => `${job.other} is now part of ${job.map}: ${job.nodes} nodes, ${job.cross_edges} edges between them.`,
  revision: (r) => r.summary || `${r.steps} steps`,
  undoes: (revision) => `takes back ${revision}`,
  compared: (c) =>
    `Between revision ${c.from} and ${c.to}: ${c.nodes_added.length} nodes added, ${c.nodes_removed.length} removed, ` +
    `${c.nodes_changed.length} changed; ${c.edges_added.length} edges added, ${c.edges_removed.length} removed, ` +
    `${c.edges_changed.length} changed` +
    [["places", "named"], ["rules", "set"], ["routes", "kept"]].map(([what, done]) => {
      const [put, gone] = [[...c[`${what}_added`], ...c[`${what}_changed`]], c[`${what}_removed`]];
      return `${put.length ? `; ${what} ${done}: ${put.join(", ")}` : ""}${gone.length ? `; ${what} gone: ${gone.join(", ")}` : ""}`;
    }).join("") + ".",
  nothingDecided: "Nothing decided yet.",
  nothingFits: "No decision fits the filter.",
  noRuns: "Nothing has run yet.",
  chart: { similarity: "similarity S", heading: "heading, degrees left", speed: "speed, m/s" },
  step: (step) => `step ${step}`,
  rename: "Rename",
  export: "Export",
  mapPattern: "[a-z0-9_\\-]{1,64}",
  historyOf: (name) => (name ? `History of ${name}` : "History"),
  mapColumns: ["map", "nodes", "edges", "revision", "changed", ""],
  inspectionColumns: ["inspection", "places", "changes"],
  revisionColumns: ["", "revision", "by", "when", "what"],
  runColumns: ["ended", "run", "map", "outcome", "figures"],
  goalColumns: ["node", "agree", "trust", "direction"],
  edgeColumns: ["to", "direction", "inliers", "trust"],
  evidenceColumns: ["evidence", ""],
  battery: ({ share, charging, voltage_v: volts }) =>
    ["battery", share !== null && `${Math.round(100 * share)} %`, volts !== null && `${volts.toFixed(1)} V`, charging && "charging"]
      .filter(Boolean)
      .join(" "),
  odometry: ({ x_m: x, y_m: y, yaw_rad: yaw }) =>
    `wheels: ${x.toFixed(1)} m ahead, ${y.toFixed(1)} m left, ${Math.round((yaw * 180) / Math.PI)}\u00b0 from where they began`,
  lean: (degrees) => `leaning ${degrees.toFixed(1)}\u00b0`,
  camera: ({ model, problem, rate_hz: rate, delay_s: delay, battery_fraction: share }) =>
    `camera${model ? ` ${model}` : ""}: ` +
    (problem || `${rate.toFixed(1)} Hz, ${Math.round(1000 * delay)} ms late${share === null ? "" : `, ${Math.round(100 * share)} %`}`),
  byHand: (forward, left, turn) =>
    `${forward.toFixed(2)} m/s ahead${left ? `, ${left.toFixed(2)} to the left` : ""}, turning ${turn.toFixed(2)} rad/s`,
  stopWhy: "the stop button of the console",
  stopped: ({ who, why }, since) => `Emergency stop by ${who || "somebody"}${since ? ` at ${since}` : ""}${why ? `: ${why}` : ""}.`,
  release: "Let it go",
  releaseWho: "Who looked and says that the robot may move again?",
  releaseHint: "your name; it is kept with the stop",
  queued: "It waits in the queue: see Tasks.",
  noTasks: "Nothing waits. Describe a mission and queue it.",
  noSchedules: "No schedule. Describe a mission, then say when.",
  queueWhy: (queue) =>
    queue.alarm || (queue.why === null ? (queue.robot === "any" ? "no fleet service: no robot gets any" : "no dispatch service: nothing begins") : queue.why && queue.tasks.length ? `waits: ${queue.why}` : ""),
  task: (task) => {
    const words = Object.values(task.parameters).flat().filter((value) => typeof value !== "object");
    const from = task.schedule ? `, by schedule ${task.schedule}` : task.for_battery ? ", as the battery is low" : "";
    return `${task.kind} in ${task.map}${words.length ? `: ${words.join(", ")}` : ""}${from}`;
  },
  taskOf: ({ robot }) => (robot === "any" ? "" : `, ${robot}`),
  taskColumns: ["task", "state", "priority", ""],
  endedColumns: ["ended", "", "when", "why"],
  priorityOf: (task) => `Priority of ${task.kind} in ${task.map}`,
  cancelIt: "Cancel it",
  cancelTask: (task) => `Cancel ${task.kind} in ${task.map}`,
  cancelRunning: (task) => `Cancel ${task.kind} in ${task.map}, which the robot is carrying out?`,
  scheduleColumns: ["schedule", "task", "next", ""],
  schedule: ({ cron, time_zone: zone, task, skipped }) =>
    `${task.kind} in ${task.map}, ${cron} (${zone})${skipped ? `; skipped ${skipped}` : ""}`,
  off: "off",
  turnOff: "Turn off",
  turnOn: "Turn on",
  remove: "Remove",
  removeSchedule: (name) => `Remove the schedule ${name}? Tasks that it made stay.`,
};
