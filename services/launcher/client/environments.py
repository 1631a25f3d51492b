"""What the operator of a stack chooses for a world: indoors or outdoors. Pure.

No service reads the world file; these are the settings that a person would pick for such a place.
"""

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
        profiles: planner and drive profile by the name that a command asks for.
        pipeline: feature pipeline unless a command names one.
        variables: of the services, where they differ from the Compose file.
        arrived_m: a round succeeds within this distance of the hider.
        covered_m: a node covers the floor within this distance.
        blind_m: an edge may be this long between nodes with something in between.
        spans: distances that calibration measures.
    """

    profiles: dict[str, str] = field(default_factory=dict)
    pipeline: str | None = None
    variables: dict[str, str] = field(default_factory=dict)
    arrived_m: float = 0.5
    covered_m: float = 1.0
    blind_m: float = 3.0
    spans: Spans = Spans()

    def profile(self, asked: str | None) -> str | None:
        """The profile that `asked` means here; None leaves the stack's default."""
        return self.profiles.get(asked or "default", asked)


INDOOR = Environment()
OUTDOOR = Environment(
    profiles={"default": "outdoor", "thesis": "thesis_outdoor"},
    pipeline="sift_dense",
    variables={"SIMULATOR_RANGE_MAX_M": "12.0", "SIMULATOR_CONTROL_PERIOD_S": "0.5"},
    arrived_m=1.0,
    covered_m=4.0,
    blind_m=12.0,
    spans=Spans(pair_m=(0.5, 12.0), node_m=(2.5, 4.5), near_m=2.0),
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
