"""Whether a robot can begin something now, and if not, what keeps it. Pure."""

from dataclasses import dataclass
from typing import Literal

from shared.messages.tasks import QueueStatus
from shared.robots.seen import Seen, kept_by

Kind = Literal["ready", "silent", "low", "kept"]


@dataclass(frozen=True)
class Condition:
    """How a robot stands.

    Attributes:
        kind: ready: it can begin; silent: one of its services says nothing; low: of its battery; kept:
            it is stopped, driven by hand, or on a mission.
        why: for people; "" where it is ready.
    """

    kind: Kind
    why: str = ""

    @property
    def is_ready(self) -> bool:
        """Whether it can begin something now."""
        return self.kind == "ready"


READY = Condition("ready")


def condition_of(seen: Seen, told: QueueStatus | None, battery: float) -> Condition:
    """How a robot stands by what its services said lately.

    Args:
        seen: by its planner, drive and battery.
        told: by its dispatch; None where that said nothing lately.
        battery: the least charge with which it begins something, 0 to 1.
    """
    if told is None:
        return Condition("silent", "nothing is heard of its dispatch")
    if seen.status is None:
        return Condition("silent", "nothing is heard of its planner")
    if seen.stopped is None:
        return Condition("silent", "nothing is heard of its drive")
    if told.on_hold:
        return Condition("low", "on hold for its battery")
    if seen.charge is not None and seen.charge < battery:
        return Condition("low", f"its battery is at {seen.charge:.0%}")
    if (why := kept_by(seen)) is not None:
        return Condition("kept", why)
    if seen.status.state in ("running", "paused"):
        return Condition("kept", f"mission {seen.status.mission_id} is {seen.status.state}")
    return READY
