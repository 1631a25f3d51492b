"""World files: the YAML that describes a world, checked on loading."""

from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    ValidationError,
    ValidationInfo,
    field_serializer,
    field_validator,
    model_validator,
)

from shared.yaml_reading import YamlFileError, read_yaml
from simulator.assets.folder import AssetFolder
from simulator.furniture.catalogue import FURNITURE
from simulator.textures.catalogue import KINDS

WORLDS = Path(__file__).resolve().parents[1] / "worlds"


class WorldFileError(ValueError):
    """A world file cannot be used; the message names file, place, expectation and value."""


def _interval(value: tuple[float, float]) -> tuple[float, float]:
    if not value[0] < value[1]:
        raise ValueError(f"must be [low, high] with low < high, got [{value[0]}, {value[1]}]")
    return value


def _texture(value: str) -> str:
    if value not in KINDS:
        raise ValueError(f"unknown texture kind {value!r}; choose from {', '.join(sorted(KINDS))}")
    return value


MOST_M = 500.0  # of any coordinate
MOST_SPAN_M = 250.0  # of a whole world
Metres = Annotated[float, Field(ge=-MOST_M, le=MOST_M)]
Degrees = Annotated[float, Field(ge=-3600.0, le=3600.0)]
Height = Annotated[float, Field(gt=0.0, le=30.0)]
Name = Annotated[str, Field(min_length=1, max_length=80)]
Interval = Annotated[tuple[Metres, Metres], AfterValidator(_interval)]
Seed = Annotated[int, Field(ge=0, lt=2**63)]
Channel = Annotated[int, Field(ge=0, le=255)]


class _Model(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Surface(_Model):
    """Texture, colour (RGB) and seed of a floor, wall or ceiling; `tile_m` is the side of one repeat.

    With `variants` above 1 repeats differ: each tile shows one of so many textures, from `seed` on.
    """

    texture: Annotated[str, AfterValidator(_texture)]
    colour: tuple[Channel, Channel, Channel]
    seed: Seed = 0
    tile_m: float = Field(default=4.0, ge=0.05, le=MOST_M)
    variants: int = Field(default=1, ge=1, le=16)


class Rectangle(_Model):
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
    """A rectangle of floor under the open sky; `border` runs along the edges that touch no other floor."""

    name: Name
    floor: Surface
    border: Border = "none"


class Sky(_Model):
    """Colours of the sky (RGB) above and at the horizon, and how much of it clouds cover (0 to 1)."""

    zenith: tuple[Channel, Channel, Channel] = (96, 142, 206)
    horizon: tuple[Channel, Channel, Channel] = (206, 220, 232)
    clouds: float = Field(default=0.4, ge=0.0, le=1.0)
    seed: Seed = 0


class Sun(_Model):
    """Where the sun stands (azimuth counter-clockwise from x) and how much light it gives (linear RGB)."""

    azimuth_deg: Degrees = 130.0
    elevation_deg: float = Field(default=48.0, ge=5.0, le=90.0)
    power: tuple[float, float, float] = (0.95, 0.9, 0.8)


class Item(_Model):
    """A piece of furniture: kind, position, heading of its front, height, seed, and options of that kind.

    Items with a `name` can be removed or moved while the world runs.
    """

    name: Name | None = None
    kind: str
    at_m: tuple[Metres, Metres]
    yaw_deg: Degrees = 0.0
    z_m: Metres = 0.0
    seed: Seed = 0
    options: dict[str, Any] = Field(default_factory=dict)

    @field_validator("options")
    @classmethod
    def _files_opened(cls, options: dict[str, Any], info: ValidationInfo) -> dict[str, Any]:
        kind = FURNITURE.get(info.data.get("kind", ""))
        return kind.opened(options, info.context) if kind else options

    @field_serializer("options", when_used="json")
    def _files_by_content(self, options: dict[str, Any]) -> dict[str, Any]:
        return {name: getattr(value, "digest", value) for name, value in options.items()}

    @model_validator(mode="after")
    def _known(self) -> Self:
        if self.kind not in FURNITURE:
            raise ValueError(
                f"unknown furniture kind {self.kind!r}; choose from {', '.join(sorted(FURNITURE))}"
            )
        FURNITURE[self.kind].check(self.options)
        return self


class Start(_Model):
    """Where the robot starts."""

    x_m: Metres
    y_m: Metres
    yaw_deg: Degrees = 0.0


class Lighting(_Model):
    """Even light that reaches everything, and how much of it corners lose (0 to 1)."""

    ambient: tuple[float, float, float] = (0.24, 0.235, 0.23)
    occlusion: float = Field(default=0.9, ge=0.0, le=1.0)


class WorldFile(_Model):
    """A whole world.

    Attributes:
        environment: which speeds, sensor ranges and thresholds suit it; no service reads it from here.
        sky, sun: of worlds with grounds; a sky is there whenever there is open ground.
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
    furniture: tuple[Item, ...] = Field(default=(), max_length=3000)
    start: Start

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
    path = Path(name_or_path)
    if path.suffix not in {".yaml", ".yml"}:
        path = WORLDS / f"{name_or_path}.yaml"
    if not path.is_file():
        raise WorldFileError(
            f"world must be one of {', '.join(world_names())} or a .yaml file; got {name_or_path!r}"
        )
    try:
        data = read_yaml(path)
    except YamlFileError as error:
        raise WorldFileError(f"{path}: {error}") from error
    if not isinstance(data, dict):
        raise WorldFileError(
            f"{path}: must be a mapping with format, name, rooms, start; got {type(data).__name__}"
        )
    try:
        return WorldFile.model_validate(data, context=AssetFolder(path.parent))
    except ValidationError as error:
        faults = "; ".join(
            f"{'.'.join(str(part) for part in e['loc']) or 'world'}: {e['msg']}" for e in error.errors()
        )
        raise WorldFileError(f"{path}: {faults}") from error
