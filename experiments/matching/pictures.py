"""Square grey pictures with 90 degrees of view: cut out of rendered panoramas, or given by the user."""

import math
from pathlib import Path

import cv2
import numpy as np

from experiments.matching.placing import FOV_RAD, Image
from experiments.rendered.frames import simulated
from services.launcher.client.failure import ExperimentError
from shared.geometry.perspective import PerspectiveView, view_table
from shared.geometry.sphere import EquirectGrid
from simulator.settings import CameraSettings
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world

SOURCES = ("apartment", "break_room", "factory", "village")
PANORAMA_PX = 2048
"""A view of 90 degrees is then as sharp as the largest that is cut out of it, 512 pixels."""

SUFFIXES = (".png", ".jpg", ".jpeg", ".webp", ".tif", ".tiff", ".bmp")


def rendered(count: int, side_px: int, seed: int, folder: Path) -> list[Image]:
    """One view per world in turn; kept in `folder`, since rendering a world takes a minute to begin."""
    pictures = []
    for number in range(count):
        world_name = SOURCES[number % len(SOURCES)]
        path = folder / f"{world_name}-{number}-{side_px}-{seed}.png"
        if not path.exists():
            world = load_world(world_name)
            simulation = simulated(world, CameraSettings(width_px=PANORAMA_PX))
            rng = np.random.default_rng([seed, number])
            x_m, y_m, _ = free_space(world).random_pose(rng, 0.3)
            panorama = simulation.panorama_at(x_m, y_m, rng.uniform(-math.pi, math.pi))
            table = view_table(
                PerspectiveView(side_px, side_px, FOV_RAD), EquirectGrid(PANORAMA_PX, PANORAMA_PX // 2)
            )
            view = cv2.remap(panorama, table.map_x, table.map_y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_WRAP)
            path.parent.mkdir(parents=True, exist_ok=True)
            cv2.imwrite(str(path), cv2.cvtColor(view, cv2.COLOR_BGR2GRAY))
        pictures.append(_gray(path))
    return pictures


def from_folder(folder: Path, count: int, side_px: int) -> list[Image]:
    """The middle squares of the first pictures of a folder, by name.

    Raises:
        ExperimentError: there is no picture.
    """
    files = sorted(f for f in folder.glob("*") if f.suffix.lower() in SUFFIXES)[:count]
    if not files:
        raise ExperimentError(f"no picture in {folder}: expected files like {', '.join(SUFFIXES[:3])}")
    squares = []
    for file in files:
        gray = _gray(file)
        side = min(gray.shape)
        top, left = (gray.shape[0] - side) // 2, (gray.shape[1] - side) // 2
        square = gray[top : top + side, left : left + side]
        squares.append(
            np.asarray(cv2.resize(square, (side_px, side_px), interpolation=cv2.INTER_AREA), np.uint8)
        )
    return squares


def _gray(path: Path) -> Image:
    picture = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    if picture is None:
        raise ExperimentError(f"{path} is no picture that OpenCV reads")
    return np.asarray(picture, np.uint8)
