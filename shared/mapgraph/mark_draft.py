"""Places and rules being changed in place, as part of a `Draft`. Pure."""

from collections.abc import Callable, Container
from typing import Literal, NamedTuple

from shared.mapgraph.marks import MENTIONS_MAX, nodes_of, nothing_called, only_nodes, users_of
from shared.messages.maps import MarkOperation
from shared.messages.places import DeletePlace, DeleteRule, KeepOut, Place, PutPlace, PutRule, Rule, key_of

MARKS_MAX = 1_000
"""Places of a map, and rules; chosen: more than a person can tell apart."""


class GraphError(ValueError):
    """An operation that does not fit the graph; it changed nothing."""


class UnknownError(GraphError):
    """It names a node, an edge, a place or a rule that is not there."""


class TakenError(GraphError):
    """It adds a node whose number another one has."""


class InUseError(GraphError):
    """It takes away what something else is about."""


class FullError(GraphError):
    """The graph would be larger than one message about it may be."""


class MarkWrite(NamedTuple):
    """A place or a rule before and after; None where there is none."""

    key: str
    before: Place | Rule | None
    after: Place | Rule | None

    @property
    def kind(self) -> Literal["place", "rule"]:
        """Which of the two."""
        return "place" if isinstance(self.before or self.after, Place) else "rule"


class MarkDraft:
    """Places and rules, by the keys of their names.

    Args:
        places, rules: changed in place.
        nodes: numbers of the nodes there are.
        wrote: is told every write.
    """

    def __init__(
        self,
        places: dict[str, Place],
        rules: dict[str, Rule],
        nodes: Container[int],
        wrote: Callable[[MarkWrite], None],
    ) -> None:
        self.places, self.rules = places, rules
        self._nodes, self._wrote = nodes, wrote

    def apply(self, operation: MarkOperation) -> None:
        """Do it. Raises UnknownError, InUseError, FullError."""
        match operation:
            case PutPlace(place=place):
                self._check(place)
                self._write(MarkWrite(key_of(place.name), self.places.get(key_of(place.name)), place))
            case PutRule(rule=rule):
                self._check(rule)
                self._write(MarkWrite(key_of(rule.name), self.rules.get(key_of(rule.name)), rule))
            case DeletePlace(name=name):
                self._delete_place(name)
            case DeleteRule(name=name):
                if key_of(name) not in self.rules:
                    raise UnknownError(nothing_called(name, list(self.rules.values()), "rule"))
                self._write(MarkWrite(key_of(name), self.rules[key_of(name)], None))

    def forget_node(self, node_id: int) -> None:
        """A node goes: no place and no rule lists it any longer."""
        for mark in [*self.places.values(), *self.rules.values()]:
            if node_id in nodes_of(mark):
                left = only_nodes(mark, nodes_of(mark) - {node_id})
                self._write(MarkWrite(key_of(mark.name), mark, left))

    def _delete_place(self, name: str) -> None:
        key = key_of(name)
        if key not in self.places:
            raise UnknownError(nothing_called(name, list(self.places.values())))
        if users := users_of(key, self.rules.values()):
            raise InUseError(f"place {name!r} is what rule {users[0]!r} is about; lift that first")
        self._write(MarkWrite(key, self.places[key], None))

    def _check(self, mark: Place | Rule) -> None:
        """Whether all that it is about is there, and there is room for it."""
        for node_id in sorted(nodes_of(mark)):
            if node_id not in self._nodes:
                raise UnknownError(f"{mark.name!r}: node {node_id} does not exist")
        if isinstance(mark, KeepOut):
            for area in mark.areas:
                if key_of(area) not in self.places:
                    raise UnknownError(f"{mark.name!r}: {nothing_called(area, list(self.places.values()))}")
        same: dict[str, Place] | dict[str, Rule] = self.places if isinstance(mark, Place) else self.rules
        if key_of(mark.name) not in same and len(same) >= MARKS_MAX:
            raise FullError(f"a map holds at most {MARKS_MAX} places and as many rules; delete some first")
        others = [
            m for m in (*self.places.values(), *self.rules.values()) if m is not same.get(key_of(mark.name))
        ]
        if sum(len(nodes_of(other)) for other in (*others, mark)) > MENTIONS_MAX:
            raise FullError(f"places and rules of a map list at most {MENTIONS_MAX} nodes; list fewer")

    def _write(self, write: MarkWrite) -> None:
        kept: dict[str, Place | Rule] = self.places if write.kind == "place" else self.rules  # type: ignore[assignment]
        if write.after is None:
            del kept[write.key]
        else:
            kept[write.key] = write.after
        self._wrote(write)
