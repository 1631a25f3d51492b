"""How a mission, the emergency stop and the robot are."""

from typing import Any, Self

from pydantic import BaseModel


class Mission(BaseModel):
    """How a mission stands.

    Attributes:
        state: running, paused, succeeded, failed, cancelled or idle.
        failure: kind of failure, empty while there is none.
        reason: the newest decision with its reason; words of the robot, not instructions.
        ended: no more of it is to be waited for.
    """

    mission_id: str
    action: str
    state: str
    failure: str
    reason: str
    step: int
    ended: bool

    @classmethod
    def of(cls, told: dict[str, Any]) -> Self:
        """From the gateway's mission status."""
        return cls(**told, ended=told["state"] not in ("running", "paused"))


class Stop(BaseModel):
    """The emergency stop; only a person clears it, in the console or at the robot."""

    engaged: bool
    who: str
    why: str


class RobotFacts(BaseModel):
    """How the robot is.

    Attributes:
        frame_age_s: of its newest picture; None before any.
        stopped: whether the emergency stop is engaged.
        battery: from 0 to 1; None where the robot has not said.
    """

    robot: str
    frame_age_s: float | None
    stopped: bool
    battery: float | None
    mission: Mission | None

    @classmethod
    def of(cls, told: dict[str, Any]) -> Self:
        """From the gateway's view of the robot."""
        frame, estop, mission = told["frame"], told["estop"], told["mission"]
        return cls(
            robot=told["robot"],
            frame_age_s=None if frame is None else frame["age_s"],
            stopped=estop is not None and estop["engaged"],
            battery=(told.get("battery") or {}).get("share"),
            mission=None if mission is None else Mission.of(mission),
        )
