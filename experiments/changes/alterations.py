"""Furniture that is taken away, brought or moved between two visits. Pure."""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from shared.messages.simulation import Pose
from simulator.generation.pieces import Placed
from simulator.generation.rearranging import Rearranging
from simulator.world.changes import item_names
from simulator.world.world_file import WorldFile

LEAST_MOVE_M = 0.4
"""Of what counts as moved."""
TRIES = 60

Point = tuple[float, float]


@dataclass(frozen=True)
class Alteration:
    """One piece of furniture that is elsewhere afterwards.

    Attributes:
        name: of the item, as `topnav world` and the simulator call it.
        kind: of the change; a piece that is brought is one taken away, seen in the other order.
        before: where it stands first, middle of its outline in metres.
        after: where it stands then; None where it is gone.
        pose: the same of its anchor, for the simulator.
        reach_m: from its middle to its corner.
    """

    name: str
    kind: Literal["removed", "moved"]
    before: Point
    after: Point | None
    pose: Pose | None
    reach_m: float

    @property
    def spots(self) -> list[Point]:
        """Where something changed."""
        return [self.before] if self.after is None else [self.before, self.after]


def draw_alteration(world: WorldFile, rng: np.random.Generator, besides: set[str]) -> Alteration:
    """A piece that a person can carry and on which nothing stands, taken away or moved.

    Args:
        world: as it is first.
        rng: draws the piece and what becomes of it.
        besides: names of pieces that stay.

    Raises:
        ValueError: the world has no such piece.
    """
    names, own = item_names(world), len(world.furniture)
    for _ in range(TRIES):
        room = Rearranging(world, own, rng)
        old = list(room.pieces)
        free = [k for k in room.movable if names[k] not in besides]
        if not free:
            break
        k = int(rng.choice(free))
        (room.remove, room.move)[int(rng.integers(2))](k)
        changed = [j for j, piece in enumerate(room.pieces) if piece is not old[j]]
        before, after = old[k], room.pieces[k]
        assert before is not None
        if changed == [k] and (after is None or _apart_m(before, after) >= LEAST_MOVE_M):
            return _alteration(names[k], before, after)
    raise ValueError(f"{world.name} has nothing that could be moved or taken away")


def _alteration(name: str, before: Placed, after: Placed | None) -> Alteration:
    box = before.box
    reach_m = math.hypot(box.x1 - box.x0, box.y1 - box.y0) / 2
    if after is None:
        return Alteration(name, "removed", box.centre_m, None, None, reach_m)
    pose = Pose(x_m=after.at_m[0], y_m=after.at_m[1], yaw_rad=math.radians(after.yaw_deg))
    return Alteration(name, "moved", box.centre_m, after.box.centre_m, pose, reach_m)


def _apart_m(a: Placed, b: Placed) -> float:
    return math.dist(a.box.centre_m, b.box.centre_m)
