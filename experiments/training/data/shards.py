"""Pairs of one world on disk: JPEGs, ranges, poses. What was changed since is named and refused."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from experiments.training.sealed import description, packed, read_sealed, sealed_files, unpacked, write_sealed
from experiments.training.sights import CameraPose, Image, Sight
from experiments.training.worlds import WorldName, require_trainable
from services.launcher.client.failure import ExperimentError

SUFFIX, FORMAT = ".npz", "topnav-pairs/1"
AGAIN = "delete it and run 'topnav train data' again, which draws what is missing"


@dataclass(frozen=True, eq=False)
class Pair:
    """Two panoramas of one world.

    Attributes:
        here, there: as they were taken.
        overlap: share of the directions of each that the other sees, (2,).
    """

    here: Sight
    there: Sight
    overlap: tuple[float, float]

    @property
    def distance_m(self) -> float:
        """How far apart they were taken."""
        return float(np.linalg.norm(self.here.pose.position_m - self.there.pose.position_m))


@dataclass(frozen=True, eq=False)
class Shard:
    """Pairs and where they are from."""

    world: WorldName
    pairs: list[Pair]
    about: dict[str, Any]


def write_shard(folder: Path, stem: str, shard: Shard, jpegs: Sequence[bytes]) -> Path:
    """Keep a shard.

    Args:
        folder: of the data.
        stem: of the file's name.
        shard: whose pictures are kept as the JPEGs given.
        jpegs: two for each pair.
    """
    sights = [sight for pair in shard.pairs for sight in (pair.here, pair.there)]
    arrays = {
        "jpegs": np.frombuffer(b"".join(jpegs), np.uint8),
        "jpeg_bytes": np.array([len(data) for data in jpegs], np.int64),
        "ranges_m": np.array([sight.ranges_m for sight in sights], np.float16),
        "poses": np.array([_pose_row(sight.pose) for sight in sights], np.float64).reshape(-1, 6),
        "overlaps": np.array([pair.overlap for pair in shard.pairs], np.float32).reshape(-1, 2),
    }
    about = {**shard.about, "format": FORMAT, "world": str(shard.world), "pairs": len(shard.pairs)}
    return write_sealed(folder, stem, SUFFIX, packed(arrays, about))


def read_shard(path: Path) -> Shard:
    """Read one.

    Raises:
        ExperimentError: it was changed, cut off, or is no shard.
    """
    data = read_sealed(path, "shard", AGAIN)
    about, arrays = _about(path, data), unpacked(data)
    ends = np.cumsum(arrays["jpeg_bytes"])
    sights = [
        Sight(_decoded(path, jpeg), ranges, CameraPose(row[0], row[1], row[2], row[3], (row[4], row[5])))
        for jpeg, ranges, row in zip(
            np.split(arrays["jpegs"], ends)[:-1], arrays["ranges_m"], arrays["poses"].tolist(), strict=True
        )
    ]
    overlaps: list[tuple[float, float]] = [(one, other) for one, other in arrays["overlaps"].tolist()]
    pairs = [Pair(*both) for both in zip(sights[::2], sights[1::2], overlaps, strict=True)]
    return Shard(WorldName.parse(about["world"]), pairs, about)


def about_shard(path: Path) -> dict[str, Any]:
    """World and recipe of a shard, and how many pairs were planned and are there; no picture is decoded.

    Raises:
        ExperimentError: it was changed, cut off, or is no shard.
    """
    return _about(path, read_sealed(path, "shard", AGAIN))


def _about(path: Path, data: bytes) -> dict[str, Any]:
    about = description(data)
    if about.get("format") != FORMAT:
        raise ExperimentError(
            f"shard {path} has format {about.get('format')!r}, expected {FORMAT!r}: {AGAIN}"
        )
    return about


def shard_files(folder: Path) -> list[Path]:
    """All shards of a folder.

    Raises:
        ExperimentError: there is none.
    """
    files = sealed_files(folder, "*", SUFFIX)
    if not files:
        raise ExperimentError(f"no pairs in {folder}: draw some with 'topnav train data --into {folder}'")
    return files


def trainable(path: Path) -> Shard:
    """Read a shard to train on.

    Raises:
        ExperimentError: it is corrupted, or of a world by which training is judged.
    """
    shard = read_shard(path)
    require_trainable([shard.world], f"shard {path}")
    return shard


def _pose_row(pose: CameraPose) -> tuple[float, ...]:
    return pose.x_m, pose.y_m, pose.yaw_rad, pose.height_m, *pose.tilt


def _decoded(path: Path, jpeg: np.ndarray) -> Image:
    picture = cv2.imdecode(jpeg, cv2.IMREAD_COLOR)
    if picture is None:
        raise ExperimentError(f"shard {path} holds a picture that is no JPEG: {AGAIN}")
    return np.asarray(picture, np.uint8)
