"""Profiles from a file: a named one with other thresholds, as `topnav calibrate --write` leaves it."""

import json
from pathlib import Path

from pydantic import BaseModel, ConfigDict, ValidationError

from services.planner.profiles import Profile, profile_named


class ProfileFile(BaseModel):
    """The file.

    Attributes:
        base: the named profile it starts from.
        thresholds: fields of that profile with other values.
        measured: how they were found; for people.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")
    base: str
    thresholds: dict[str, float]
    measured: dict[str, float | int | str] = {}


def profile_of_file(path: Path) -> Profile:
    """The profile that a file describes.

    Raises:
        ValueError: it cannot be read, is no such file, or has a threshold that profiles lack or refuse.
    """
    found = _read(path)
    base = profile_named(found.base)
    try:
        return base.replaced(**found.thresholds)
    except ValidationError as error:
        faults = "; ".join(f"{'.'.join(map(str, e['loc']))}: {e['msg']}" for e in error.errors())
        raise ValueError(f"profile file {path}: {faults}") from error


def _read(path: Path) -> ProfileFile:
    try:
        return ProfileFile.model_validate(json.loads(path.read_text(encoding="utf-8")))
    except OSError as error:
        raise ValueError(f"profile file {path}: {error.strerror or error}") from error
    except (ValueError, RecursionError) as error:
        raise ValueError(
            f"profile file {path}: not one of 'topnav calibrate --write' makes: {error}"
        ) from error
