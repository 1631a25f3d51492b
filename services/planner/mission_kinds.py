"""Kinds of missions: what a robot can be asked to do, one module of `services/planner/missions` each.

A module there defines `KIND = MissionKind(...)`; a file in the folder that PLANNER_MISSIONS_FOLDER names does
the same. Wire, gateway, records, console and command line know kinds by name only and read the rest from
here.
"""

import importlib.util
import pkgutil
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any, Generic, TypeVar

import numpy as np
from pydantic import BaseModel, ConfigDict, ValidationError

from services.planner import missions
from services.planner.ports import Inspector, MapAccess, Matcher, Mission
from services.planner.profiles import Profile
from services.planner.travel.whereabouts import Whereabouts
from shared.messages.features import Features
from shared.messages.missions import CONTROLS, FailureKind, MissionKindInfo

P = TypeVar("P", bound=BaseModel)


class MissionError(ValueError):
    """A request that cannot be followed; the text goes to the asker.

    Attributes:
        code: one of `shared.queries.REASONS`.
    """

    def __init__(self, text: str, code: str = "invalid") -> None:
        super().__init__(text)
        self.code = code

    @property
    def failure(self) -> FailureKind:
        """How a mission under way ends that meets it: its goal is forbidden, or not there any more."""
        return "forbidden" if self.code == "forbidden" else "goal_not_in_map"


class NoParameters(BaseModel):
    """Of a mission that needs none."""

    model_config = ConfigDict(frozen=True, extra="forbid")


@dataclass(frozen=True)
class MissionContext:
    """What a mission works with.

    Attributes:
        goal: features of the picture that came with the request.
        rng: seeded by the request.
        whereabouts: where the mission before left the robot; None where nobody knows.
        inspector: looks at places for what changed there; None where nobody can.
        checkpoint: the last one of the same mission, where a planner before had got to; else empty.
    """

    profile: Profile
    maps: MapAccess
    matcher: Matcher
    rng: np.random.Generator
    goal: Features | None = None
    whereabouts: Whereabouts | None = None
    inspector: Inspector | None = None
    checkpoint: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class MissionKind(Generic[P]):
    """One kind.

    Attributes:
        name: on the wire, in URLs and records.
        title: for people, as on a button.
        parameters: their names, types, defaults and descriptions.
        make: the mission; MissionError where it cannot be.
        shown: figures of the status that its record shows, by their names there.
        makes_map: whether a map that is missing is made.
        takes_picture: whether a goal picture may come with the request.
        by_hand: whether it goes along with a person who drives, and ends when told to `finish`; such a
            mission is `Accompanying`.
    """

    name: str
    title: str
    parameters: type[P]
    make: Callable[[MissionContext, P], Mission]
    shown: tuple[str, ...] = ()
    makes_map: bool = False
    takes_picture: bool = False
    by_hand: bool = False

    def start(self, context: MissionContext, values: Mapping[str, Any]) -> Mission:
        """A mission of this kind.

        Raises:
            MissionError: parameters that it does not have or refuses, a picture that it does not take, or a
                checkpoint that is none of its own.
        """
        if context.goal is not None and not self.takes_picture:
            raise MissionError(f"{self.name} takes no goal picture")
        try:
            wanted = self.parameters.model_validate(dict(values))
        except ValidationError as error:
            faults = "; ".join(f"{'.'.join(map(str, e['loc']))}: {e['msg']}" for e in error.errors())
            raise MissionError(f"parameters of {self.name}: {faults}") from None
        try:
            return self.make(context, wanted)
        except ValidationError as error:  # of its checkpoint: another program had other words for it
            why = f"{self.name} cannot go on from {dict(context.checkpoint)}: {error.error_count()} errors"
            raise MissionError(why) from None

    def info(self) -> MissionKindInfo:
        """What other processes need to know of it."""
        return MissionKindInfo(
            name=self.name,
            title=self.title,
            parameters=self.parameters.model_json_schema(),
            shown=self.shown,
            takes_picture=self.takes_picture,
            by_hand=self.by_hand,
        )


class MissionKinds:
    """All kinds by name."""

    def __init__(self, kinds: Iterable[MissionKind[Any]]) -> None:
        self._kinds: dict[str, MissionKind[Any]] = {}
        for kind in kinds:
            if kind.name in self._kinds or kind.name in CONTROLS:
                raise ValueError(f"mission kind {kind.name!r} is taken: choose another name")
            self._kinds[kind.name] = kind

    def __getitem__(self, name: str) -> MissionKind[Any]:
        if name not in self._kinds:
            raise MissionError(
                f"unknown mission {name!r}, this planner knows {', '.join(sorted(self._kinds))}"
            )
        return self._kinds[name]

    def infos(self) -> tuple[MissionKindInfo, ...]:
        """Of all kinds, by name."""
        return tuple(self._kinds[name].info() for name in sorted(self._kinds))


def mission_kinds(folder: Path | None = None) -> MissionKinds:
    """The kinds of `services/planner/missions` and of the files in `folder`.

    Raises:
        ValueError: a file of `folder` that is no mission, or two kinds of one name.
    """
    names = (found.name for found in pkgutil.iter_modules(missions.__path__, f"{missions.__name__}."))
    modules = [import_module(name) for name in names]
    modules += [_imported(path) for path in sorted(folder.glob("*.py"))] if folder is not None else []
    return MissionKinds(_kind_of(module) for module in modules)


def _imported(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"topnav_mission_{path.stem}", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        raise ValueError(f"mission file {path}: {type(error).__name__}: {error}") from error
    return module


def _kind_of(module: ModuleType) -> MissionKind[Any]:
    kind = getattr(module, "KIND", None)
    if not isinstance(kind, MissionKind):
        raise ValueError(f"{module.__file__}: a mission must define KIND = MissionKind(...)")
    return kind
