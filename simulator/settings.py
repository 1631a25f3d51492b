"""Settings of the simulated robot, its sensors and the physics. The bus loop has service_settings.py."""

import math
from pathlib import Path
from typing import Self

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    NonNegativeFloat,
    PositiveFloat,
    PositiveInt,
    model_validator,
)

from simulator.disturbances.levels import Disturbances
from simulator.robot.undercarriage import Base


class _Frozen(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class CameraSettings(_Frozen):
    """Spherical camera: picture size (always 2:1) and height of its centre above the floor.

    1024 rows as in the thesis (section 4.2). Chosen: the height of a table's top and 5 cm; `near_m` lets the
    camera see its own mast, `far_m` holds any room; `face_scale` in place of 1 / pi = 0.32 saves a quarter of
    the pixels.
    """

    width_px: PositiveInt = 2048
    height_m: PositiveFloat = 0.8
    near_m: PositiveFloat = 0.015
    far_m: PositiveFloat = 60.0
    face_scale: float = Field(
        default=0.28,
        ge=0.2,
        le=1.0,
        description="side of a cube face over picture width; 1 / pi keeps all resolution",
    )

    @model_validator(mode="after")
    def _even(self) -> Self:
        if self.width_px % 4:
            raise ValueError(f"width_px must be a multiple of 4, got {self.width_px}")
        return self


class RangeSettings(_Frozen):
    """Distance sensors: beams of `beam_rad`, each sampled by `rays`; figures of decision 0006."""

    count: PositiveInt = 12
    beam_rad: PositiveFloat = 0.5235987755982988
    rays: PositiveInt = 11
    max_m: PositiveFloat = 4.0
    noise_m: NonNegativeFloat = 0.01


class RobotSettings(_Frozen):
    """Robot body and servos.

    The thesis gives four legs that steer and drive (section 5.1) and 10 rad/s; sizes are chosen: a body that
    passes doors with a hand's breadth on either side, a mast that ends below the camera, servos that reach
    any angle in 0.2 s and any speed in half a second.

    Attributes:
        base: what it rolls on, see `simulator.robot.undercarriage`.
    """

    base: Base = "holonomic"
    body_radius_m: PositiveFloat = 0.25
    body_low_m: PositiveFloat = 0.03
    body_top_m: PositiveFloat = 0.22
    mast_top_m: PositiveFloat = 0.75
    mast_radius_m: PositiveFloat = 0.02
    steer_rate_radps: PositiveFloat = 12.0
    wheel_limit_radps: PositiveFloat = 20.0
    wheel_accel_radps2: PositiveFloat = 40.0


class SimulationSettings(_Frozen):
    """Everything `Simulation` needs besides the world.

    Attributes:
        timestep_s: of the physics; chosen: SAPIEN's default.
        camera: the spherical camera.
        ranges: the distance sensors.
        robot: body and servos.
        render: whether pictures are wanted.
        cache_dir: keeps textures and light between starts; None computes them every time.
        cache_limit_mb: size of that folder, above which the longest unused goes; chosen for
            three worlds of about 165.
        disturbances: how strongly camera and world are disturbed; nothing by default.
        company: names of other robots in the same place, see `Simulation.tell_company`.
        polite_people: walkers wait for the robot; without, they walk into it.
        imu: the camera knows where down is.
        imu_noise_rad: 1 sigma of that about each axis; chosen: 0.3 degrees, a cheap IMU in motion.
    """

    timestep_s: PositiveFloat = 0.01
    camera: CameraSettings = CameraSettings()
    ranges: RangeSettings = RangeSettings()
    robot: RobotSettings = RobotSettings()
    render: bool = True
    cache_dir: Path | None = None
    cache_limit_mb: PositiveInt = 640
    disturbances: Disturbances = Disturbances()
    company: tuple[str, ...] = ()
    polite_people: bool = True
    imu: bool = False
    imu_noise_rad: NonNegativeFloat = 0.3 * math.pi / 180.0
