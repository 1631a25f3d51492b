"""Frames of robots that rock: the tilts drawn, and that their features are never taken for level ones."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from experiments.commands import heading_frames
from experiments.rendered import features, headings
from experiments.rendered.features import features_seen, kept_features
from experiments.rendered.headings import PairResult, draw_tilts
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from shared.messages.simulation import Pose
from simulator.world.world_file import load_world


@pytest.fixture(scope="module")
def apartment():
    return load_world("apartment")


@pytest.fixture(scope="module")
def sift():
    return Pipeline(find_profile("sift"))


def test_tilts_have_the_spread_asked_for_and_begin_the_same_for_any_number():
    tilts = np.array(draw_tilts(4000, 0.05, 1))
    assert tilts.std(axis=0) == pytest.approx([0.05, 0.05], rel=0.05)
    assert draw_tilts(10, 0.05, 1) == [tuple(tilt) for tilt in tilts[:10].tolist()]
    assert draw_tilts(10, 0.05, 2) != draw_tilts(10, 0.05, 1)
    assert draw_tilts(10, 0.0, 1) == []


def one_keypoint(pose, tilt):
    """Features that tell where they were taken."""
    at = np.array([[pose.x_m, tilt[0]]], np.float32)
    return FeatureSet(at, np.ones(1, np.float32), np.ones((1, 8), np.float32))


def test_each_frame_is_taken_with_its_own_tilt(monkeypatch, tmp_path, apartment, sift):
    monkeypatch.setattr(features, "features_seen_tilted", lambda *_: one_keypoint)
    poses = [Pose(x_m=float(k), y_m=0.0, yaw_rad=0.0) for k in range(60)]
    tilts = [(0.25 * k, 0.0) for k in range(60)]
    kept = kept_features(apartment, sift, poses, tmp_path / "tilted", lambda _: None, tilts)
    assert [tuple(each.lonlat_rad[0]) for each in kept] == [(k, 0.25 * k) for k in range(60)]
    level = kept_features(apartment, sift, poses, tmp_path / "level", lambda _: None)
    assert [tuple(each.lonlat_rad[0]) for each in level] == [(k, 0.0) for k in range(60)]
    assert features_seen(apartment, sift)(poses[7]).lonlat_rad[0].tolist() == [7.0, 0.0]


def test_level_and_tilted_frames_are_kept_apart(monkeypatch, tmp_path, apartment, sift):
    asked = []

    def judged(pairs, *others):
        _, _, folder, _, tilts = others
        asked.append((folder, len(tilts), [pair.heading_rad for pair in pairs]))
        return []

    monkeypatch.setattr(headings, "judge_pairs", judged)
    for sigma_rad in (0.0, 0.03, 0.05):
        headings.measure(apartment, sift, 3, 1, tmp_path, print, rocking_rad=sigma_rad)
    folders, counts, pairs = zip(*asked, strict=True)
    assert len(set(folders)) == 3
    assert counts == (0, 6, 6)
    assert pairs[0] == pairs[1] == pairs[2]


@pytest.mark.parametrize(("options", "sigma_deg"), [([], 0.0), (["--rocking-deg", "3"], 3.0)])
def test_the_command_passes_the_tilt_on_and_records_it(monkeypatch, tmp_path, options, sigma_deg):
    asked = []
    errors = dict.fromkeys(headings.METHODS, 0.0)
    result = PairResult(1.0, 9, 9, "ok", 1.0, 0.1, 0.0, errors, errors)

    def measured(*_, rocking_rad):
        asked.append(rocking_rad)
        return [result]

    monkeypatch.setattr(headings, "measure", measured)
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(heading_frames.app, ["--json", "f.json", "--plot", "f.png", *options])
    assert done.exit_code == 0, done.output
    assert asked == [pytest.approx(np.deg2rad(sigma_deg))]
    report = json.loads((tmp_path / "f.json").read_text())
    assert report["rocking_deg"] == sigma_deg
    assert report["calibration"]["bins"] == [{"confidence": 1.0, "right": 1.0, "n": 1}]
    assert (tmp_path / "f.png").stat().st_size > 0
