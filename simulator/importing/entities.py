"""What a world to be imported consists of, wherever it was read from, and what is wrong with it. Pure."""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Rgb = tuple[float, float, float]
Rgba = tuple[float, float, float, float]
Vec3 = tuple[float, float, float]


class WorldImportError(ValueError):
    """A world cannot be imported; the message says which file, what was expected, what came, what to do."""


class MissingFileError(WorldImportError):
    """A file that a world names is nowhere: the rest can be imported without it."""


@dataclass(frozen=True)
class Primitive:
    """A solid by its measures, metres: box (x, y, z), cylinder (radius, height along z), sphere (radius,)."""

    kind: Literal["box", "cylinder", "sphere"]
    size_m: tuple[float, ...]


@dataclass(frozen=True)
class Drawn:
    """A texture that is drawn here, in place of one that a simulator brings with itself."""

    kind: str
    colour: tuple[int, int, int]


@dataclass(frozen=True)
class Paint:
    """What a world says of a shape's looks, over what its file says.

    Attributes:
        colour: RGB and opacity, 0 to 1; None leaves that of the file.
        picture: a file, or a texture to be drawn; None leaves that of the file.
        opacity: a factor, 0 to 1.
        two_sided: whether backs are seen too.
    """

    colour: Rgba | None = None
    picture: Path | Drawn | None = None
    opacity: float = 1.0
    two_sided: bool = False


@dataclass(frozen=True)
class Shape:
    """Something seen or felt.

    Attributes:
        source: a mesh file, or a primitive.
        pose: in the frame of its body, (4, 4), metres.
        name: within its body.
        scale: along the axes of the source.
        paint: its looks.
        node: of a mesh file, the name of the one node that is meant; None is all of it.
    """

    source: Path | Primitive
    pose: FloatArray
    name: str = ""
    scale: Vec3 = (1.0, 1.0, 1.0)
    paint: Paint = Paint()
    node: str | None = None

    def key(self) -> tuple[object, ...]:
        """Equal for shapes that are the same thing at the same place."""
        return str(self.source), self.pose.round(6).tobytes(), self.scale, repr(self.paint), self.node


@dataclass(frozen=True)
class Body:
    """What holds together: a link of a model.

    Attributes:
        name: within its entity.
        pose: in the frame of its entity, (4, 4), metres.
        seen, felt: what the camera sees of it, and what stops the robot; in its own frame.
        lost: whether a part that would be seen is missing.
    """

    name: str
    pose: FloatArray
    seen: tuple[Shape, ...]
    felt: tuple[Shape, ...]
    lost: bool = False


@dataclass(frozen=True)
class Entity:
    """A thing that stands somewhere: one model of the world.

    Attributes:
        name: in the world.
        model: what it is one of; "" where it is the only one.
        pose: in the world, (4, 4), metres.
        bodies: its links.
        jointed: whether joints hold them together.
    """

    name: str
    model: str
    pose: FloatArray
    bodies: tuple[Body, ...]
    jointed: bool = False


@dataclass(frozen=True)
class Lamp:
    """A light at a place, metres; `power` as of `scene.parts.Light`, linear RGB."""

    at_m: Vec3
    power: Rgb


@dataclass(frozen=True)
class Sunshine:
    """Parallel light: the direction it comes from (a vector that points at the sun), linear RGB power."""

    towards: Vec3
    power: Rgb


@dataclass(frozen=True)
class Scene:
    """All of a world.

    Attributes:
        entities, lamps: in the order of the file.
        sun: parallel light.
        plane_m: height of an endless floor that is part of it.
        ambient: even light, 0 to 1; None where the file does not say.
        background: colour behind everything; None is a sky.
        left_out: what cannot be shown, one line each.
    """

    entities: tuple[Entity, ...]
    lamps: tuple[Lamp, ...] = ()
    sun: Sunshine | None = None
    plane_m: float | None = None
    ambient: Rgb | None = None
    background: Rgb | None = None
    left_out: tuple[str, ...] = ()


def identity() -> FloatArray:
    """A pose that moves nothing, (4, 4)."""
    return np.eye(4)
