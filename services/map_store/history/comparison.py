"""Two revisions of a map beside one another: older graphs rebuilt from newer ones, and what differs. Pure."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import TypeVar

from services.map_store.errors import ConflictError, CorruptError, InvalidError, MissingError
from services.map_store.storage.graph import Graph, Step, apply
from shared.mapgraph.operations import EdgeKey
from shared.messages.maps import Edge
from shared.messages.places import Mark

K = TypeVar("K", int, str, EdgeKey)
V = TypeVar("V")
M = TypeVar("M", bound=Mark)
Value = bool | int | float | str | None
"""What a field of an edge holds."""


@dataclass(frozen=True)
class EdgeChange:
    """An edge that both revisions have; `before` and `after` hold the fields that differ, by name."""

    a: int
    b: int
    before: Mapping[str, Value]
    after: Mapping[str, Value]


@dataclass(frozen=True)
class Comparison:
    """What leads from one graph to the other, everything in ascending order.

    Attributes:
        nodes_changed: nodes of both with another record, other features or another thumbnail.
        edges_changed: edges of both with another record.
        places_added, rules_added and so on: likewise, by name.
    """

    nodes_added: tuple[int, ...]
    nodes_removed: tuple[int, ...]
    nodes_changed: tuple[int, ...]
    edges_added: tuple[EdgeKey, ...]
    edges_removed: tuple[EdgeKey, ...]
    edges_changed: tuple[EdgeChange, ...]
    places_added: tuple[str, ...] = ()
    places_removed: tuple[str, ...] = ()
    places_changed: tuple[str, ...] = ()
    rules_added: tuple[str, ...] = ()
    rules_removed: tuple[str, ...] = ()
    rules_changed: tuple[str, ...] = ()
    routes_added: tuple[str, ...] = ()
    routes_removed: tuple[str, ...] = ()
    routes_changed: tuple[str, ...] = ()
    signs_added: tuple[str, ...] = ()
    signs_removed: tuple[str, ...] = ()
    signs_changed: tuple[str, ...] = ()


def rewind(graph: Graph, inverses: Iterable[Iterable[Step]]) -> Graph:
    """The graph before some revisions.

    Args:
        graph: after the newest of them.
        inverses: the steps that lead back over each revision, newest revision first.

    Raises:
        CorruptError: they do not belong to `graph`.
    """
    try:
        return apply(graph, chain.from_iterable(inverses)).graph
    except (MissingError, ConflictError, InvalidError) as error:
        raise CorruptError(f"the history does not fit the graph: {error}") from error


def compare(before: Graph, after: Graph) -> Comparison:
    """What is in `after` and not in `before`, what is gone, and what both have in different forms."""
    nodes_added, nodes_removed, nodes_changed = _differences(before.nodes, after.nodes)
    edges_added, edges_removed, edges_changed = _differences(before.edges, after.edges)
    return Comparison(
        nodes_added=nodes_added,
        nodes_removed=nodes_removed,
        nodes_changed=nodes_changed,
        edges_added=edges_added,
        edges_removed=edges_removed,
        edges_changed=tuple(_edge_change(before.edges[key], after.edges[key]) for key in edges_changed),
        **_mark_changes("places", before.places, after.places),
        **_mark_changes("rules", before.rules, after.rules),
        **_mark_changes("routes", before.routes, after.routes),
        **_mark_changes("signs", before.signs, after.signs),
    )


def _mark_changes(what: str, before: Mapping[str, M], after: Mapping[str, M]) -> dict[str, tuple[str, ...]]:
    changes = zip(("added", "removed", "changed"), _differences(before, after), strict=True)
    named = {**before, **after}
    return {f"{what}_{how}": tuple(named[key].name for key in keys) for how, keys in changes}


def _differences(
    before: Mapping[K, V], after: Mapping[K, V]
) -> tuple[tuple[K, ...], tuple[K, ...], tuple[K, ...]]:
    """Keys added, removed and changed."""
    both = before.keys() & after.keys()
    # Most values are the very same object in both: rewinding replaces only what a step touched.
    changed = (key for key in both if before[key] is not after[key] and before[key] != after[key])
    return tuple(sorted(after.keys() - both)), tuple(sorted(before.keys() - both)), tuple(sorted(changed))


def _edge_change(before: Edge, after: Edge) -> EdgeChange:
    old, new = before.model_dump(), after.model_dump()
    fields = [name for name in old if old[name] != new[name]]
    return EdgeChange(
        a=before.a,
        b=before.b,
        before={name: old[name] for name in fields},
        after={name: new[name] for name in fields},
    )
