"""What is known of a robot by what its services say, for whoever gives it something to do. Pure."""

from dataclasses import dataclass

from shared.messages.missions import MissionStatus


@dataclass(frozen=True)
class Seen:
    """What is known of the robot; None of what nobody said lately.

    Attributes:
        status: of its mission.
        stopped: whether the emergency stop is engaged.
        driver: who drives it by hand; "" for nobody.
        charge: of the battery, 0 to 1; None also of a robot that has none or does not tell.
    """

    status: MissionStatus | None
    stopped: bool | None
    driver: str = ""
    charge: float | None = None


def kept_by(seen: Seen) -> str | None:
    """What keeps the robot from beginning anything; None for nothing."""
    if seen.stopped is None:
        return "nothing is heard of drive"
    if seen.stopped:
        return "the emergency stop is engaged"
    return f"{seen.driver} drives by hand" if seen.driver else None
