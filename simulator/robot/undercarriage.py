"""What the robot rolls on: where its wheels are, which of them steer and which are driven. Pure.

| base | wheels | cannot |
|---|---|---|
| holonomic | four, all steered and driven | |
| differential | two driven on one axle, a ball before and one behind | go sideways |
| ackermann | two driven at the back, two steered in front | go sideways, turn on the spot |

The origin of the robot's frame is the middle of the axle that does not steer, so that it never goes sideways.
"""

import math
from dataclasses import dataclass
from typing import Literal

Base = Literal["holonomic", "differential", "ackermann"]


@dataclass(frozen=True)
class Mount:
    """One wheel in the robot's frame (x ahead, y left).

    Attributes:
        limit_rad: how far it steers to either side; 0: it does not.
        driven: whether a motor turns it.
    """

    x_m: float
    y_m: float
    radius_m: float
    limit_rad: float = 0.0
    driven: bool = True

    @property
    def steered(self) -> bool:
        """Whether it hangs on a leg that turns."""
        return self.limit_rad > 0.0


@dataclass(frozen=True)
class Undercarriage:
    """A base.

    Attributes:
        mounts: of the wheels, front left first, then to the right and to the back.
        balls_m: places of balls that slide without friction, where the wheels alone would not stand.
        weight_x_m: how far ahead of the origin the weight lies.
    """

    base: Base
    mounts: tuple[Mount, ...]
    balls_m: tuple[tuple[float, float], ...] = ()
    weight_x_m: float = 0.0


LEG_M, LEG_LIMIT_RAD = 0.12, 1.9
"""Of the four legs, from the middle; a servo reaches 109 degrees, so that any direction is one of its ends or
the other, rolled backwards. Chosen; the thesis (section 5.1) has wheels from -30 to 60 degrees and more."""
AXLE_M, BALL_X_M = 0.14, 0.17
"""Of the differential base: half the distance of its wheels, and where its balls are; chosen: all of it lies
below the body."""
TRACK_M, WHEELBASE_M, CAR_LIMIT_RAD = 0.1, 0.17, math.radians(40.0)
"""Of the car: half its track, its length from axle to axle, and how far a front wheel steers: a circle of
0.31 m for the middle of the rear axle at least. Chosen: all of it lies below the body."""
WHEEL_M, CAR_WHEEL_M = 0.08, 0.05


def undercarriage_of(base: Base) -> Undercarriage:
    """The base of that name."""
    if base == "holonomic":
        corners = ((LEG_M, LEG_M), (LEG_M, -LEG_M), (-LEG_M, LEG_M), (-LEG_M, -LEG_M))
        return Undercarriage(base, tuple(Mount(x, y, WHEEL_M, LEG_LIMIT_RAD) for x, y in corners))
    if base == "differential":
        mounts = (Mount(0.0, AXLE_M, WHEEL_M), Mount(0.0, -AXLE_M, WHEEL_M))
        return Undercarriage(base, mounts, ((BALL_X_M, 0.0), (-BALL_X_M, 0.0)))
    front = tuple(
        Mount(WHEELBASE_M, side * TRACK_M, CAR_WHEEL_M, CAR_LIMIT_RAD, driven=False) for side in (1, -1)
    )
    rear = tuple(Mount(0.0, side * TRACK_M, CAR_WHEEL_M) for side in (1, -1))
    return Undercarriage(base, front + rear, weight_x_m=0.5 * WHEELBASE_M)


@dataclass(frozen=True)
class Roll:
    """What one wheel is to do: roll in a direction of the robot's frame, at a speed over the floor."""

    heading_rad: float
    speed_mps: float


def rolls(
    undercarriage: Undercarriage,
    forward_mps: float,
    left_mps: float,
    turn_radps: float,
    deadband_mps: float = 0.0,
) -> tuple[Roll, ...]:
    """How each wheel has to roll for a velocity of the robot; of what a base cannot do the nearest it can.

    A wheel at p rolls with the speed of the body there, v + turn x p. A base whose wheels do not all steer
    drops the part to the left. A car cannot turn faster than its front wheels let it, nor at all where it
    stands; the same share of the turn is kept at any speed.

    Args:
        undercarriage: the base.
        forward_mps: of the robot, in its frame.
        left_mps: likewise.
        turn_radps: likewise.
        deadband_mps: a wheel that would have to roll more slowly stands still.

    Returns:
        One for each mount, with a heading within a quarter turn for wheels that a car steers, negative speeds
        rolling backwards.
    """
    wanted = _wanted(undercarriage, forward_mps, left_mps, turn_radps)
    return tuple(Roll(r.heading_rad, 0.0) if abs(r.speed_mps) < deadband_mps else r for r in wanted)


def _wanted(
    undercarriage: Undercarriage, forward_mps: float, left_mps: float, turn_radps: float
) -> tuple[Roll, ...]:
    if undercarriage.base == "holonomic":
        return tuple(
            _rolling(forward_mps - turn_radps * m.y_m, left_mps + turn_radps * m.x_m)
            for m in undercarriage.mounts
        )
    if undercarriage.base == "differential":
        return tuple(Roll(0.0, forward_mps - turn_radps * m.y_m) for m in undercarriage.mounts)
    bend = 0.0 if forward_mps == 0.0 else turn_radps / forward_mps
    most = 1.0 / least_radius_m()
    bend = max(-most, min(most, bend))
    ahead = ((1.0 - bend * m.y_m, bend * m.x_m) for m in undercarriage.mounts)
    return tuple(Roll(math.atan2(y, x), forward_mps * math.hypot(x, y)) for x, y in ahead)


def least_radius_m() -> float:
    """The tightest circle of the car's origin: its inner front wheel is at its stop."""
    return WHEELBASE_M / math.tan(CAR_LIMIT_RAD) + TRACK_M


def _rolling(x_mps: float, y_mps: float) -> Roll:
    return Roll(math.atan2(y_mps, x_mps), math.hypot(x_mps, y_mps))
