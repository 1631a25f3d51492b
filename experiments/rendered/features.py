"""Features of rendered frames, kept on disk: rendering them takes most of a study's time.

Uses the pure code of `services.features`, and the simulator in this process.
"""

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np

from experiments.rendered.frames import CAMERA, tilting_camera
from services.features.matching.verification import feature_set
from services.features.pipeline.interfaces import FeatureSet, Float32Array
from services.features.pipeline.pipeline import Pipeline
from shared.messages.features import Features
from shared.messages.simulation import Pose
from simulator.sensors.attitude import LEVEL, PitchRoll
from simulator.world.world_file import WorldFile

COLUMNS = ("lonlat_rad", "scores", "descriptors", "sizes_rad")
CHUNK = 50
"""Frames in a file: what an interruption loses at most."""

Tick = Callable[[str], None]


def features_seen(world: WorldFile, pipeline: Pipeline) -> Callable[[Pose], FeatureSet]:
    """What the pipeline extracts from a world's frame at any pose; loads SAPIEN."""
    look = features_seen_tilted(world, pipeline)
    return lambda pose: look(pose, LEVEL)


def features_seen_tilted(world: WorldFile, pipeline: Pipeline) -> Callable[[Pose, PitchRoll], FeatureSet]:
    """The same with a tilt of the robot at each pose."""
    shoot = tilting_camera(world)
    return lambda pose, tilt: feature_set(pipeline.features_of(shoot(pose, tilt)))


def cache_folder(root: Path, kind: str, world: WorldFile, pipeline: Pipeline, *choices: object) -> Path:
    """Where features of one kind are kept: another world, camera, pipeline or choice is another folder."""
    parts = (world.model_dump_json(), CAMERA.model_dump_json(), asdict(pipeline.profile), *choices)
    text = "|".join(str(part) for part in parts)
    return root / f"{kind}-{world.name}-{pipeline.identity}-{hashlib.sha256(text.encode()).hexdigest()[:12]}"


def kept_features(
    world: WorldFile,
    pipeline: Pipeline,
    poses: Sequence[Pose],
    folder: Path,
    tick: Tick,
    tilts: Sequence[PitchRoll] = (),
) -> list[FeatureSet]:
    """Read from `folder` what is there, render the rest and keep it; `tick` hears how far it is.

    `tilts` are those of the robot at each of the poses, none for a level one; `folder` must be of their draw.
    """
    folder.mkdir(parents=True, exist_ok=True)
    leans = tilts or [LEVEL] * len(poses)
    look: Callable[[Pose, PitchRoll], FeatureSet] | None = None
    found: list[FeatureSet] = []
    for start in range(0, len(poses), CHUNK):
        path = folder / f"{start:06d}-{min(CHUNK, len(poses) - start)}.npz"
        if not path.exists():
            look = look or features_seen_tilted(world, pipeline)
            chunk = slice(start, start + CHUNK)
            _save(path, [look(*each) for each in zip(poses[chunk], leans[chunk], strict=True)])
        found += _load(path)
        tick(f"{world.name}: {len(found)} of {len(poses)} frames")
    return found


def as_message(features: FeatureSet, pipeline: str, seq: int = 0) -> Features:
    """The message that the feature service would send of a frame."""
    return Features(
        seq=seq,
        pipeline=pipeline,
        lonlat_rad=features.lonlat_rad,
        scores=features.scores,
        descriptors=features.descriptors,
        sizes_rad=features.sizes_rad,
    )


def _save(path: Path, features: Sequence[FeatureSet]) -> None:
    new = path.with_suffix(".new.npz")
    np.savez(
        new,
        counts=np.array([len(each) for each in features]),
        lonlat_rad=np.concatenate([each.lonlat_rad for each in features]),
        scores=np.concatenate([each.scores for each in features]),
        descriptors=np.concatenate([each.descriptors for each in features]),
        sizes_rad=np.concatenate([_sizes_rad(each) for each in features]),
    )
    new.replace(path)


def _load(path: Path) -> list[FeatureSet]:
    with np.load(path, allow_pickle=False) as kept:
        ends = np.cumsum(kept["counts"])[:-1]
        columns = [np.split(kept[name], ends) for name in COLUMNS]
    found = [FeatureSet(*each) for each in zip(*columns, strict=True)]
    return [each if _known(each) else replace(each, sizes_rad=None) for each in found]


def _sizes_rad(features: FeatureSet) -> Float32Array:
    """Sizes of the keypoints, NaN where they are unknown."""
    unknown = np.full(len(features), np.nan, np.float32)
    return unknown if features.sizes_rad is None else features.sizes_rad


def _known(features: FeatureSet) -> bool:
    return features.sizes_rad is not None and bool(np.isfinite(features.sizes_rad).all())
