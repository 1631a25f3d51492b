"""A mission that goes from node to node as it is granted, one every few frames."""

from pydantic import BaseModel, ConfigDict, Field

from services.planner.mission_kinds import MissionContext, MissionKind
from services.planner.ports import Decision, MapAccess, Observation, Progress
from services.planner.travel.whereabouts import Whereabouts
from shared.mapgraph.local.displacement import Displacement


class WalkParameters(BaseModel):
    """The way, and how slowly."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    way: list[int] = Field(min_length=2, max_length=100)
    frames: int = Field(default=1, ge=1, le=1000, description="For each node.")


class Walk:
    """Asks for the right of way with every frame, as travels do."""

    def __init__(self, maps: MapAccess, whereabouts: Whereabouts, parameters: WalkParameters) -> None:
        self._maps, self._whereabouts, self._frames = maps, whereabouts, parameters.frames
        self._way, self._frame = list(parameters.way), 0

    @property
    def progress(self) -> Progress:
        """Where it is."""
        return Progress(nearest_node=self._way[0])

    def decide(self, _observation: Observation) -> Decision:
        """One frame."""
        self._frame += 1
        self._whereabouts.here = Displacement(self._way[0])
        grant = self._maps.right_of_way(self._way[:1], self._way[1:])
        if len(self._way) == 1:
            return Decision("hold", outcome="succeeded")
        if grant.free and self._frame % self._frames == 0:
            del self._way[0]
        return Decision("hold", why=grant.why or "walks")


def _make(context: MissionContext, parameters: WalkParameters) -> Walk:
    assert context.whereabouts is not None
    return Walk(context.maps, context.whereabouts, parameters)


KIND = MissionKind("walk", "Walk", WalkParameters, _make)
