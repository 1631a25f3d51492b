"""A mission that counts frames, and notes in a file when it begins: one begun twice has two lines."""

from pathlib import Path

from pydantic import BaseModel, ConfigDict, Field

from services.planner.mission_kinds import MissionContext, MissionKind
from services.planner.ports import Decision, Observation, Progress


class CountParameters(BaseModel):
    """How far, and where to note it."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    frames: int = Field(default=3, ge=1, le=10_000)
    file: str = ""
    name: str = ""
    keeps: bool = Field(default=True, description="What it has counted is its checkpoint.")


class Count:
    """Holds still."""

    def __init__(self, parameters: CountParameters, counted: int) -> None:
        self._parameters, self._counted = parameters, counted

    @property
    def progress(self) -> Progress:
        """How far it is."""
        return Progress(checkpoint={"counted": self._counted} if self._parameters.keeps else {})

    def decide(self, _observation: Observation) -> Decision:
        """Count one frame."""
        if self._counted == 0 and self._parameters.file:
            with Path(self._parameters.file).open("a", encoding="utf-8") as file:
                file.write(f"{self._parameters.name}\n")
        self._counted += 1
        done = self._counted >= self._parameters.frames
        return Decision("hold", why=f"counted {self._counted}", outcome="succeeded" if done else "")


def _make(context: MissionContext, parameters: CountParameters) -> Count:
    return Count(parameters, int(context.checkpoint.get("counted", 0)))


KIND = MissionKind("count", "Count frames", CountParameters, _make)
