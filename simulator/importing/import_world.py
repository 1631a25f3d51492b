"""Other people's worlds -> a folder with a world file and its models."""

import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from simulator.generation.world_text import as_yaml
from simulator.importing.contents import Contents, Thing, world_contents
from simulator.importing.entities import Scene, Vec3, WorldImportError
from simulator.importing.floor import Floor, find_floor
from simulator.importing.gltf_scene import read_gltf
from simulator.importing.meshes.entity_surfaces import EntitySurfaces
from simulator.importing.model_files import FOLDER, ModelFiles
from simulator.importing.sdf.resources import Resources
from simulator.importing.sdf.world import read_sdf
from simulator.importing.starts import find_start
from simulator.world.world_file import WorldFile, WorldFileError, load_world

SDF, GLTF = {".world", ".sdf"}, {".glb", ".gltf"}
MOST_NAMED = 5  # of missing files, in one message
WALL_M = 0.6  # floor beyond what the robot reaches; chosen: its radius and a wall
Progress = Callable[[str, int, int], None]
"""What is being done, how much of it is done, and how much there is."""


@dataclass(frozen=True)
class Imported:
    """A world that was written.

    Attributes:
        path: of the world file.
        world: as read back.
        notes: what was left out or replaced, one line each.
    """

    path: Path
    world: WorldFile
    notes: tuple[str, ...]


def import_world(
    source: Path,
    into: Path,
    models: Sequence[Path] = (),
    start: Vec3 | None = None,
    leave_out: bool = False,
    progress: Progress = lambda *_: None,
) -> Imported:
    """Write a world file and its models into a folder.

    Args:
        source: a Gazebo world, .world or .sdf, or a scene, .glb or .gltf.
        into: folder to write; the world file of its name and models in it are replaced.
        models: where else models are looked for.
        start: x, y (metres) and heading (degrees) of the robot, in the frame of `source`.
        leave_out: go on without models that are missing or broken.
        progress: told what is being done.

    Raises:
        WorldImportError: it cannot be imported; the message names file, what was expected and what came.
    """
    surfaces = EntitySurfaces()
    scene, missing = _scene(source, models, surfaces)
    if missing and not leave_out:
        raise WorldImportError(_missing(source, missing))
    into.parent.mkdir(parents=True, exist_ok=True)
    name = f"{into.resolve().name}.yaml"
    with tempfile.TemporaryDirectory(dir=into.parent, prefix=f".{into.name}-") as beside:
        # What fails leaves what was imported before as it was.
        files = ModelFiles(Path(beside), surfaces, leave_out)
        things: list[Thing] = []
        for k, entity in enumerate(scene.entities):
            progress("models", k, len(scene.entities))
            things += files.write(entity)
        if not len(files.triangles()):
            raise WorldImportError(f"{source} must hold something besides floor and light, it holds nothing")
        floor = find_floor(files.triangles(), scene.plane_m, start[:2] if start else None)
        if floor is None:
            raise WorldImportError(f"{source} must have a level floor of at least 1 m2, it has none")
        progress("free floor", 0, 1)
        try:
            world = _written(Path(beside) / name, source, scene, floor, things, start)
        except WorldFileError as error:
            told = str(error).replace(f"{beside}/", "")
            raise WorldImportError(f"{source} becomes a world that cannot be used: {told}") from error
        _put_in_place(Path(beside), into, name)
    notes = [*missing, *files.left_out, *scene.left_out, *surfaces.pictures.missing]
    return Imported(into / name, world, tuple(dict.fromkeys(notes)))


def _scene(source: Path, models: Sequence[Path], surfaces: EntitySurfaces) -> tuple[Scene, list[str]]:
    """What the world consists of, and which files are missing."""
    suffix = source.suffix.lower()
    if not source.is_file():
        raise WorldImportError(f"{source} must be a world to import, there is no such file")
    for folder in models:
        if not folder.is_dir():
            raise WorldImportError(f"--models {folder} must be a folder with models, there is none")
    if suffix in SDF:
        return read_sdf(source, Resources(source, models))
    if suffix in GLTF:
        return read_gltf(source.resolve(), surfaces), []
    raise WorldImportError(
        f"{source} must end in {', '.join(sorted(SDF | GLTF))}; other formats are converted with Blender"
    )


def _put_in_place(beside: Path, into: Path, name: str) -> None:
    """Move the models, then the world file that names them, into the folder."""
    (into / FOLDER).mkdir(parents=True, exist_ok=True)
    for model in (beside / FOLDER).iterdir():
        model.replace(into / FOLDER / model.name)
    (beside / name).replace(into / name)


def _missing(source: Path, missing: list[str]) -> str:
    more = f"; and {len(missing) - MOST_NAMED} more" if len(missing) > MOST_NAMED else ""
    return (
        f"{source} names {len(missing)} files that cannot be used: {'; '.join(missing[:MOST_NAMED])}{more}. "
        "Give the folder they are in with --models, or go on without them with --leave-out"
    )


def _written(
    path: Path, source: Path, scene: Scene, floor: Floor, things: Sequence[Thing], start: Vec3 | None
) -> WorldFile:
    """The world file, written and read back."""
    middle = (sum(floor.x_m) / 2, sum(floor.y_m) / 2, 0.0)
    world = _load(path, world_contents(source.stem, scene, floor, things, start or middle))
    place = find_start(world, start)
    if place is None:
        where = "nowhere" if start is None else f"not at ({start[0]:g}, {start[1]:g})"
        raise WorldImportError(
            f"{source}: {where} on its floor, at height {floor.height_m:g} m, is room for the robot; choose "
            "another --start X Y YAW"
        )
    if floor.endless and not place.to_the_edge:  # closed in: what lies outside is nobody's floor
        floor = replace(floor, x_m=_grown(place.x_m), y_m=_grown(place.y_m), fenced=False)
    contents = world_contents(source.stem, scene, floor, things, place.pose)
    return _load(path, {**contents, "environment": "outdoor"} if place.wide else contents)


def _grown(span: tuple[float, float]) -> tuple[float, float]:
    return span[0] - WALL_M, span[1] + WALL_M


def _load(path: Path, contents: Contents) -> WorldFile:
    path.write_text(as_yaml(contents), encoding="utf-8")
    return load_world(str(path))
