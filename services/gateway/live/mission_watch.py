"""Which missions came to an end, each told once although a planner repeats its status. Pure."""

from datetime import datetime
from typing import Literal, Self

from pydantic import AwareDatetime, BaseModel, ConfigDict

from shared.messages.missions import MissionStatus
from shared.runs import Figure

ENDS = ("succeeded", "failed", "cancelled")
MAX_ID = 64

Key = tuple[str, str]
"""Robot and mission."""


class MissionEntry(BaseModel):
    """One mission that ended.

    Attributes:
        seed: None for a mission that was not started through this gateway.
        started: when the gateway first heard of it; None when all it heard was the end.
        ended: when the gateway heard of the end.
        kind: of mission; it stays readable where no planner knows it any more.
        figures: what a mission of this kind shows; None in entries from before kinds said so.
        outcome: "succeeded", "failed" or "cancelled"; for "failed", `failure` says of what kind.
    """

    model_config = ConfigDict(frozen=True, extra="ignore", allow_inf_nan=False)

    mission_id: str
    robot: str
    kind: str
    map: str
    seed: int | None = None
    started: AwareDatetime | None = None
    ended: AwareDatetime
    steps: int
    nodes: int = 0
    edges: int = 0
    open_directions: int = 0
    similarity: int = 0
    figures: dict[str, Figure] | None = None
    outcome: Literal["succeeded", "failed", "cancelled"]
    failure: str = ""
    reason: str = ""

    @property
    def key(self) -> Key:
        """What it is known by."""
        return self.robot, self.mission_id

    @classmethod
    def of(cls, status: MissionStatus, seed: int | None, started: datetime | None, ended: datetime) -> Self:
        """The entry of a mission whose last status this is."""
        return cls.model_validate(
            {
                **status.model_dump(include=set(cls.model_fields) - {"figures"}),
                "figures": {one.name: one.value for one in status.figures if one.value is not None} or None,
                "kind": status.action,
                "steps": status.step,
                "outcome": status.state,
                "seed": seed,
                "started": started,
                "ended": ended,
            }
        )


class MissionWatch:
    """Follows the missions of all robots."""

    def __init__(self) -> None:
        self._ended: set[Key] = set()
        self._begun: dict[str, tuple[str, datetime]] = {}
        self._seeds: dict[str, tuple[str, int]] = {}
        self._heard: set[str] = set()

    def know(self, keys: set[Key]) -> None:
        """These ended before: they are on record, and older ones may be forgotten."""
        self._ended = keys

    def ordered(self, robot: str, mission_id: str, seed: int) -> None:
        """A mission was started here; statuses do not tell its seed."""
        self._seeds[robot] = (mission_id, seed)

    def take(self, status: MissionStatus, now: datetime) -> MissionEntry | None:
        """Read one status; returns the mission if this is news of its end."""
        robot, mission_id = status.robot, status.mission_id
        first = robot not in self._heard
        self._heard.add(robot)
        if not status.action or not 0 < len(mission_id) <= MAX_ID:
            return None
        begun = self._begun.get(robot, ("", now))
        if status.state not in ENDS:
            self._begun[robot] = begun if begun[0] == mission_id else (mission_id, now)
            return None
        # After a refused start a planner names the new mission beside the state of the one before: an end
        # counts where the mission was seen under way, or where the gateway may have missed that.
        seen = begun[0] == mission_id
        if (robot, mission_id) in self._ended or not (seen or first):
            return None
        self._ended.add((robot, mission_id))
        name, seed = self._seeds.get(robot, ("", 0))
        return MissionEntry.of(
            status, seed if name == mission_id else None, begun[1] if seen else None, ended=now
        )
