"""Settings of the simulator process, from SIMULATOR_* variables."""

from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, PositiveFloat, PositiveInt, model_validator
from pydantic_settings import NoDecode, SettingsConfigDict

from shared.access.credentials import credentials_in
from shared.settings import RobotNames, ServiceSettings
from simulator.cache_folder import user_cache_dir
from simulator.disturbances.levels import Disturbances
from simulator.robot.undercarriage import Base
from simulator.settings import CameraSettings, RangeSettings, RobotSettings, SimulationSettings

Folder = Annotated[Path | None, BeforeValidator(lambda value: value or None)]


class SimulatorSettings(ServiceSettings):
    """Read from the environment.

    Attributes:
        world: name of a world that comes with the simulator, or path of a .yaml file.
        lockstep: send frame k, wait for velocity k, advance by control_period_s; else follow the wall clock.
        seed: of the sensors' noise.
        control_period_s: simulated time per velocity in lockstep.
        repeat_s: wall time after which an unanswered frame is sent again in lockstep.
        frame_rate_hz: most frames a second in real time.
        range_rate_hz: distance readings a second in real time.
        encoding: bgr8 is exact; jpeg is smaller and costs time on both sides.
        cache_dir: where textures and light are kept between starts; empty keeps nothing.
        cache_limit_mb: size of that folder, see SimulationSettings.
        disturbance: levels from 0 to 1 of what disturbs camera and world, as "fog=0.5,noise=0.3".
        company: names of other simulated robots in the same place, as "r2,r3": each simulator shows where the
            others are, and distance sensors and wheels meet them.
        polite_people: see SimulationSettings.
        base: what the robot rolls on.
        odometry: the robot says where its wheels have got to, as encoders do.
        imu: frames say where down is (`gravity`), as of a camera with an IMU.
        state_dir: where the robot keeps an emergency stop across restarts.
    """

    model_config = SettingsConfigDict(env_prefix="SIMULATOR_")

    world: str = "apartment"
    lockstep: bool = False
    seed: int = Field(default=1, ge=0)
    control_period_s: PositiveFloat = 0.3
    repeat_s: PositiveFloat = 0.5
    frame_rate_hz: PositiveFloat = 5.0
    range_rate_hz: PositiveFloat = 10.0
    encoding: Literal["bgr8", "jpeg"] = "bgr8"
    jpeg_quality: int = Field(default=92, ge=1, le=100)
    width_px: int = Field(default=2048, ge=64, le=8192, multiple_of=4)
    camera_height_m: PositiveFloat = 0.8
    range_max_m: PositiveFloat = 4.0
    range_noise_m: float = Field(default=0.01, ge=0.0)
    cache_dir: Folder = Field(default_factory=user_cache_dir)
    cache_limit_mb: PositiveInt = SimulationSettings().cache_limit_mb
    disturbance: Annotated[Disturbances, NoDecode] = Disturbances()
    company: RobotNames = ()
    polite_people: bool = True
    base: Base = "holonomic"
    odometry: bool = False
    imu: bool = False
    state_dir: Path = Path("data/robot-state")

    @model_validator(mode="after")
    def _may_have_company(self) -> Self:
        if self.robot in self.company:
            raise ValueError(f"COMPANY names other robots, got {self.robot!r}, which is the robot itself")
        if self.company and credentials_in(self.certs) is not None:
            raise ValueError(
                "COMPANY names other robots and a certificate is for one: on the secured bus a simulator "
                "hears of no other"
            )
        return self

    def simulation(self) -> SimulationSettings:
        """The part that the simulation itself needs."""
        camera = CameraSettings(width_px=self.width_px, height_m=self.camera_height_m)
        return SimulationSettings(
            camera=camera,
            ranges=RangeSettings(max_m=self.range_max_m, noise_m=self.range_noise_m),
            cache_dir=self.cache_dir,
            cache_limit_mb=self.cache_limit_mb,
            disturbances=self.disturbance,
            company=self.company,
            polite_people=self.polite_people,
            robot=RobotSettings(base=self.base),
            imu=self.imu,
        )
