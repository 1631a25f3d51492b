// Lays out large maps beside the page, which meanwhile goes on.

import { place } from "./layout.js";

addEventListener("message", ({ data }) => postMessage(place(data.nodes, data.edges, data.before)));
