"""The robot that a world is for, and what counts there: indoors or outdoors. Pure.

No service reads the world file. A robot for streets and yards has distance sensors that reach further and
takes fewer pictures a second; how it decides is the same everywhere.
"""

import os
from dataclasses import dataclass, field
from pathlib import Path

from simulator.world.world_file import WorldFile, read_contents, world_path


@dataclass(frozen=True)
class Spans:
    """Distances between nodes that calibration asks about, metres.

    Attributes:
        pair_m: of the pairs of frames measured.
        node_m: how far apart nodes should be.
        near_m: nearer than this a via point is reached.
    """

    pair_m: tuple[float, float] = (0.3, 3.0)
    node_m: tuple[float, float] = (0.5, 0.9)
    near_m: float = 0.5


@dataclass(frozen=True)
class Environment:
    """Settings and bounds of one kind of place.

    Attributes:
        profiles: planner and drive profile by the name that a command asks for, where it is another one here.
        variables: of the services, where they differ from the Compose file.
        arrived_m: a round succeeds within this distance of the hider.
        covered_m: a node covers the floor within this distance; an exploration is told so.
        blind_m: an edge may be this long between nodes with something in between.
        spans: distances that calibration measures.
    """

    profiles: dict[str, str] = field(default_factory=dict)
    variables: dict[str, str] = field(default_factory=dict)
    arrived_m: float = 0.5
    covered_m: float = 1.0
    blind_m: float = 3.0
    spans: Spans = Spans()

    def profile(self, asked: str | None) -> str | None:
        """The profile that `asked` means here; None leaves the stack's default."""
        return asked if asked is None else self.profiles.get(asked, asked)


INDOOR = Environment()
OUTDOOR = Environment(
    profiles={"thesis": "thesis_outdoor"},
    variables={"SIMULATOR_RANGE_MAX_M": "12.0", "SIMULATOR_CONTROL_PERIOD_S": "0.5"},
    arrived_m=1.0,
    covered_m=4.0,
    blind_m=12.0,
    spans=Spans(pair_m=(0.5, 12.0), node_m=(1.0, 1.8), near_m=1.0),
)
ENVIRONMENTS = {"indoor": INDOOR, "outdoor": OUTDOOR}


def environment_of(world: WorldFile | str | Path | None) -> Environment:
    """The environment of a world; None is the default world, which is indoors."""
    if world is None:
        return INDOOR
    if isinstance(world, WorldFile):
        return ENVIRONMENTS[world.environment]
    # Not all of it is read: models take seconds, and whoever uses the world checks it.
    named = read_contents(world_path(str(world))).get("environment", "indoor")
    return ENVIRONMENTS.get(named, INDOOR) if isinstance(named, str) else INDOOR


def robot_base() -> str:
    """What the robot of a stack that this command starts rolls on."""
    return os.environ.get("TOPNAV_BASE") or "holonomic"
