"""What a mission adds to travel: where it leads, when it is reached, and what is made of setbacks."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from services.planner.ports import Matcher, Matches, Note
from services.planner.travel.states import Event
from services.planner.travel.tracking import Tracker
from shared.mapgraph.graph import EdgeKey
from shared.mapgraph.local.displacement import Displacement
from shared.messages.features import Features
from shared.messages.matching import NodeMatch
from shared.messages.missions import FailureKind
from shared.messages.sensors import Ranges


@dataclass(frozen=True)
class Setback:
    """A path that ended before its end.

    Attributes:
        event: what ended it.
        edge: the edge driven, which may end at the GOAL; None before the first waypoint.
        waypoint: what was aimed at.
        path: the whole path.
        why: for people.
        here: where the robot is, as far as it is known.
    """

    event: Event
    edge: EdgeKey | None
    waypoint: int
    path: tuple[int, ...]
    why: str
    here: Displacement | None = None


@dataclass(frozen=True)
class Verdict:
    """What a destination makes of a setback or of having no path.

    Attributes:
        notes: what it changed.
        failure: why the travel is given up; "" to go on.
        why: for people, where there is no setback that says it.
    """

    notes: tuple[Note, ...] = ()
    failure: FailureKind = ""
    why: str = ""


class Destination(Protocol):
    """Where a travel leads.

    Attributes:
        picture: the goal picture's features; None where the path ends at a node.
        arrival_rad: disparity at which the end is reached.
        aliased: the picture resembles a wrong spot too: it counts only from the last waypoint on.
        cuts_corners: whether a later waypoint in sight may be headed for before the present one is reached.
        compared: nodes of the map compared with a frame to localise.
        search_steps: frames without anything known after which the travel is given up.
    """

    picture: Features | None
    arrival_rad: float
    aliased: bool
    cuts_corners: bool
    compared: int
    search_steps: int

    def targets(self) -> Mapping[int, float]:
        """Nodes the path may end at, with the cost of the way beyond; without any the travel is given up."""

    def beyond(self, end: int) -> Sequence[int]:
        """Nodes to follow from the end of a path that was planned, in order; none: the path ends there."""

    def starts(self, visible: Mapping[int, float]) -> Mapping[int, float]:
        """Of the nodes in sight, with the cost of the way there, those to start from."""

    def localised(self, seen: Matches, ranges: Ranges) -> tuple[Note, ...]:
        """Learn from a frame that was compared with the whole map."""

    def mistaken(self) -> tuple[Note, ...]:
        """The robot was not where it believed to be: what it learnt of places and edges was of others."""

    def goes_straight(self) -> bool:
        """Whether the picture, which is in sight where it can be, may be headed for without a path."""

    def sees(self, goal: NodeMatch, here: Displacement | None) -> bool:
        """A frame was compared with the picture: whether it can be that, where the robot is.

        Args:
            goal: the frame against the picture.
            here: where the robot is; None where nobody knows.
        """

    def lies(self, node_id: int) -> Displacement | None:
        """Where the picture was taken, relative to a node that it resembles; None where that is not known."""

    def set_out(self) -> None:
        """A path was found."""

    def no_path(self) -> Verdict:
        """Nodes are in sight, no path leads on."""

    def setback(self, setback: Setback) -> Verdict:
        """A path ended early."""

    def unreachable(self) -> tuple[FailureKind, str]:
        """Why there is nowhere to go, once there are no targets."""

    def refutes_arrival(self, end: int, similarity: int, tracker: Tracker) -> str:
        """Why the end of the path is not the destination after all; "" confirms it.

        Args:
            end: node at which the path ends, or GOAL.
            similarity: of the view and the end.
            tracker: where the robot is.
        """


class NodeDestination:
    """What destinations without a picture have in common: a path ends at a node.

    Attributes:
        compared: nodes compared to localise a frame.
    """

    picture: Features | None = None
    aliased = False
    compared: int

    def __init__(self, matcher: Matcher) -> None:
        self._matcher = matcher

    def goes_straight(self) -> bool:
        """There is no picture to head for."""
        return False

    def localised(self, _seen: Matches, _ranges: Ranges) -> tuple[Note, ...]:
        """Nothing is learnt: edges are judged by standing at nodes and by driving."""
        return ()

    def mistaken(self) -> tuple[Note, ...]:
        """Who goes to nodes is sure of where it is, or lost."""
        return ()

    def sees(self, _goal: NodeMatch, _here: Displacement | None) -> bool:
        """There is no picture."""
        return False

    def lies(self, _node_id: int) -> Displacement | None:
        """There is no picture."""
        return None

    def refutes_arrival(self, end: int, similarity: int, tracker: Tracker) -> str:  # noqa: ARG002
        """Whether the view belongs to another part of the map."""
        matches = self._matcher.match([end, *tracker.nearby()], self.compared)
        possible = end in tracker.possible(matches)
        return "" if possible else f"aliased: other nodes resemble this view more than node {end}"
