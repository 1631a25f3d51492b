"""`python -m tests.contract.service_settings`: write deploy/compose.settings.yml from the services' settings.

A variable that Compose lists without a value reaches the container where `.env` or the shell sets it, and is
absent otherwise. Not all of `.env` is handed to all: no container but its owner sees a secret.
"""

import importlib
from pathlib import Path

import yaml

from shared.settings import ServiceSettings

ROOT = Path(__file__).resolve().parents[2]
FILE = ROOT / "deploy/compose.settings.yml"
MODULES = {
    "map-store": "services.map_store.settings",
    "simulator": "simulator.service_settings",
    "camera": "services.camera.settings",
    "ros": "services.ros.settings",
    "features": "services.features.settings",
    "signs": "services.signs.settings",
    "planner": "services.planner.settings",
    "drive": "services.drive.settings",
    "dispatch": "services.dispatch.settings",
    "fleet": "services.fleet.settings",
    "gateway": "services.gateway.settings",
    "foxglove": "services.recorder.foxglove.live.settings",
}
HEADER = """\
# The settings of each service that docker-compose.yml does not choose: set in .env or in the shell they reach
# its container, see deploy/SETTINGS.md. Written by `python -m tests.contract.service_settings`.
services:
"""


def settings_class(service: str) -> type[ServiceSettings]:
    """What reads the variables of a service."""
    found = vars(importlib.import_module(MODULES[service])).values()
    (own,) = (
        one
        for one in found
        if isinstance(one, type) and issubclass(one, ServiceSettings) and one is not ServiceSettings
    )
    return own


def passed_on(service: str, chosen: set[str]) -> list[str]:
    """Variables of a service but those that the Compose file sets itself and those that TOPNAV_* names."""
    kind = settings_class(service)
    own = [name for name in kind.model_fields if name not in ServiceSettings.model_fields]
    variables = (f"{kind.model_config.get('env_prefix')}{name.upper()}" for name in own)
    return [variable for variable in variables if variable not in chosen]


def text() -> str:
    """What the file says."""
    services = yaml.safe_load((ROOT / "docker-compose.yml").read_text(encoding="utf-8"))["services"]
    lines = [HEADER]
    for service in MODULES:
        variables = passed_on(service, set(services[service]["environment"]))
        if variables:
            lines += [
                f"  {service}:\n    environment:\n",
                *(f"      {variable}:\n" for variable in variables),
            ]
    return "".join(lines)


if __name__ == "__main__":
    FILE.write_text(text(), encoding="utf-8")
