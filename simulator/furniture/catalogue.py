"""Furniture kinds by name: every function in this folder that makes a `Piece`.

Its keyword arguments, with defaults, are the options of the kind. What no furniture needs is refused before
anything is built.
"""

import inspect
import math
import pkgutil
import reprlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from importlib import import_module
from typing import Any, Literal

import numpy as np
from pydantic import ConfigDict, ValidationError, validate_call

from simulator import furniture
from simulator.assets.folder import AssetFolder
from simulator.scene.parts import Piece

# Bounds on what a world file may ask for: untrusted input. All chosen, several times what our worlds have.
MOST_NUMBER = 1000.0
MOST_COUNT = 200  # shelves, doors, leaves
MOST_LENGTH_M = 100.0
MOST_VALUES = 100
MOST_TEXT = 200
MOST_DEPTH = 3
MOST_PARTS = 20_000  # the outlines of a floor of offices
MOST_SIZE_M = 400.0

FileKind = Literal["model", "picture"]


@dataclass(frozen=True)
class Kind:
    """One kind of furniture."""

    name: str
    function: Callable[..., Piece]
    files: Mapping[str, FileKind] = field(default_factory=dict)
    """Options that name files; "collision.file": the key `file` of a mapping."""

    def options(self) -> list[str]:
        """Names of its options."""
        return [name for name in inspect.signature(self.function).parameters if name != "rng"]

    def opened(self, options: dict[str, Any], folder: AssetFolder | None) -> dict[str, Any]:
        """Put what the files hold in place of their names.

        Raises:
            ValueError: there is no folder to read from, or a file cannot be used.
        """
        read = dict(options)
        for path, kind in self.files.items():
            outer, _, name = path.rpartition(".")
            inner = read.get(outer)
            holder = read if not outer else dict(inner) if isinstance(inner, dict) else {}
            value = holder.get(name)
            if not isinstance(value, str):
                continue
            if folder is None:
                raise ValueError(f"{self.name}.{path}: files are found beside a world file; use load_world")
            try:
                holder[name] = folder.model(value) if kind == "model" else folder.picture(value)
            except ValueError as error:
                raise ValueError(f"{self.name}.{path}: {error}") from error
            if outer:
                read[outer] = holder
        return read

    def check(self, options: dict[str, Any]) -> None:
        """Raise ValueError if an option is unknown or does not fit."""
        known = self.options()
        unknown = sorted(str(name) for name in set(options) - set(known))
        if unknown:
            raise ValueError(
                f"{self.name} has no option {', '.join(unknown)[:80]}; it has {', '.join(known) or 'none'}"
            )
        for name, value in options.items():
            _check_value(f"{self.name} options: {name}", value)
        try:
            with np.errstate(divide="raise", invalid="raise"):
                piece = self.build(options, 0)
        except ValidationError as error:
            faults = "; ".join(
                f"{e['loc'][0]}: {e['msg']}, got {_short(e['input'])}" for e in error.errors() if e["loc"]
            )
            raise ValueError(f"{self.name} options: {faults or error}") from error
        except (ArithmeticError, LookupError, TypeError, ValueError) as error:
            raise ValueError(f"{self.name} cannot be built with these options: {error}") from error
        self._check_piece(piece)

    @cached_property
    def _checked(self) -> Callable[..., Piece]:
        return validate_call(config=ConfigDict(arbitrary_types_allowed=True))(self.function)

    def _check_piece(self, piece: Piece) -> None:
        numbers = [v for part in piece.parts for v in (*part.size_m, *part.centre_m)]
        if len(piece.parts) > MOST_PARTS or not np.isfinite(numbers).all():
            raise ValueError(f"{self.name} must have at most {MOST_PARTS} parts, all of finite size")
        if any(not 0.0 <= side <= MOST_SIZE_M for part in piece.parts for side in part.size_m):
            raise ValueError(f"{self.name} options: sizes must be 0 to {MOST_SIZE_M:g} m; check its options")

    def build(self, options: dict[str, Any], seed: int) -> Piece:
        """Make the piece in its own frame: origin on the floor (or at its anchor), front along +x."""
        return self._checked(np.random.default_rng([seed, *self.name.encode()]), **options)


def _check_value(name: str, value: object, depth: int = 0) -> None:
    """Raise ValueError if an option holds a number out of bounds, or too much."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        if not (math.isfinite(value) and abs(value) <= MOST_NUMBER):
            raise ValueError(f"{name}: must be a number within +-{MOST_NUMBER:g}, got {_short(value)}")
        if depth == 0 and isinstance(value, int) and abs(value) > MOST_COUNT:
            raise ValueError(f"{name}: must be at most {MOST_COUNT}, got {_short(value)}")
        if name.endswith("_m") and not 0 <= value <= MOST_LENGTH_M:
            raise ValueError(f"{name}: must be a length of 0 to {MOST_LENGTH_M:g} m, got {_short(value)}")
    elif isinstance(value, str):
        if len(value) > MOST_TEXT:
            raise ValueError(f"{name}: must have at most {MOST_TEXT} characters, got {len(value)}")
    elif isinstance(value, list | tuple | dict):
        if len(value) > MOST_VALUES or depth > MOST_DEPTH:
            raise ValueError(f"{name}: must hold at most {MOST_VALUES} values, got {_short(value)}")
        for one in value.values() if isinstance(value, dict) else value:
            _check_value(name, one, depth + 1)


def _short(value: object) -> str:
    """Representation of a value, cut to a line."""
    return reprlib.repr(value)[:80]


def _kinds() -> dict[str, Kind]:
    """All functions beside this file that make a `Piece`; FILES of a module are options that name files."""
    found = {}
    for entry in pkgutil.iter_modules(furniture.__path__):
        if entry.name == "catalogue":
            continue
        module = import_module(f"{furniture.__name__}.{entry.name}")
        for name, function in inspect.getmembers(module, inspect.isfunction):
            own = function.__module__ == module.__name__
            if own and inspect.signature(function).return_annotation is Piece:
                found[name] = Kind(name, function, getattr(module, "FILES", {}))
    return found


FURNITURE = _kinds()
