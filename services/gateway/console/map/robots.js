// Robots in the map that is shown, each beside the node that it is nearest to; a click follows one.

import { $ } from "../page/dom.js";
import { TEXT } from "../page/text.js";

const ASIDE_PX = 24;

export class Robots {
  /** `follow(name)` hears which robot somebody clicked. */
  constructor(graph, follow) {
    this.graph = graph;
    this.entries = [];
    graph.cy.on("tap", "node.robot", (event) => follow(event.target.data("robot")));
    graph.onMarks.push(() => this.paint());
  }

  /** What `/api/robots` says of all of them, and whom the page follows. */
  take(entries, followed) {
    this.entries = entries;
    this.followed = followed;
    this.paint();
  }

  paint() {
    const { cy, map } = this.graph;
    const here = this.entries.filter(({ mission }) => mission?.map === map && Number.isInteger(mission.nearest_node)
      && cy.getElementById(`n${mission.nearest_node}`).length);
    const shown = this.entries.length > 1 ? here : []; // of one alone its nearest node is marked
    cy.batch(() => {
      cy.elements("node.robot").remove();
      const beside = new Map();
      for (const { robot, mission } of shown) {
        const { x, y } = cy.getElementById(`n${mission.nearest_node}`).position();
        const others = beside.get(mission.nearest_node) || 0;
        beside.set(mission.nearest_node, others + 1);
        const classes = robot === this.followed ? "robot followed" : "robot";
        const position = { x: x + ASIDE_PX * others, y: y - ASIDE_PX };
        cy.add({ group: "nodes", data: { id: `robot-${robot}`, robot, label: robot }, classes, position });
      }
    });
    $("graph").dataset.robots = shown.length;
    const text = TEXT.robots(shown.map(({ robot, mission }) => [robot, mission.nearest_node]));
    if ($("robots-text").textContent !== text) $("robots-text").textContent = text;
  }
}
