"""Places, rules, routes and signs being changed in place, as part of a `Draft`. Pure."""

from collections.abc import Callable, Container
from typing import Literal, NamedTuple, TypeVar

from shared.mapgraph.marks import MENTIONS_MAX, mentions, nodes_of, nothing_called, only_nodes, users_of
from shared.messages.maps import MarkOperation
from shared.messages.places import (
    DeletePlace,
    DeleteRoute,
    DeleteRule,
    DeleteSign,
    KeepOut,
    Place,
    PutPlace,
    PutRoute,
    PutRule,
    PutSign,
    Route,
    Rule,
    Sign,
    key_of,
)

M = TypeVar("M", Place, Rule, Route, Sign)
AnyMark = Place | Rule | Route | Sign
MarkKind = Literal["place", "rule", "route", "sign"]

MARKS_MAX = 1_000
"""Places of a map, rules, routes, and signs; chosen: more than a person can tell apart."""


class GraphError(ValueError):
    """An operation that does not fit the graph; it changed nothing."""


class UnknownError(GraphError):
    """It names a node, an edge or a mark that is not there."""


class TakenError(GraphError):
    """It adds a node whose number another one has."""


class InUseError(GraphError):
    """It takes away what something else is about."""


class FullError(GraphError):
    """The graph would be larger than one message about it may be."""


class MarkWrite(NamedTuple):
    """A mark before and after; None where there is none."""

    key: str
    before: AnyMark | None
    after: AnyMark | None

    @property
    def kind(self) -> MarkKind:
        """Which of the four."""
        return kind_of(self.before or self.after)


def kind_of(mark: AnyMark | None) -> MarkKind:
    """Which of the four a mark is."""
    if isinstance(mark, Place):
        return "place"
    if isinstance(mark, Sign):
        return "sign"
    return "route" if isinstance(mark, Route) else "rule"


class MarkDraft:
    """Places, rules, routes and signs, by the keys of their names.

    Args:
        places, rules, routes, signs: changed in place.
        nodes: numbers of the nodes there are.
        wrote: is told every write.
    """

    def __init__(
        self,
        places: dict[str, Place],
        rules: dict[str, Rule],
        routes: dict[str, Route],
        signs: dict[str, Sign],
        nodes: Container[int],
        wrote: Callable[[MarkWrite], None],
    ) -> None:
        self.places, self.rules, self.routes, self.signs = places, rules, routes, signs
        self._nodes, self._wrote = nodes, wrote

    def apply(self, operation: MarkOperation) -> None:
        """Do it. Raises UnknownError, InUseError, FullError."""
        match operation:
            case PutPlace(place=place):
                self._put(place)
            case PutRule(rule=rule):
                self._put(rule)
            case PutRoute(route=route):
                self._put(route)
            case PutSign(sign=sign):
                self._put(sign)
            case DeletePlace(name=name):
                self._delete_place(name)
            case DeleteRule(name=name):
                self._delete(name, self.rules, "rule")
            case DeleteRoute(name=name):
                self._delete(name, self.routes, "route")
            case DeleteSign(name=name):
                self._delete(name, self.signs, "sign")

    def forget_node(self, node_id: int) -> None:
        """A node goes: no mark lists it any longer."""
        for mark in self._all():
            if node_id in nodes_of(mark):
                left = only_nodes(mark, nodes_of(mark) - {node_id})
                self._write(MarkWrite(key_of(mark.name), mark, left))

    def _put(self, mark: AnyMark) -> None:
        self._check(mark)
        key = key_of(mark.name)
        self._write(MarkWrite(key, self._kept(kind_of(mark)).get(key), mark))

    def _delete_place(self, name: str) -> None:
        key = key_of(name)
        if key not in self.places:
            raise UnknownError(nothing_called(name, list(self.places.values())))
        if users := users_of(key, self.rules.values()):
            raise InUseError(f"place {name!r} is what rule {users[0]!r} is about; lift that first")
        self._write(MarkWrite(key, self.places[key], None))

    def _delete(self, name: str, kept: dict[str, M], what: str) -> None:
        if key_of(name) not in kept:
            raise UnknownError(nothing_called(name, list(kept.values()), what))
        self._write(MarkWrite(key_of(name), kept[key_of(name)], None))

    def _all(self) -> list[AnyMark]:
        return [*self.places.values(), *self.rules.values(), *self.routes.values(), *self.signs.values()]

    def _check(self, mark: AnyMark) -> None:
        """Whether all that it is about is there, and there is room for it."""
        for node_id in sorted(nodes_of(mark)):
            if node_id not in self._nodes:
                raise UnknownError(f"{mark.name!r}: node {node_id} does not exist")
        if isinstance(mark, KeepOut):
            for area in mark.areas:
                if key_of(area) not in self.places:
                    raise UnknownError(f"{mark.name!r}: {nothing_called(area, list(self.places.values()))}")
        same = self._kept(kind_of(mark))
        if key_of(mark.name) not in same and len(same) >= MARKS_MAX:
            raise FullError(
                f"a map holds at most {MARKS_MAX} places, as many rules, routes and signs; delete some first"
            )
        others = [other for other in self._all() if other is not same.get(key_of(mark.name))]
        if sum(mentions(other) for other in (*others, mark)) > MENTIONS_MAX:
            raise FullError(
                f"places, rules, routes and signs of a map list at most {MENTIONS_MAX} nodes; list fewer"
            )

    def _kept(self, kind: MarkKind) -> dict[str, AnyMark]:
        kept: dict[str, object] = {
            "place": self.places,
            "rule": self.rules,
            "route": self.routes,
            "sign": self.signs,
        }
        return kept[kind]  # type: ignore[return-value]

    def _write(self, write: MarkWrite) -> None:
        kept = self._kept(write.kind)
        if write.after is None:
            del kept[write.key]
        else:
            kept[write.key] = write.after
        self._wrote(write)
