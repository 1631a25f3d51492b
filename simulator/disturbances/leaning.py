"""All that leans the camera, put together: a robot that rocks, a mast that sways, a mount askew. No clock."""

import math

from simulator.disturbances.levels import Disturbances, generator
from simulator.disturbances.mount import mounted
from simulator.disturbances.rocking import Rocking, step
from simulator.disturbances.tilt import tilt_of
from simulator.sensors.attitude import PitchRoll, Quaternion, Vector, composed, gravity_in, leaning, measured
from simulator.settings import SimulationSettings

Planar = tuple[float, float, float]
"""x, y and angle, or their rates; metres and radians, world frame."""


def lean_of(
    levels: Disturbances, seed: int, time_s: float, speed_mps: float, rocked: PitchRoll
) -> Quaternion:
    """The camera against upright, see `simulator.sensors.attitude`.

    Args:
        levels: of the disturbances; `rocking` acts through `rocked`.
        seed: gives mast and mount their direction.
        time_s: simulated time, by which the mast sways.
        speed_mps: of the robot, without which it does not.
        rocked: lean of the robot's body.
    """
    mast = tilt_of(levels.tilt, seed, time_s, speed_mps)
    return composed(leaning(rocked), leaning(mast), leaning(mounted(levels.mount, seed)))


class CameraLean:
    """How the camera of one robot leans, and what its IMU says of that. Keeps how the robot rocks."""

    def __init__(self, settings: SimulationSettings) -> None:
        """Take levels, time step and IMU from `settings`; `reset` comes next."""
        self._settings, self._levels = settings, settings.disturbances

    def reset(self, seed: int) -> None:
        """Start anew: level and at rest."""
        self._seed, self._state = seed, Rocking()

    def lift(self) -> None:
        """The robot was put elsewhere: level and at rest."""
        self._state = self._state.lifted()

    def advance(self, yaw_rad: float, motion: Planar) -> None:
        """Let the robot rock on by a time step, after which it moves like this."""
        cos, sin = math.cos(yaw_rad), math.sin(yaw_rad)
        own_mps = (cos * motion[0] + sin * motion[1], cos * motion[1] - sin * motion[0])
        self._state = step(self._state, own_mps, self._settings.timestep_s, self._seed)

    def rocked(self) -> PitchRoll:
        """By how much the robot's body rocks now: pitch (nose down) and roll (left up), radians."""
        return self._state.tilt(self._levels.rocking)

    def lean(self, time_s: float, motion: Planar, rocked: PitchRoll) -> Quaternion:
        """Of a camera that moves like this on a body that leans like this."""
        speed_mps = (motion[0] ** 2 + motion[1] ** 2) ** 0.5
        return lean_of(self._levels, self._seed, time_s, speed_mps, rocked)

    def gravity(self, time_s: float, camera: Planar, motion: Planar, rocked: PitchRoll) -> Vector | None:
        """The IMU's reading, its noise drawn from seed, time and place; None without an IMU."""
        if not self._settings.imu:
            return None
        rng = generator(self._seed, "imu", time_s, *camera)
        return measured(gravity_in(self.lean(time_s, motion, rocked)), self._settings.imu_noise_rad, rng)
