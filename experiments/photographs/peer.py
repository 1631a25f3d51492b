"""What pycolmap, structure from motion, makes of the same tours: panoramas as rigs of perspective crops."""

import math
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from experiments.photographs.looks import picture_of
from experiments.photographs.tables import Row, apart_deg, heading_figures
from experiments.photographs.tours import Tour
from services.launcher.client.failure import ExperimentError
from services.launcher.terminal.output import rounded
from shared.geometry.perspective import PerspectiveView, view_table
from shared.geometry.sphere import EquirectGrid, FloatArray

DIRECTIONS_DEG = [(lon, lat) for lat in (0.0, -35.0, 35.0) for lon in (0.0, 90.0, 180.0, 270.0)]
CROP_RAD, CROP_PX_MOST = math.radians(90.0), 768
"""The overlapping crops of pycolmap's example of panoramas; as fine as the panorama up to CROP_PX_MOST."""

MAPPING = {
    "ba_refine_sensor_from_rig": False,
    "ba_refine_focal_length": False,
    "ba_refine_principal_point": False,
    "ba_refine_extra_params": False,
    "min_model_size": 2,  # pictures: enough for a bearing; COLMAP's own bound is 10
}
"""Rig and cameras are known."""

OPTICAL_AXES = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])
"""Rows: right, down and ahead of COLMAP's camera in our frame (ahead, left, up)."""

Headings = dict[tuple[int, int], float]


def load_pycolmap() -> Any:
    """The module.

    Raises:
        ExperimentError: it is not installed.
    """
    try:
        import pycolmap
    except ModuleNotFoundError:
        raise ExperimentError(
            "--peer pycolmap needs pycolmap: pip install './experiments[peers]' in a clone of topnav"
        ) from None
    pycolmap.logging.minloglevel = int(pycolmap.logging.Level.ERROR)
    return pycolmap


def measure_peer(
    pycolmap: Any, tours: Sequence[Tour], seed: int, tick: Callable[[str], None]
) -> dict[str, Any]:
    """Reconstruct every tour, and read the bearing of every link off the poses."""
    pycolmap.set_random_seed(seed)
    rows: list[Row] = []
    offs: list[float | None] = []
    for tour in tours:
        began_s = time.perf_counter()
        found = _headings(pycolmap, tour, seed, tick)
        own = [apart_deg(found[a, b], deg) if (a, b) in found else None for a, b, deg in tour.links()]
        rows.append(_row(tour.file.name, len(tour.paths), own, time.perf_counter() - began_s))
        offs += own
    total = _row("total", sum(len(tour.paths) for tour in tours), offs, sum(row["seconds"] for row in rows))
    return {"name": f"pycolmap {pycolmap.__version__}", "tours": rows, "total": total}


def _row(name: str, pictures: int, offs: Sequence[float | None], spent_s: float) -> Row:
    return {"name": name, "pictures": pictures, **heading_figures(offs), "seconds": rounded(spent_s, 1)}


def _headings(pycolmap: Any, tour: Tour, seed: int, tick: Callable[[str], None]) -> Headings:
    """Bearing in degrees from each picture to each other one of the same reconstruction."""
    name = tour.file.name
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        database = folder / "database.db"
        tick(f"pycolmap, {name}: features")
        camera = _write_crops(pycolmap, tour, folder / "crops")
        pycolmap.extract_features(
            database,
            folder / "crops",
            camera_mode=pycolmap.CameraMode.PER_FOLDER,
            reader_options={"camera_model": "PINHOLE", "camera_params": camera.params_to_string()},
        )
        with pycolmap.Database.open(database) as opened:
            pycolmap.apply_rig_config([_rig(pycolmap)], opened)
        tick(f"pycolmap, {name}: matching")
        pycolmap.match_exhaustive(
            database,
            matching_options={"rig_verification": True, "skip_image_pairs_in_same_frame": True},
            verification_options={"ransac": {"random_seed": seed}},
        )
        tick(f"pycolmap, {name}: reconstruction")
        found = pycolmap.incremental_mapping(
            database, folder / "crops", folder, MAPPING | {"random_seed": seed}
        )
        return {k: v for one in found.values() for k, v in _bearings(one, tour).items()}


def _write_crops(pycolmap: Any, tour: Tour, folder: Path) -> Any:
    """Crops of all pictures, a folder for each direction and one size; returns their camera."""
    width_px = picture_of(tour.paths[0]).shape[1]
    side_px = min(round(width_px * CROP_RAD / math.tau), CROP_PX_MOST)
    views = _views(side_px)
    for number, path in enumerate(tour.paths):
        picture = picture_of(path)
        source = EquirectGrid(picture.shape[1], picture.shape[0])
        for k, view in enumerate(views):
            (folder / f"crop{k}").mkdir(parents=True, exist_ok=True)
            cut = cv2.remap(picture, *view_table(view, source), cv2.INTER_LINEAR, borderMode=cv2.BORDER_WRAP)
            cv2.imwrite(str(folder / f"crop{k}" / f"{number:05d}.jpg"), cut)
    params = [views[0].focal_px, views[0].focal_px, side_px / 2.0, side_px / 2.0]
    return pycolmap.Camera(model="PINHOLE", width=side_px, height=side_px, params=params)


def _views(side_px: int) -> list[PerspectiveView]:
    directions = ((math.radians(lon), math.radians(lat)) for lon, lat in DIRECTIONS_DEG)
    return [PerspectiveView(side_px, side_px, CROP_RAD, *direction) for direction in directions]


def _rig(pycolmap: Any) -> Any:
    """The crops of one picture as a rig whose frame is the first crop's camera."""
    cameras = [pycolmap.RigConfigCamera(ref_sensor=True, image_prefix="crop0/")]
    for k, view in enumerate(_views(1)[1:], start=1):
        turned = OPTICAL_AXES @ view.rotation.T @ OPTICAL_AXES.T
        pose = pycolmap.Rigid3d(pycolmap.Rotation3d(turned), np.zeros(3))
        cameras.append(pycolmap.RigConfigCamera(image_prefix=f"crop{k}/", cam_from_rig=pose))
    return pycolmap.RigConfig(cameras=cameras)


def _bearings(reconstruction: Any, tour: Tour) -> Headings:
    poses: dict[int, tuple[FloatArray, FloatArray]] = {}
    for number in range(len(tour.paths)):
        image = reconstruction.find_image_with_name(f"crop0/{number:05d}.jpg")
        if image is not None and image.has_pose:
            pose = image.cam_from_world()
            poses[number] = pose.rotation.matrix(), pose.tgt_origin_in_src()
    found = {}
    for a, (turned, here) in poses.items():
        for b, (_, there) in poses.items():
            right, _, ahead = turned @ (there - here)
            if a != b:
                found[a, b] = math.degrees(math.atan2(-right, ahead))
    return found
