"""What a caller chooses about a stack, and the variables of the Compose file that this becomes."""

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from services.launcher.processes.free_ports import HOST, free_ports, is_free


@dataclass(frozen=True)
class Ports:
    """TCP ports on loopback."""

    router: int = 7447
    gateway: int = 8000
    map_store: int = 8001

    @classmethod
    def free(cls) -> "Ports":
        """Pick three ports that are free now, for stacks side by side."""
        return cls(*free_ports(3))

    @classmethod
    def from_variables(cls, variables: Mapping[str, str]) -> "Ports":
        """Read TOPNAV_ROUTER_PORT, TOPNAV_GATEWAY_PORT and TOPNAV_MAP_STORE_PORT, with the usual defaults."""
        default = cls()
        return cls(
            int(variables.get("TOPNAV_ROUTER_PORT") or default.router),
            int(variables.get("TOPNAV_GATEWAY_PORT") or default.gateway),
            int(variables.get("TOPNAV_MAP_STORE_PORT") or default.map_store),
        )

    def taken(self) -> dict[str, int]:
        """Those that somebody else listens on, by the middle of the variable that moves them."""
        names = {"ROUTER": self.router, "GATEWAY": self.gateway, "MAP_STORE": self.map_store}
        return {name: port for name, port in names.items() if not is_free(port)}


@dataclass(frozen=True)
class StackSettings:
    """One stack.

    Attributes:
        data_dir: maps, models, logs and state live here.
        world: world of the simulator, a name or the path of a file; None leaves the Compose file's default,
            as for the three below.
        lockstep: run as fast as the machine allows, same seed, same path.
        seed: of every random draw.
        profile: rules of planner and drive, "default" or "thesis", or a file of `topnav calibrate --write`.
        ports: where the services listen.
        environment: set in every service last of all, for example {"FEATURES_KEYPOINTS": "300"}.
        secure: certificates for everybody, and a router that lets pass only what the access rules allow.
        camera: URL of a real camera, deploy/CAMERAS.md: its process runs, and the simulator does not.
        ros: file of a robot in ROS 2, deploy/ROBOTS.md: likewise.
        foxglove: port of the live view for Foxglove, which runs only where one is given.
        signs: signs are read as well, deploy/SIGNS.md.
        fleet: the process that hands out tasks for whichever robot runs as well.
    """

    data_dir: Path
    world: str | None = None
    lockstep: bool | None = None
    seed: int | None = None
    profile: str | None = None
    ports: Ports = field(default_factory=Ports)
    environment: Mapping[str, str] = field(default_factory=dict)
    secure: bool = False
    camera: str | None = None
    ros: str | None = None
    foxglove: int | None = None
    signs: bool = False
    fleet: bool = False

    @property
    def protocol(self) -> str:
        """What Zenoh endpoints begin with; "tls" is refused by a service without certificate."""
        return "tls" if self.secure else "tcp"

    @property
    def endpoint(self) -> str:
        """Zenoh endpoint of the router."""
        return f"{self.protocol}/{HOST}:{self.ports.router}"

    @property
    def certs(self) -> Path | None:
        """Folder of the certificates of a secured stack."""
        return self.data_dir / "certs" if self.secure else None

    def variables(self, base: Mapping[str, str] | None = None) -> dict[str, str]:
        """Return what the Compose file interpolates: the choices on top of `base` (the environment)."""
        base = dict(os.environ if base is None else base)
        chosen = {
            "TOPNAV_WORLD": located(self.world),
            "TOPNAV_LOCKSTEP": None if self.lockstep is None else str(self.lockstep).lower(),
            "TOPNAV_SEED": None if self.seed is None else str(self.seed),
            "TOPNAV_CAMERA": self.camera,
            "TOPNAV_ROS": located(self.ros),
            "TOPNAV_FOXGLOVE": None if self.foxglove is None else str(self.foxglove),
            "TOPNAV_SIGNS": "true" if self.signs else None,
            "TOPNAV_FLEET": "1" if self.fleet else None,
            **profile_variables(self.profile),
            "TOPNAV_BIND": HOST,
            "TOPNAV_BUS": self.protocol,
            "TOPNAV_TOKEN": base.get("TOPNAV_TOKEN", ""),  # nobody else reaches loopback: no secret needed
            "TOPNAV_ROUTER_PORT": str(self.ports.router),
            "TOPNAV_GATEWAY_PORT": str(self.ports.gateway),
            "TOPNAV_MAP_STORE_PORT": str(self.ports.map_store),
            # Weights and drawn textures are the same for every stack: one folder per user.
            "TORCH_HOME": base.get("TORCH_HOME") or str(Path("~/.cache/torch").expanduser()),
            "SIMULATOR_CACHE_DIR": base.get("SIMULATOR_CACHE_DIR")
            or str(Path("~/.cache/topnav").expanduser()),
        }
        return base | {name: value for name, value in chosen.items() if value is not None}


def profile_variables(profile: str | None) -> dict[str, str | None]:
    """A profile's name for planner and drive; of a profile file its base, and the file for the planner.

    Raises:
        ValueError: the file cannot be read.
    """
    if profile is None or not Path(profile).suffix:  # no name of a profile has one
        return {"TOPNAV_PROFILE": profile}
    try:
        base = json.loads(Path(profile).read_text(encoding="utf-8"))["base"]
    except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
        raise ValueError(
            f"--profile {profile}: not a file of 'topnav calibrate --write': {error or type(error).__name__}"
        ) from error
    return {"TOPNAV_PROFILE": str(base), "TOPNAV_PROFILE_FILE": str(Path(profile).absolute())}


def located(file: str | None) -> str | None:
    """A world's name as it is, a YAML file's path made absolute: the services run in another folder."""
    if file is None or Path(file).suffix not in {".yaml", ".yml"}:
        return file
    return str(Path(file).absolute())
