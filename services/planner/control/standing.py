"""How the mission stands, and how everyone is told."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from services.planner.ports import Progress
from shared.mapgraph.frontiers import open_directions
from shared.mapgraph.graph import MapGraph
from shared.messages.maps import MissionRecord
from shared.messages.missions import EventValue, FailureKind, MissionState, MissionStatus, PausedBy

Figure = float | int | str | bool | None


@dataclass
class Standing:
    """How the mission stands.

    Attributes:
        reason: the newest decision with its reason, or what changed the state.
        paused_by: who paused it; of a mission that is not paused without meaning.
        step: frames that it decided for.
    """

    state: MissionState = "idle"
    failure: FailureKind = ""
    reason: str = ""
    paused_by: PausedBy = ""
    step: int = 0

    @property
    def under_way(self) -> bool:
        """Whether it has not ended."""
        return self.state in ("running", "paused")

    @property
    def waits_for_stop(self) -> bool:
        """Whether the emergency stop paused it."""
        return self.state == "paused" and self.paused_by == "emergency_stop"


def status_of(
    record: MissionRecord, now: Standing, progress: Progress, graph: MapGraph, shown: Iterable[str]
) -> MissionStatus:
    """What is published after every step; `shown` are the figures that records of its kind have."""
    facts = {
        "nodes": len(graph.nodes),
        "edges": len(graph.edges),
        "open_directions": open_directions(graph),
        "similarity": progress.similarity,
        "disparity_rad": progress.disparity_rad,
    }
    return MissionStatus(
        robot=record.robot,
        mission_id=record.mission_id,
        action=record.action,
        map=record.map,
        state=now.state,
        failure=now.failure,
        reason=now.reason[:400],
        step=now.step,
        via_points=progress.via_points,
        via_index=progress.via_index,
        nearest_node=progress.nearest_node,
        epoch=record.epoch,
        paused_by=now.paused_by if now.state == "paused" else "",
        travel=progress.travel,
        travel_reason=progress.travel_reason,
        figures=_figures({**facts, **progress.figures}, shown),
        **facts,
    )


def _figures(values: Mapping[str, Figure], shown: Iterable[str]) -> tuple[EventValue, ...]:
    return tuple(EventValue(name=name, value=values[name]) for name in shown if name in values)
