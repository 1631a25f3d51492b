"""Walkers on their routes. They never walk into the robot: they wait, then turn back. Pure."""

import math
from dataclasses import dataclass, replace

import numpy as np

from simulator.disturbances.levels import generator
from simulator.disturbances.people import Figure, cart, person
from simulator.disturbances.routes import STEP_M, FloatArray, closed_route
from simulator.scene.parts import Piece, Pose2, moved
from simulator.world.footprints import Footprints, clearance_m, footprints
from simulator.world.freespace import BODY_BAND_M, FreeSpace, Point

# All chosen: people who are in the way and never at fault.
GAP_M = 0.4  # to the robot's edge, below which a walker does not come nearer
BETWEEN_M = 0.1  # the same between walkers
PATIENCE_S = 1.5  # after which one who waits turns back
TURN_RADPS = 4.0  # a body follows its way within half a second
FLOOR_PER_WALKER_M2, MOST_WALKERS = 14.0, 12  # at level 1
CART_EVERY = 3


@dataclass
class Walker:
    """One walker: where on its route it is and which way it goes.

    Attributes:
        route: (n, 2) points STEP_M apart; the last is followed by the first.
        passable: (n,) whether it can stand there; a door may close on its way.
    """

    figure: Figure
    route: FloatArray
    passable: np.ndarray[tuple[int], np.dtype[np.bool_]]
    along_m: float
    direction: int = 1
    waited_s: float = 0.0
    yaw_rad: float = 0.0

    def point(self, along_m: float) -> Point:
        """Position after a length of way."""
        place = along_m / STEP_M
        k, share = math.floor(place), place - math.floor(place)
        a, b = self.route[k % len(self.route)], self.route[(k + 1) % len(self.route)]
        return float(a[0] + share * (b[0] - a[0])), float(a[1] + share * (b[1] - a[1]))

    def pose(self) -> Pose2:
        """Position and heading."""
        return (*self.point(self.along_m), self.yaw_rad)

    def open_at(self, along_m: float) -> bool:
        """Whether nothing was put there."""
        return bool(self.passable[round(along_m / STEP_M) % len(self.route)])


class Crowd:
    """All walkers of a world."""

    def __init__(self, walkers: list[Walker], robot_radius_m: float, polite: bool = True) -> None:
        """Put walkers on the floor.

        Args:
            walkers: at their starts; copies are made.
            robot_radius_m: of the robot they look out for.
            polite: wait for the robot; without, they walk on as if it were not there.
        """
        self._starts = walkers
        self._robot_radius_m, self._polite = robot_radius_m, polite
        self.restart()

    def restart(self) -> None:
        """Everybody back to the start."""
        self.walkers = [replace(walker) for walker in self._starts]
        for walker in self.walkers:
            walker.yaw_rad = self._ahead_rad(walker)

    def advance(self, dt_s: float, robot: Point) -> None:
        """Walk for a moment; one after the other, so that two never meet."""
        for walker in self.walkers:
            step_m = walker.direction * walker.figure.speed_mps * dt_s
            if self._free(walker, walker.along_m + step_m, robot):
                walker.along_m += step_m
                walker.waited_s = 0.0
                change = math.remainder(self._ahead_rad(walker) - walker.yaw_rad, 2.0 * math.pi)
                walker.yaw_rad += max(-TURN_RADPS * dt_s, min(TURN_RADPS * dt_s, change))
                continue
            walker.waited_s += dt_s
            if walker.waited_s > PATIENCE_S:
                walker.direction, walker.waited_s = -walker.direction, 0.0

    def make_room(self, robot: Point) -> None:
        """Walk on those who stand where the robot was put."""
        for walker in self.walkers:
            for _ in range(len(walker.route)):
                if self._gap_m(walker, walker.along_m, robot) >= GAP_M and walker.open_at(walker.along_m):
                    break
                walker.along_m += STEP_M

    def block(self, standing: Footprints) -> None:
        """Learn what stands in the world now: nobody walks through it."""
        for walker in [*self._starts, *self.walkers]:
            walker.passable = clearance_m(walker.route, standing) >= walker.figure.radius_m

    def outlines(self) -> Footprints:
        """What the distance sensors feel of them."""
        solids = tuple(
            part
            for walker in self.walkers
            for part in moved(Piece((walker.figure.solid,)), *walker.pose()).parts
        )
        return footprints(solids, *BODY_BAND_M)

    def _free(self, walker: Walker, along_m: float, robot: Point) -> bool:
        """Whether a walker may go there: nothing stands there, and it comes near nobody."""
        if not walker.open_at(along_m + walker.direction * STEP_M) and walker.open_at(walker.along_m):
            return False
        if self._polite and _nearer(
            self._gap_m(walker, along_m, robot), self._gap_m(walker, walker.along_m, robot), GAP_M
        ):
            return False
        here, there = walker.point(walker.along_m), walker.point(along_m)
        for other in self.walkers:
            if other is walker:
                continue
            place = other.point(other.along_m)
            apart_m = BETWEEN_M + walker.figure.radius_m + other.figure.radius_m
            if _nearer(math.dist(there, place), math.dist(here, place), apart_m):
                return False
        return True

    def _gap_m(self, walker: Walker, along_m: float, robot: Point) -> float:
        reach_m = walker.figure.radius_m + self._robot_radius_m
        return math.dist(walker.point(along_m), robot) - reach_m

    @staticmethod
    def _ahead_rad(walker: Walker) -> float:
        here = walker.point(walker.along_m)
        ahead = walker.point(walker.along_m + walker.direction * 4 * STEP_M)
        if here == ahead:
            return walker.yaw_rad
        return math.atan2(ahead[1] - here[1], ahead[0] - here[0])


def crowd_of(space: FreeSpace, level: float, seed: int, polite: bool = True) -> Crowd:
    """Walkers for a level: one per FLOOR_PER_WALKER_M2 of free floor at level 1, every third a cart.

    Nobody starts within 1.5 m of where the robot starts; who finds no way wide enough is left out.
    """
    floor_m2 = float(space.free.sum()) * space.resolution_m**2
    count = min(MOST_WALKERS, math.ceil(level * floor_m2 / FLOOR_PER_WALKER_M2)) if level else 0
    walkers: list[Walker] = []
    for k in range(count):
        rng = generator(seed, "people", k)
        figure = cart(rng) if k % CART_EVERY == CART_EVERY - 1 else person(rng)
        route = closed_route(space, figure.radius_m, rng)
        if route is None:
            continue
        walker = Walker(figure, route, np.ones(len(route), np.bool_), rng.uniform(0, len(route) * STEP_M))
        if _apart(walker, walkers):
            walkers.append(walker)
    return Crowd(walkers, space.robot_radius_m, polite)


def _apart(walker: Walker, others: list[Walker]) -> bool:
    """Move a walker along its route to where it touches no other; False if there is no such place."""
    for _ in range(len(walker.route)):
        here = walker.point(walker.along_m)
        if all(
            math.dist(here, other.point(other.along_m))
            > BETWEEN_M + walker.figure.radius_m + other.figure.radius_m
            for other in others
        ):
            return True
        walker.along_m += STEP_M
    return False


def _nearer(new_m: float, old_m: float, least_m: float) -> bool:
    return new_m < least_m and new_m < old_m
