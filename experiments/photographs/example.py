"""A small tour rendered from a world of ours: what `tour.json` looks like, and what the tests measure."""

import json
import math
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from experiments.photographs.tilting import pitch_roll, rotation_of
from experiments.photographs.tours import TOUR_FILE
from services.launcher.client.failure import ExperimentError
from shared.geometry.perspective import rotation_z
from simulator.scene.parts import Pose2
from simulator.world.freespace import FreeSpace, free_space
from simulator.world.world_file import WorldFile, load_world

EXAMPLE_WORLD, EXAMPLE_PICTURES = "apartment", 8
WIDTH_PX, JPEG_QUALITY = 2048, 92
LINK_M, APART_M = 4.0, 1.2
"""Linked up to this distance, in sight of one another; chosen: how tours of flats are taken."""

TILT_DEG = (1.0, 3.0)
"""Of a tripod put up by eye."""

MARGIN_M = 0.3
DRAWS = 5000


def render_apartment(folder: Path, seed: int) -> Path:
    """The example of the command: eight pictures of the apartment."""
    return render_example(load_world(EXAMPLE_WORLD), folder, EXAMPLE_PICTURES, seed)


def render_example(world: WorldFile, folder: Path, pictures: int, seed: int) -> Path:
    """Render a tour into a folder: JPEGs and the file that says what is known of them.

    Raises:
        ExperimentError: the folder holds something else, or the world has no room for so many pictures.
    """
    path = folder / TOUR_FILE
    if folder.exists() and any(folder.iterdir()) and not path.exists():
        raise ExperimentError(
            f"--render-example {folder}: expected an empty folder or an earlier tour: choose another"
        )
    rng, space = np.random.default_rng(seed), free_space(world)
    poses = spread_poses(space, pictures, rng)
    tilts = [pitch_roll(*each) for each in zip(*_leaning(pictures, rng), strict=True)]
    ids = [f"{number:02d}" for number in range(pictures)]
    folder.mkdir(parents=True, exist_ok=True)
    _render(world, folder, list(zip(ids, poses, tilts, strict=True)))
    rooms = {name: room for name, pose in zip(ids, poses, strict=True) if (room := room_of(world, pose))}
    links = links_between(space, ids, poses, tilts)
    tour = {"name": f"{world.name}_rendered", "pictures": ids, "links": links, "rooms": rooms}
    path.write_text(json.dumps(tour, indent=1) + "\n", encoding="utf-8")
    return path


def spread_poses(space: FreeSpace, count: int, rng: np.random.Generator) -> list[Pose2]:
    """Free poses at least APART_M from one another, each after the first in sight of an earlier one.

    Raises:
        ExperimentError: there is no room for so many.
    """
    poses: list[Pose2] = []
    for _ in range(DRAWS):
        pose = space.random_pose(rng, MARGIN_M)
        apart = all(math.dist(pose[:2], other[:2]) >= APART_M for other in poses)
        if apart and (not poses or any(in_sight(space, pose, other) for other in poses)):
            poses.append(pose)
        if len(poses) == count:
            return poses
    raise ExperimentError(
        f"the world has room for {len(poses)} pictures {APART_M} m apart, not {count}: take fewer"
    )


def in_sight(space: FreeSpace, a: Pose2, b: Pose2) -> bool:
    """Whether two poses are linked: near and with nothing between them."""
    return math.dist(a[:2], b[:2]) <= LINK_M and space.line_of_sight(a[:2], b[:2])


def links_between(
    space: FreeSpace, ids: list[str], poses: list[Pose2], tilts: list[tuple[float, float]]
) -> list[dict[str, Any]]:
    """Links of all pairs in sight, both ways, with the bearing in the tilted picture."""
    return [
        {"from": ids[a], "to": ids[b], "bearing_deg": round(bearing_deg(poses[a], poses[b], tilts[a]), 2)}
        for a in range(len(ids))
        for b in range(len(ids))
        if a != b and in_sight(space, poses[a], poses[b])
    ]


def bearing_deg(camera: Pose2, place: Pose2, tilt: tuple[float, float] = (0.0, 0.0)) -> float:
    """Longitude of a place at the camera's height in the picture of a tilted camera, degrees."""
    towards = np.array([place[0] - camera[0], place[1] - camera[1], 0.0])
    seen = (rotation_z(camera[2]) @ rotation_of(*tilt)).T @ towards
    return math.degrees(math.atan2(seen[1], seen[0]))


def room_of(world: WorldFile, pose: Pose2) -> str | None:
    """The room that a pose stands in; None in a passage or outside."""
    inside = (r for r in world.rooms if r.x_m[0] < pose[0] < r.x_m[1] and r.y_m[0] < pose[1] < r.y_m[1])
    return next((room.name for room in inside), None)


def _leaning(count: int, rng: np.random.Generator) -> tuple[Any, Any]:
    return np.radians(rng.uniform(*TILT_DEG, count)), rng.uniform(-math.pi, math.pi, count)


def _render(world: WorldFile, folder: Path, views: list[tuple[str, Pose2, tuple[float, float]]]) -> None:
    # SAPIEN's renderer is loaded only where pictures are wanted.
    from simulator.cache_folder import user_cache_dir
    from simulator.scene.disk_cache import DiskCache
    from simulator.scene.painter import Painter
    from simulator.scene.render_scene import RenderScene
    from simulator.sensors.attitude import leaning
    from simulator.settings import CameraSettings, SimulationSettings
    from simulator.world.contents import expand

    settings = SimulationSettings(camera=CameraSettings(width_px=WIDTH_PX), cache_dir=user_cache_dir())
    cache = DiskCache(settings.cache_dir, settings.cache_limit_mb * 1_000_000)
    with Painter(cache) as painter:
        scene = RenderScene(world, expand(world), settings.camera, painter, cache)
    for name, pose, tilt in views:
        quality = [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY]
        cv2.imwrite(str(folder / f"{name}.jpg"), scene.panorama(pose, leaning(tilt)), quality)
