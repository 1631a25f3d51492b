"""A mission in one file: look about for some frames, then be done. Nothing else knows of it."""

from pydantic import BaseModel, ConfigDict, Field

from services.planner.mission_kinds import MissionContext, MissionKind
from services.planner.ports import Decision, Observation, Progress


class WaveParameters(BaseModel):
    """How long."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    frames: int = Field(default=3, ge=1, le=100, description="Frames to look at.")


class Wave:
    """Holds still and counts the keypoints it sees."""

    def __init__(self, frames: int) -> None:
        self._frames, self._seen, self._keypoints = frames, 0, 0

    @property
    def progress(self) -> Progress:
        """What it saw."""
        return Progress(figures={"frames_seen": self._seen, "keypoints_seen": self._keypoints})

    def decide(self, observation: Observation) -> Decision:
        """Look at one frame."""
        self._seen += 1
        self._keypoints += len(observation.features.lonlat_rad)
        done = self._seen == self._frames
        why = f"seen {self._seen} of {self._frames} frames"
        return Decision("hold", why=why, outcome="succeeded" if done else "")


def _make(_context: MissionContext, parameters: WaveParameters) -> Wave:
    return Wave(parameters.frames)


KIND = MissionKind("wave", "Look about", WaveParameters, _make, shown=("frames_seen", "keypoints_seen"))
