"""The part of a Compose file that the launcher needs, as typed models."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

from services.launcher.compose.interpolate import interpolate_tree
from shared.yaml_reading import YamlFileError, read_yaml

UNIT_S = {"us": 1e-6, "ms": 1e-3, "s": 1.0, "m": 60.0, "h": 3600.0}
DURATION = re.compile(r"(?:\d+(?:\.\d+)?(?:us|ms|s|m|h))+\Z")
COMPOSE_FILE = Path(__file__).resolve().parents[3] / "docker-compose.yml"


def seconds_from_duration(value: object) -> object:
    """Read "1m30s" as 90.0; leaves what is no text to pydantic."""
    if not isinstance(value, str):
        return value
    if not DURATION.match(value):
        raise ValueError(f"a duration looks like 500ms, 5s or 1m30s, got {value!r}")
    return sum(float(number) * UNIT_S[unit] for number, unit in re.findall(r"([\d.]+)(us|ms|s|m|h)", value))


def _text_mapping(value: object) -> object:
    """Accept both forms, a mapping or a list of NAME=value; YAML's numbers and booleans become text."""
    if isinstance(value, list):
        value = dict(str(item).split("=", 1) for item in value)
    if isinstance(value, dict):
        return {
            key: str(item).lower() if isinstance(item, bool) else str(item) for key, item in value.items()
        }
    return value


def _dependencies(value: object) -> object:
    return {_name(name): {} for name in value} if isinstance(value, list) else value


def _name(value: object) -> str:
    if not isinstance(value, str):
        raise ValueError(f"must be the name of a service, got {value!r:.80}")
    return value


def _words(value: object) -> object:
    if isinstance(value, str):
        raise ValueError(f"must be a list of words, so that no shell is needed, got {value!r}")
    return value


Seconds = Annotated[float, BeforeValidator(seconds_from_duration), Field(ge=0)]


class Model(BaseModel):
    """Frozen; keys that only containers need are ignored."""

    model_config = ConfigDict(frozen=True, extra="ignore")


class Healthcheck(Model):
    """How to tell that a service is ready."""

    test: Annotated[tuple[str, ...], BeforeValidator(_words)]
    interval: Seconds = 30.0
    timeout: Seconds = 30.0
    start_period: Seconds = 0.0
    retries: int = 3


class Dependency(Model):
    """What has to hold for another service before this one starts."""

    condition: Literal["service_started", "service_healthy", "service_completed_successfully"] = (
        "service_started"
    )
    required: bool = True


class Service(Model):
    """One process."""

    command: Annotated[tuple[str, ...], BeforeValidator(_words), Field(min_length=1)]
    environment: Annotated[dict[str, str], BeforeValidator(_text_mapping)] = Field(default_factory=dict)
    depends_on: Annotated[dict[str, Dependency], BeforeValidator(_dependencies)] = Field(default_factory=dict)
    healthcheck: Healthcheck | None = None
    profiles: tuple[str, ...] = ()
    volumes: tuple[str, ...] = ()
    restart: str = "no"
    stop_grace_period: Seconds = 10.0


class Compose(Model):
    """The whole file."""

    services: dict[str, Service]
    volumes: dict[str, object] = Field(default_factory=dict)


def load_compose(path: Path, variables: Mapping[str, str]) -> Compose:
    """Read, interpolate and check a Compose file.

    Raises:
        ValueError: not readable as a Compose file; names the file and the field.
    """
    try:
        document = interpolate_tree(read_yaml(path), variables)
    except YamlFileError as error:
        raise ValueError(f"{path}: {error}") from error
    if not isinstance(document, dict) or "services" not in document:
        raise ValueError(f"{path}: expected a mapping with the key 'services'")
    return Compose.model_validate(document)
