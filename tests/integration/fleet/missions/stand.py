"""A mission that is at its node at once and stays there; it notes in a file when it begins."""

from pathlib import Path

from pydantic import BaseModel, ConfigDict, Field

from services.planner.mission_kinds import MissionContext, MissionKind
from services.planner.ports import Decision, Observation, Progress
from shared.mapgraph.local.displacement import Displacement


class StandParameters(BaseModel):
    """Where, for how long, and where to note it."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    goal_node: int = Field(ge=0)
    frames: int = Field(default=2, ge=1, le=10_000)
    file: str = ""
    name: str = ""


class Stand:
    """Holds still."""

    def __init__(self, parameters: StandParameters) -> None:
        self._parameters, self._stood = parameters, 0
        self.progress = Progress(nearest_node=parameters.goal_node)

    def decide(self, _observation: Observation) -> Decision:
        """Stand for one frame."""
        if self._stood == 0 and self._parameters.file:
            with Path(self._parameters.file).open("a", encoding="utf-8") as file:
                file.write(f"{self._parameters.name}\n")
        self._stood += 1
        done = self._stood >= self._parameters.frames
        return Decision("hold", why=f"stood {self._stood}", outcome="succeeded" if done else "")


def _make(context: MissionContext, parameters: StandParameters) -> Stand:
    if context.whereabouts is not None:
        context.whereabouts.here = Displacement(parameters.goal_node)
    return Stand(parameters)


KIND = MissionKind("stand", "Stand", StandParameters, _make)
