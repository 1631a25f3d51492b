"""Where everything that moves is, for one picture."""

from dataclasses import dataclass

import sapien

Pose2 = tuple[float, float, float]


@dataclass(frozen=True)
class Bodies:
    """Poses of the robot's links by name, of the hider if there is one, and of all walkers."""

    links: dict[str, sapien.Pose]
    hider: Pose2 | None
    walkers: list[Pose2]
