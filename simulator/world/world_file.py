"""World files: the YAML that describes a world, checked on loading."""

from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import AfterValidator, Field, ValidationError, ValidationInfo, field_validator, model_validator

from shared.yaml_reading import YamlFileError, read_yaml
from simulator.assets.folder import AssetFolder
from simulator.cache_folder import user_cache
from simulator.textures.catalogue import KINDS
from simulator.world.fields import MOST_M, Channel, Degrees, FileModel, Height, Interval, Metres, Name, Seed
from simulator.world.items import MOST_ITEMS, Item, Placement, placed_items

WORLDS = Path(__file__).resolve().parents[1] / "worlds"


class WorldFileError(ValueError):
    """A world file cannot be used; the message names file, place, expectation and value."""


def _texture(value: str) -> str:
    if value not in KINDS:
        raise ValueError(f"unknown texture kind {value!r}; choose from {', '.join(sorted(KINDS))}")
    return value


MOST_SPAN_M = 250.0  # of a whole world


class Surface(FileModel):
    """Texture, colour (RGB) and seed of a floor, wall or ceiling; `tile_m` is the side of one repeat.

    With `variants` above 1 repeats differ: each tile shows one of so many textures, from `seed` on.
    """

    texture: Annotated[str, AfterValidator(_texture)]
    colour: tuple[Channel, Channel, Channel]
    seed: Seed = 0
    tile_m: float = Field(default=4.0, ge=0.05, le=MOST_M)
    variants: int = Field(default=1, ge=1, le=16)


class Rectangle(FileModel):
    """An axis-parallel piece of floor."""

    x_m: Interval
    y_m: Interval


class Room(Rectangle):
    """A rectangle of floor with walls round it. Rooms that touch are open towards each other."""

    name: Name
    floor: Surface
    walls: Surface
    ceiling: Surface
    height_m: Height | None = None


class Opening(Rectangle):
    """A passage through the walls between two rooms: the rectangle of floor inside the wall."""

    height_m: Height = 2.1
    floor: Surface


Border = Literal["none", "fence", "barrier", "sidewalk", "wall"]


class Ground(Rectangle):
    """A rectangle of floor under the open sky; `border` runs along the edges that touch no other floor.

    Without `floor` nothing is shown: furniture brings the floor with it, and there is floor only where some
    of it lies level at height 0, see world.brought_floor.
    """

    name: Name
    floor: Surface | None = None
    border: Border = "none"


class Sky(FileModel):
    """Colours of the sky (RGB) above and at the horizon, and how much of it clouds cover (0 to 1)."""

    zenith: tuple[Channel, Channel, Channel] = (96, 142, 206)
    horizon: tuple[Channel, Channel, Channel] = (206, 220, 232)
    clouds: float = Field(default=0.4, ge=0.0, le=1.0)
    seed: Seed = 0


class Sun(FileModel):
    """Where the sun stands (azimuth counter-clockwise from x) and how much light it gives (linear RGB)."""

    azimuth_deg: Degrees = 130.0
    elevation_deg: float = Field(default=48.0, ge=5.0, le=90.0)
    power: tuple[float, float, float] = (0.95, 0.9, 0.8)


class Start(FileModel):
    """Where the robot starts."""

    x_m: Metres
    y_m: Metres
    yaw_deg: Degrees = 0.0


class Lighting(FileModel):
    """Even light that reaches everything, and how much of it corners lose (0 to 1)."""

    ambient: tuple[float, float, float] = (0.24, 0.235, 0.23)
    occlusion: float = Field(default=0.9, ge=0.0, le=1.0)


class Generated(FileModel):
    """Where a world that nobody drew comes from, and what it is for: building, or judging what was built."""

    kind: Name
    seed: Seed
    size: Name
    split: Literal["development", "validation", "test"]


class WorldFile(FileModel):
    """A whole world.

    Attributes:
        environment: which speeds, sensor ranges and thresholds suit it; no service reads it from here.
        sky, sun: of worlds with grounds; a sky is there whenever there is open ground.
        groups, placed: furniture that is there more than once; its copies follow the world's own furniture,
            and what is read from them is not written again.
        generated: of a world that nobody drew; nothing in the world depends on it.
        alike: whether what is equal looks equal to the last grain, light included. Otherwise each piece shows
            another part of its textures, as real wood does.
    """

    format: Literal["topnav-world/1"]
    name: Name
    environment: Literal["indoor", "outdoor"] = "indoor"
    sky: Sky | None = None
    sun: Sun | None = None
    wall_height_m: Height = 2.6
    wall_thickness_m: float = Field(default=0.075, ge=0.01, le=5.0)
    lighting: Lighting = Lighting()
    rooms: tuple[Room, ...] = Field(default=(), max_length=200)
    grounds: tuple[Ground, ...] = Field(default=(), max_length=200)
    openings: tuple[Opening, ...] = Field(default=(), max_length=400)
    groups: dict[Name, tuple[Item, ...]] = Field(default_factory=dict, max_length=200, exclude=True)
    placed: tuple[Placement, ...] = Field(default=(), max_length=MOST_ITEMS, exclude=True)
    generated: Generated | None = None
    alike: bool = False
    furniture: tuple[Item, ...] = Field(default=(), max_length=MOST_ITEMS, validate_default=True)
    start: Start

    @field_validator("furniture")
    @classmethod
    def _with_groups(cls, furniture: tuple[Item, ...], info: ValidationInfo) -> tuple[Item, ...]:
        if not {"groups", "placed"} <= info.data.keys():
            return furniture  # they have faults of their own
        copies = placed_items(info.data["groups"], info.data["placed"], info.context)
        if len(furniture) + len(copies) > MOST_ITEMS:
            raise ValueError(f"must be at most {MOST_ITEMS}, got {len(furniture)} and {len(copies)} placed")
        return (*furniture, *copies)

    def rectangles(self) -> list[tuple[tuple[float, float], tuple[float, float]]]:
        """All floor: the x and y intervals of rooms, openings and grounds."""
        floors: list[Rectangle] = [*self.rooms, *self.openings, *self.grounds]
        return [(floor.x_m, floor.y_m) for floor in floors]

    def holds(self, x_m: float, y_m: float) -> bool:
        """Whether a point lies inside a room, an opening or a ground."""
        return any(x[0] < x_m < x[1] and y[0] < y_m < y[1] for x, y in self.rectangles())

    @model_validator(mode="after")
    def _has_floor(self) -> Self:
        if not (self.rooms or self.grounds):
            raise ValueError("the world needs at least one room or one ground, got neither")
        names = [item.name for item in self.furniture if item.name is not None]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise ValueError(f"names of furniture must be unique; twice: {', '.join(twice)}")
        return self

    @model_validator(mode="after")
    def _not_vast(self) -> Self:
        for axis in (0, 1):
            low = min(rect[axis][0] for rect in self.rectangles())
            high = max(rect[axis][1] for rect in self.rectangles())
            if high - low > MOST_SPAN_M:
                raise ValueError(f"the world must be at most {MOST_SPAN_M:g} m wide, got {high - low:g} m")
        return self

    @model_validator(mode="after")
    def _start_inside(self) -> Self:
        s = self.start
        if not self.holds(s.x_m, s.y_m):
            raise ValueError(
                f"start ({s.x_m}, {s.y_m}) must lie inside one of the rooms or grounds "
                f"{[r.name for r in self.rooms] + [g.name for g in self.grounds]}"
            )
        return self


def world_names() -> list[str]:
    """Names of the worlds that come with the simulator."""
    return sorted(path.stem for path in WORLDS.glob("*.yaml"))


def load_world(name_or_path: str) -> WorldFile:
    """Load a world by its name, or by the path of a YAML file.

    Raises:
        WorldFileError: no such world, not YAML, or a value that does not fit; all faults are listed.
    """
    path = world_path(name_or_path)
    return world_of(path, read_contents(path))


def world_path(name_or_path: str) -> Path:
    """The file of a world, by its name or path; raises WorldFileError where there is none."""
    path = Path(name_or_path)
    if path.suffix not in {".yaml", ".yml"}:
        path = WORLDS / f"{name_or_path}.yaml"
    if not path.is_file():
        raise WorldFileError(
            f"world must be one of {', '.join(world_names())} or a .yaml file; got {name_or_path!r}"
        )
    return path


def read_contents(path: Path) -> dict[str, Any]:
    """What a world file says, unchecked; raises WorldFileError where it is no mapping."""
    try:
        data = read_yaml(path)
    except YamlFileError as error:
        raise WorldFileError(f"{path}: {error}") from error
    if not isinstance(data, dict):
        raise WorldFileError(
            f"{path}: must be a mapping with format, name, rooms, start; got {type(data).__name__}"
        )
    return data


def world_of(path: Path, contents: dict[str, Any], assets: AssetFolder | None = None) -> WorldFile:
    """The world of a file's contents; models and pictures are read from its folder, or were by `assets`.

    Raises:
        WorldFileError: values that do not fit, all of them.
    """
    try:
        return WorldFile.model_validate(contents, context=assets or AssetFolder(path.parent, user_cache()))
    except ValidationError as error:
        faults = "; ".join(
            f"{'.'.join(str(part) for part in e['loc']) or 'world'}: {e['msg']}" for e in error.errors()
        )
        raise WorldFileError(f"{path}: {faults}") from error
