"""Pictures of places before and after furniture was changed, and which pixels really changed."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from experiments.changes.alterations import Alteration, Point, draw_alteration
from shared.messages.simulation import Pose
from simulator.sensors.panorama import directions
from simulator.simulation import Image, Simulation
from simulator.world.changes import ChangeError
from simulator.world.freespace import FreeSpace

FAR_M = 4.0
"""How far away a change may be."""
PLACES = 4
"""From which each state of the world is looked at; chosen: a state takes ten seconds to build."""
SPARE_M = 0.05
ROBOT_M = 0.3
"""Between the camera and what was moved; chosen: a little more than the robot's radius."""
TRIES = 200
RANGE_M = 0.05
"""A surface this much nearer or further is another; chosen: more than the depth buffer errs at 10 m."""
LEVELS = 10
"""A pixel that differs by more at the same spot is in a shadow, or a light's reflection, that moved."""
SHADE = 255
"""Label of pixels that only look different."""

Labels = npt.NDArray[np.uint8]
Ranges = npt.NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Sight:
    """A place in both states of a world, seen from two spots.

    Attributes:
        before, after: the world before and after the changes, each from the first spot and from the second;
            (2, H, W, 3) BGR.
        labels: (2, H, W): for each spot, 0 where nothing changed, k for the k-th alteration, SHADE.
        alterations: what was changed.
        offset_m: between the spots.
        yaw_rad: turn from the first camera to the second, counter-clockwise.
    """

    before: Image
    after: Image
    labels: Labels
    alterations: tuple[Alteration, ...]
    offset_m: float
    yaw_rad: float


def sights(
    simulation: Simulation, space: FreeSpace, states: int, most_m: float, rng: np.random.Generator
) -> Iterator[Sight]:
    """Places that see changes, `PLACES` for each of so many states of a world.

    Args:
        simulation: of the world as it is first, and again afterwards.
        space: its free floor.
        states: how often one or two pieces are changed.
        most_m: largest distance between the two spots of a place.
        rng: draws everything.
    """
    for _ in range(states):
        changes: list[Alteration] = []
        for _ in range(1 + int(rng.integers(2))):
            changes.append(draw_alteration(simulation.world, rng, {each.name for each in changes}))
        spots = [_spots(space, changes, most_m, rng) for _ in range(PLACES)]
        seen = [each for each in spots if each is not None]
        before = [_measured(simulation, pair) for pair in seen]
        try:
            for change in changes:
                simulation.set_item(change.name, None if change.pose else False, _pose2(change.pose))
            after = [_measured(simulation, pair) for pair in seen]
        except ChangeError:  # it would stand in the robot
            continue
        finally:
            for change in changes:
                simulation.set_item(change.name, True)
        for pair, old, new in zip(seen, before, after, strict=True):
            yield _sight(pair, old, new, changes)


Spots = tuple[Pose, Pose]
Measured = tuple[Image, Ranges]


def _spots(
    space: FreeSpace, changes: Sequence[Alteration], most_m: float, rng: np.random.Generator
) -> Spots | None:
    """Two poses a little apart, within sight of one of the changes; None where chance found none."""
    for _ in range(TRIES):
        x, y, yaw_rad = space.random_pose(rng, SPARE_M)
        near = [s for each in changes for s in each.spots if math.dist((x, y), s) < FAR_M]
        away_m, way_rad, other_rad = rng.uniform((0.0, -math.pi, -math.pi), (most_m, math.pi, math.pi))
        there = (x + away_m * math.cos(way_rad), y + away_m * math.sin(way_rad))
        if not near or not space.is_free(there) or _is_taken((x, y), there, changes):
            continue
        if any(space.in_view((x, y), s) for s in near):
            return Pose(x_m=x, y_m=y, yaw_rad=yaw_rad), Pose(x_m=there[0], y_m=there[1], yaw_rad=other_rad)
    return None


def _is_taken(here: Point, there: Point, changes: Sequence[Alteration]) -> bool:
    """Whether something now stands where the robot would."""
    spots = [(each.after, each.reach_m) for each in changes if each.after is not None]
    return any(math.dist(at, spot) < reach_m + ROBOT_M for spot, reach_m in spots for at in (here, there))


def _pose2(pose: Pose | None) -> tuple[float, float, float] | None:
    return None if pose is None else (pose.x_m, pose.y_m, pose.yaw_rad)


def _measured(simulation: Simulation, spots: Spots) -> list[Measured]:
    return [simulation.measured_at(pose.x_m, pose.y_m, pose.yaw_rad) for pose in spots]


def _sight(
    spots: Spots, before: Sequence[Measured], after: Sequence[Measured], changes: Sequence[Alteration]
) -> Sight:
    labels = [labels_of(pose, old, new, changes) for pose, old, new in zip(spots, before, after, strict=True)]
    here, there = spots
    return Sight(
        np.stack([picture for picture, _ in before]),
        np.stack([picture for picture, _ in after]),
        np.stack(labels),
        tuple(changes),
        math.hypot(there.x_m - here.x_m, there.y_m - here.y_m),
        math.remainder(there.yaw_rad - here.yaw_rad, math.tau),
    )


def labels_of(pose: Pose, old: Measured, new: Measured, changes: Sequence[Alteration]) -> Labels:
    """Which alteration each pixel shows, (H, W): the one at which the nearer of both surfaces stands.

    Args:
        pose: of the camera, both times.
        old: picture and ranges before.
        new: the same afterwards.
        changes: what was altered.
    """
    nearer = np.minimum(old[1], new[1])
    both = np.isfinite(old[1]) & np.isfinite(new[1])
    gap = np.abs(np.where(both, old[1], 0.0) - np.where(both, new[1], 0.0))
    moved = (gap > RANGE_M) | (np.isfinite(old[1]) != np.isfinite(new[1]))
    shaded = np.abs(old[0].astype(np.int16) - new[0]).max(axis=2) > LEVELS
    rays = directions(nearer.shape[1])
    at = np.where(np.isfinite(nearer), nearer, 0.0)[..., None] * rays
    c, s = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
    x, y = pose.x_m + c * at[..., 0] - s * at[..., 1], pose.y_m + s * at[..., 0] + c * at[..., 1]
    away = np.stack(
        [
            np.min([np.hypot(x - spot[0], y - spot[1]) for spot in each.spots], axis=0) - each.reach_m
            for each in changes
        ]
    )
    whose = np.argmin(away, axis=0).astype(np.uint8) + 1
    return np.asarray(np.where(moved, whose, np.where(shaded, SHADE, 0)), np.uint8)
