"""Parts: the simple solids of which worlds are made. Pure; rendering, physics and sensors read them."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
import numpy.typing as npt

from shared.geometry.perspective import rotation_y, rotation_z
from simulator.scene.meshes import Mesh

Span = tuple[float, float]
Pose2 = tuple[float, float, float]
"""Position on the floor (metres) and heading (radians)."""
Vec3 = tuple[float, float, float]
Rgb = tuple[int, int, int]
Shape = Literal["box", "cylinder", "ellipsoid", "cushion", "drape", "leaf", "mesh", "hull"]


@dataclass(frozen=True)
class Picture:
    """Texture from a file: (height, width, 3) RGB bytes, row 0 at the top. The digest is the identity.

    A fourth channel of 0 or 255 says where there are holes. `source` is the bytes, or makes them.
    """

    digest: str
    source: npt.NDArray[np.uint8] | Callable[[], npt.NDArray[np.uint8]] = field(compare=False, repr=False)

    @property
    def pixels(self) -> npt.NDArray[np.uint8]:
        """The bytes; decoded at each call where they are packed."""
        return self.source() if callable(self.source) else self.source


@dataclass(frozen=True)
class Geometry:
    """Triangles from a file, in the frame of their part. The digest is the identity."""

    digest: str
    mesh: Mesh = field(compare=False, repr=False)


@dataclass(frozen=True)
class Material:
    """Look of a surface: texture kind (see textures.catalogue), colour, seed; above 0, `glow` shines.

    A `picture` takes the place of the drawn texture.
    """

    kind: str
    colour: Rgb = (200, 200, 200)
    seed: int = 0
    glow: float = 0.0
    picture: Picture | None = None


@dataclass(frozen=True)
class Part:
    """One solid in some frame (x forward, y left, z up; metres, radians).

    Attributes:
        shape: cylinders stand along local z, `taper` is top radius / bottom radius; cushions are boxes with
            round edges; a drape is a waved sheet in local y-z; a leaf is a bent sheet along local x; a mesh
            shows its `geometry`; a hull is an invisible upright prism that only stops the robot.
        centre_m: centre of the bounding box.
        size_m: full extent along the local axes.
        yaw_rad: rotation about z; pitch_rad and roll_rad come first (leaves and hanging things only).
        solid: whether it stops the robot. Solid parts have neither pitch nor roll.
        tile_m: side of one texture repeat; None stretches the texture over each face.
        uv: part of the texture used when stretched: u0, v0, u1, v1 with v = 0 at the top.
        geometry: triangles of a mesh, around its centre.
        outline_m: corners of a hull around its centre, convex, counter-clockwise from above.
        grain_m: how densely a box carries light; None leaves it to its size.
        texture_at_m: the place that decides which region of a tiled texture is shown; None: its centre.
    """

    shape: Shape
    centre_m: Vec3
    size_m: Vec3
    material: Material
    yaw_rad: float = 0.0
    pitch_rad: float = 0.0
    roll_rad: float = 0.0
    solid: bool = True
    tile_m: float | None = 0.6
    uv: tuple[float, float, float, float] = (0.0, 0.0, 1.0, 1.0)
    taper: float = 1.0
    casts_shadow: bool = True
    geometry: Geometry | None = None
    outline_m: tuple[tuple[float, float], ...] = ()
    grain_m: float | None = None
    texture_at_m: Vec3 | None = None


@dataclass(frozen=True)
class Light:
    """An area that shines: `facing` None shines evenly all round, else with the cosine to that direction.

    What is within `clear_m` of it casts no shadow: the shade of a lamp that a model brings.
    """

    centre_m: Vec3
    size_m: Vec3
    power: tuple[float, float, float]
    facing: Vec3 | None = None
    clear_m: float = 0.0


@dataclass(frozen=True)
class Piece:
    """What one piece of furniture is made of."""

    parts: tuple[Part, ...]
    lights: tuple[Light, ...] = ()

    @classmethod
    def of(cls, *parts: Part) -> "Piece":
        """A piece that does not shine."""
        return cls(parts)


Contents = tuple[tuple[Part, ...], tuple[Light, ...]]
"""All parts and lights of a world, see world.contents.expand."""


def moved(piece: Piece, x_m: float, y_m: float, yaw_rad: float, z_m: float = 0.0) -> Piece:
    """Place a piece given in its own frame at a pose in the world."""
    rotation = rotation_z(yaw_rad)
    shift = np.array([x_m, y_m, z_m])

    def point(p: Vec3) -> Vec3:
        x, y, z = (rotation @ np.array(p) + shift).tolist()
        return x, y, z

    def direction(d: Vec3 | None) -> Vec3 | None:
        if d is None:
            return None
        x, y, z = (rotation @ np.array(d)).tolist()
        return x, y, z

    parts = tuple(replace(p, centre_m=point(p.centre_m), yaw_rad=p.yaw_rad + yaw_rad) for p in piece.parts)
    lights = tuple(
        replace(light, centre_m=point(light.centre_m), facing=direction(light.facing),
                size_m=tuple(np.abs(rotation @ np.array(light.size_m)).tolist()))
        for light in piece.lights
    )  # fmt: skip
    return Piece(parts, lights)


def rotation_of(part: Part) -> npt.NDArray[np.float64]:
    """Rotation from the part's axes to its frame: yaw * pitch * roll, (3, 3)."""
    cr, sr = np.cos(part.roll_rad), np.sin(part.roll_rad)
    roll = np.array([[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]])
    return np.asarray(rotation_z(part.yaw_rad) @ rotation_y(part.pitch_rad) @ roll)


def solids_between(parts: Iterable[Part], low_m: float, high_m: float) -> list[Part]:
    """The solid parts that reach into a band of heights."""
    return [
        p
        for p in parts
        if p.solid and p.centre_m[2] + p.size_m[2] / 2 > low_m and p.centre_m[2] - p.size_m[2] / 2 < high_m
    ]
