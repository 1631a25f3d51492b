"""The states of travel and every transition between them, each with its reason.

`deploy/TRAVEL.md` shows this table; a test compares them.
"""

from enum import StrEnum
from typing import NamedTuple


class State(StrEnum):
    """What the robot is doing on its way."""

    LOCALISING = "localising"
    WAITING = "waiting"
    SEARCHING = "searching"
    FOLLOWING = "following"
    ARRIVED = "arrived"
    FAILED = "failed"


MEANING = {
    State.LOCALISING: "the frame is compared with the whole map, and a path is planned",
    State.WAITING: "nodes are in sight, but no path leads on from them; the next frame may show one",
    State.SEARCHING: "no node of the map is recognised: back first, then in sweeps that grow",
    State.FOLLOWING: "from waypoint to waypoint along a path",
    State.ARRIVED: "at the end of the path, and the view confirms it",
    State.FAILED: "given up; the failure says why",
}


class Event(StrEnum):
    """What makes the state change."""

    PATH_FOUND = "path_found"
    GOAL_IN_SIGHT = "goal_in_sight"
    NO_PATH = "no_path"
    NOTHING_KNOWN = "nothing_known"
    WAYPOINT_LOST = "waypoint_lost"
    NO_PROGRESS = "no_progress"
    WAY_UNCLEAR = "way_unclear"
    ALIASED = "aliased"
    MISTAKEN = "mistaken"
    REACHED = "reached"
    RULED_OUT = "ruled_out"
    MAKES_ROOM = "makes_room"
    MADE_ROOM = "made_room"
    SET_OUT = "set_out"
    GIVEN_UP = "given_up"


class Transition(NamedTuple):
    """One row of the table."""

    before: State
    event: Event
    after: State
    reason: str


_SEEKING = (State.LOCALISING, State.WAITING, State.SEARCHING)
_REASONS = {
    Event.PATH_FOUND: "a path leads from a node in sight to the destination",
    Event.GOAL_IN_SIGHT: "the goal picture itself is recognised over free ground",
    Event.NO_PATH: "nodes are in sight, but every path from them is closed",
    Event.NOTHING_KNOWN: "no node of the map is recognised",
    Event.WAYPOINT_LOST: "the waypoint was not seen for several frames in a row",
    Event.NO_PROGRESS: "the waypoint comes no nearer, or what comes after it does not show",
    Event.WAY_UNCLEAR: "no free ground is seen beyond the waypoint: another path is asked for, once",
    Event.ALIASED: "the view resembles the destination, but other nodes resemble it more",
    Event.MISTAKEN: "several views show other places than that where the robot believed to be",
    Event.REACHED: "the view agrees with that of the destination",
    Event.RULED_OUT: "a rule of the map is against going on along the path",
    Event.MAKES_ROOM: "other robots cannot get by: it goes out of their way first",
    Event.MADE_ROOM: "it is out of the way of others, and goes on from there",
    Event.SET_OUT: "a new destination is asked for",
    Event.GIVEN_UP: "no try is left",
}


def _rows() -> list[Transition]:
    seeking = (
        (Event.PATH_FOUND, State.FOLLOWING),
        (Event.GOAL_IN_SIGHT, State.FOLLOWING),
        (Event.NO_PATH, State.WAITING),
        (Event.NOTHING_KNOWN, State.SEARCHING),
        (Event.GIVEN_UP, State.FAILED),
    )
    following = (
        (Event.WAYPOINT_LOST, State.LOCALISING),
        (Event.NO_PROGRESS, State.LOCALISING),
        (Event.WAY_UNCLEAR, State.LOCALISING),
        (Event.ALIASED, State.LOCALISING),
        (Event.MISTAKEN, State.LOCALISING),
        (Event.RULED_OUT, State.LOCALISING),
        (Event.MAKES_ROOM, State.FOLLOWING),
        (Event.MADE_ROOM, State.LOCALISING),
        (Event.REACHED, State.ARRIVED),
    )
    rows = [(before, event, after) for before in _SEEKING for event, after in seeking]
    rows += [(State.FOLLOWING, event, after) for event, after in following]
    rows += [(before, Event.SET_OUT, State.LOCALISING) for before in (State.LOCALISING, State.ARRIVED)]
    return [Transition(*row, _REASONS[row[1]]) for row in rows]


TRANSITIONS = {(row.before, row.event): row for row in _rows()}
