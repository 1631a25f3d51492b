"""Settings read from the environment: typed, frozen, and a misspelt name is an error."""

import os
import sys
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import AfterValidator, BaseModel, BeforeValidator, ValidationError
from pydantic_core import ErrorDetails
from pydantic_settings import BaseSettings, NoDecode, SettingsConfigDict

from shared.transport.keys import check_robot

NESTED = "__"

OptionalPath = Annotated[Path | None, BeforeValidator(lambda path: None if path == "" else path)]
"""None also of a variable that Compose passes on without a value."""


RobotName = Annotated[str, AfterValidator(check_robot)]


def _listed(names: object) -> object:
    if not isinstance(names, str):
        return names
    return tuple(name.strip() for name in names.split(",")) if names.strip() else ()


def _each_once(names: tuple[str, ...]) -> tuple[str, ...]:
    for name in names:
        if names.count(check_robot(name)) > 1:
            raise ValueError(f"every robot must be named once, got {name!r} again")
    return names


RobotNames = Annotated[tuple[str, ...], NoDecode, BeforeValidator(_listed), AfterValidator(_each_once)]
"""Of several robots, as "r1,r2" in the environment; empty: of none."""


class ServiceSettings(BaseSettings):
    """Base of every service's settings. A subclass sets `env_prefix`, for example "DRIVE_".

    Attributes:
        endpoint: Zenoh router to reach, from TOPNAV_ENDPOINT.
        listen: where other peers reach this process, from TOPNAV_LISTEN.
        certs: folder of a certificate for the secured bus, from TOPNAV_CERTS; none, or empty: not secured.
        robot: whose service this is, from TOPNAV_ROBOT.
        log_level: DEBUG, INFO, WARNING or ERROR, from TOPNAV_LOG_LEVEL.
    """

    model_config = SettingsConfigDict(frozen=True, extra="forbid", env_nested_delimiter=NESTED)

    endpoint: str = "tcp/127.0.0.1:7447"
    listen: str = "tcp/127.0.0.1:0"
    certs: OptionalPath = None
    robot: RobotName = "r1"
    log_level: str = "INFO"

    @classmethod
    def from_environment(cls) -> Self:
        """Read the environment.

        Raises:
            ValueError: a variable with this service's prefix that no setting has, or a bad value.
        """
        prefix = str(cls.model_config.get("env_prefix") or "")
        known = set(cls.model_fields)
        for variable in os.environ:
            if prefix and variable.startswith(prefix):
                path = variable[len(prefix) :].lower().split(NESTED)
                if not _leads_somewhere(cls, path):
                    raise ValueError(f"{variable}: no such setting; {prefix}* may be one of {sorted(known)}")
        shared: dict[str, Any] = {
            field: os.environ[f"TOPNAV_{field.upper()}"]
            for field in ServiceSettings.model_fields
            if f"TOPNAV_{field.upper()}" in os.environ and f"{prefix}{field.upper()}" not in os.environ
        }
        try:
            return cls(**shared)
        except ValidationError as error:
            raise ValueError("; ".join(_told(prefix, fault) for fault in error.errors())) from None

    @classmethod
    def of_service(cls, service: str) -> Self:
        """Read the environment; a service whose settings are wrong ends with one line and exit code 2."""
        try:
            return cls.from_environment()
        except ValueError as error:
            sys.stderr.write(f"{service}: {error}\n")
            sys.exit(2)


def _told(prefix: str, fault: ErrorDetails) -> str:
    """One fault under the name of its variable; what came is left out, as it may be a secret."""
    why = str(fault["msg"]).removeprefix("Value error, ")
    path = [str(part) for part in fault["loc"]]
    if not path:
        return why
    shared = path[0] in ServiceSettings.model_fields and f"{prefix}{path[0].upper()}" not in os.environ
    return f"{'TOPNAV_' if shared else prefix}{NESTED.join(path).upper()}: {why}"


def _leads_somewhere(model: type[BaseModel], path: list[str]) -> bool:
    """Whether `path` names a setting, through the fields of nested models where there are any."""
    field = model.model_fields.get(path[0])
    if field is None:
        return False
    inner = field.annotation
    if len(path) == 1 or not (isinstance(inner, type) and issubclass(inner, BaseModel)):
        return True
    return _leads_somewhere(inner, path[1:])
