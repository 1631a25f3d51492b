"""The graph as a figure, for notebooks and files; positions come from the graph alone."""

from collections.abc import Sequence
from itertools import pairwise

import networkx as nx
from matplotlib.figure import Figure

from services.launcher.drawing.plans import EDGE, NODE, START, TARGET, VIA
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.routing import GOAL


def graph_figure(graph: MapGraph, path: Sequence[int] = (), start: int | None = None) -> Figure:
    """Nodes and edges, the path in the thesis's colours; suspended edges are dashed."""
    drawn: nx.Graph[int] = nx.Graph()
    drawn.add_nodes_from(graph.nodes)
    drawn.add_edges_from(graph.edges)
    if path and path[-1] == GOAL and len(path) > 1:
        drawn.add_edge(path[-2], GOAL)
    places = nx.spring_layout(drawn, seed=1) if len(drawn) else {}
    figure = Figure(figsize=(7.0, 6.0), layout="constrained")
    axes = figure.subplots()
    solid = [ends for ends, edge in graph.edges.items() if not edge.suspended]
    dashed = [ends for ends, edge in graph.edges.items() if edge.suspended]
    colours = [_colour(node, path, start) for node in drawn]
    nx.draw_networkx_nodes(drawn, places, ax=axes, node_color=colours, node_size=110)
    nx.draw_networkx_edges(drawn, places, edgelist=solid, ax=axes, edge_color=EDGE)
    nx.draw_networkx_edges(drawn, places, edgelist=dashed, ax=axes, edge_color=EDGE, style="dashed")
    steps = list(pairwise(path))
    nx.draw_networkx_edges(drawn, places, edgelist=steps, ax=axes, edge_color=VIA, width=2.5)
    labels = {node: "goal" if node == GOAL else str(node) for node in drawn}
    nx.draw_networkx_labels(drawn, places, labels, ax=axes, font_size=6, font_color="white")
    axes.set_axis_off()
    return figure


def _colour(node: int, path: Sequence[int], start: int | None) -> str:
    if node == start:
        return START
    if path and node == path[-1]:
        return TARGET
    return VIA if node in path else NODE
