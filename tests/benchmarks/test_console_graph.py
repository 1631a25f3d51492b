"""Frame rates of the map's drawing while it is dragged; says figures, gates nothing.

pytest -q -s tests/benchmarks/test_console_graph.py
"""

import threading
from collections.abc import Callable, Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

import numpy as np
import pytest

from services.gateway.app import CONSOLE
from tests.browser import chromium, needs_chromium

pytestmark = [pytest.mark.slow, pytest.mark.timeout(300), needs_chromium]

DRAG_MOVES = 150
DRAW = """async ({ nodes, edges }) => {
    const { place } = await import("/map/layout.js");
    const { look } = await import("/map/graph_style.js");
    const { default: cytoscape } = await import("/vendor/cytoscape.esm.min.js");
    const before = performance.now();
    const spots = place(nodes, edges);
    const laid_out_ms = performance.now() - before;
    document.body.innerHTML = "";
    const box = document.body.appendChild(document.createElement("div"));
    Object.assign(box.style, { width: "1200px", height: "800px" });
    const cy = cytoscape({
        container: box, style: look(), textureOnViewport: true, pixelRatio: 1,
        hideEdgesOnViewport: nodes.length > 1500,
        elements: [
            ...nodes.map(({ node_id: id }) => ({ data: { id: `n${id}`, label: `${id}` },
                position: { x: 70 * spots.get(id).x, y: -70 * spots.get(id).y } })),
            ...edges.map(({ a, b }) => ({ data: { id: `e${a}-${b}`, source: `n${a}`, target: `n${b}` } })),
        ],
        layout: { name: "preset" },
    });
    if (nodes.length > 1500) cy.elements().addClass("many");
    cy.fit();
    await new Promise((resolve) => setTimeout(resolve, 1500));
    window.frames_drawn = 0;
    window.count_from = performance.now();
    const count = () => { window.frames_drawn += 1; requestAnimationFrame(count); };
    requestAnimationFrame(count);
    return laid_out_ms;
}"""


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    """The page's files, without a gateway."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(SimpleHTTPRequestHandler, directory=str(CONSOLE)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_address[1]}"
    server.shutdown()
    server.server_close()


@pytest.mark.parametrize(("count", "edges_per_node"), [(1_000, 3), (10_000, 3)])
def test_frames_per_second(
    address: str, count: int, edges_per_node: int, keep: Callable[[dict[str, Any]], None]
) -> None:
    graph = streets(count, edges_per_node, np.random.default_rng(1))
    with chromium() as browser:
        page = browser.new_page(viewport={"width": 1300, "height": 900})
        page.goto(f"{address}/style.css")
        page.goto(f"{address}/index.html")
        laid_out_ms = page.evaluate(DRAW, graph)
        page.mouse.move(20, 20)
        page.mouse.down()
        for step in range(DRAG_MOVES):
            page.mouse.move(20 + 5 * (step % 60), 20 + 3 * (step % 60))
        page.mouse.up()
        rate = page.evaluate("1000 * window.frames_drawn / (performance.now() - window.count_from)")
    size = {"places": count, "connections": len(graph["edges"])}
    keep({**size, "laid_out_ms": laid_out_ms, "frames_per_s_while_dragged": rate})
    assert rate > 0


def streets(count: int, edges_per_node: int, rng: np.random.Generator) -> dict[str, list[dict[str, float]]]:
    """A town: places along a grid of streets, each joined with the next ones."""
    side = round(count**0.5)
    points = np.array([[n % side, n // side] for n in range(count)]) + rng.normal(0, 0.15, (count, 2))
    edges = []
    for a in range(count):
        for b in [a + 1, a + side, a + side + 1, a + 2][:edges_per_node]:
            if b < count and np.hypot(*(points[b] - points[a])) < 3:
                heading = float(np.arctan2(*(points[b] - points[a])[::-1]))
                back = float(np.arctan2(*(points[a] - points[b])[::-1]))
                edges.append(
                    {"a": a, "b": b, "heading_ab_rad": heading, "heading_ba_rad": back, "yaw_ab_rad": 0.0}
                )
    return {"nodes": [{"node_id": n} for n in range(count)], "edges": edges}
