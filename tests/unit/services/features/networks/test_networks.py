"""Learned plugins: shapes with random weights, quality with trained ones where they are to be had."""

import shutil
import socket
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch")

from services.features.networks.catalogue import MODELS  # noqa: E402
from services.features.networks.runtime import DOWNLOAD, WeightsError, device_named  # noqa: E402
from services.features.pipeline.extraction import extract  # noqa: E402
from services.features.pipeline.interfaces import Profile, Runtime  # noqa: E402
from services.features.pipeline.named_pipelines import LIGHTGLUE, combined  # noqa: E402
from services.features.pipeline.pipeline import Pipeline  # noqa: E402
from services.features.pipeline.plugins import (  # noqa: E402
    KEYPOINT_NETWORKS,
    PATCH_NETWORKS,
    SIFT_NETWORKS,
    create_matcher,
)
from shared.geometry.sphere import wrap_rad  # noqa: E402

WIDTHS = {
    "aliked-t16": 64,
    "xfeat": 64,
    "superpoint": 256,
    "dedode": 256,
    "topnav-keypoints": 64,
}
SLOW = ("dedode",)
UNTRAINED = Runtime(trained=False)
TRAINED = (
    "aliked-t16",
    "aliked-n16",
    "tfeat",
    "mkd",
    "topnav-slim",
    "topnav-hardnet",
    "topnav-keypoints",
    *SIFT_NETWORKS,
)


@pytest.fixture
def weights(monkeypatch, tmp_path, repository):
    """A cache that holds the files of the shared weights."""
    given = repository.parent / "shared" / "weights"
    if not given.is_dir():
        pytest.skip("trained weights are not beside the repository")
    cache = tmp_path / "hub" / "checkpoints"
    cache.mkdir(parents=True)
    for file in given.iterdir():
        shutil.copy(file, cache / file.name)
    monkeypatch.setenv("TORCH_HOME", str(tmp_path))


def untrained(profile: Profile) -> Pipeline:
    torch.manual_seed(1)
    return Pipeline(profile, runtime=UNTRAINED)


@pytest.mark.parametrize(
    "name", [n for n in (*KEYPOINT_NETWORKS, *PATCH_NETWORKS, *SIFT_NETWORKS) if n not in SLOW]
)
def test_untrained_networks_give_features_of_the_right_shape(room, name):
    profile = replace(combined(name, "equirectangular", "mutual_ratio"), keypoints=60)
    pipeline = untrained(profile)
    found = extract(room(0.0, 0.0, 0.0, 400), pipeline.extractor, pipeline.representation, profile)
    assert 0 < len(found) <= 60
    assert found.descriptors.shape == (len(found), WIDTHS.get(name, 128))
    assert found.descriptors.dtype == np.float16
    np.testing.assert_allclose(np.linalg.norm(found.descriptors.astype(np.float64), axis=1), 1.0, atol=5e-3)
    assert np.abs(found.lonlat_rad[:, 1]).max() <= np.deg2rad(65.0)


def test_an_untrained_network_works_on_tangent_pictures(room):
    profile = replace(combined("xfeat", "tangent", "mutual_ratio"), keypoints=60)
    pipeline = untrained(profile)
    found = extract(room(0.0, 0.0, 0.0, 400), pipeline.extractor, pipeline.representation, profile)
    assert 0 < len(found) <= 60


@pytest.mark.parametrize("name", TRAINED)
@pytest.mark.usefixtures("weights")
def test_trained_networks_find_the_turn_between_two_views(room, name):
    """The same place seen after a turn by a tenth: most matches move by 36 degrees."""
    profile = combined(name, "equirectangular", "mutual_ratio")
    pipeline = Pipeline(profile)
    picture = room(0.0, 0.0, 0.0, 400)
    here, there = (
        extract(view, pipeline.extractor, pipeline.representation, profile)
        for view in (picture, np.roll(picture, 80, axis=1))
    )
    pairs = pipeline.matcher.match(here, [there])[0].pairs
    moved = wrap_rad(there.lonlat_rad[pairs[:, 1], 0] - here.lonlat_rad[pairs[:, 0], 0] + np.deg2rad(36.0))
    assert len(pairs) > 100
    assert np.mean(np.abs(moved) < np.deg2rad(1.0)) > 0.8


@pytest.mark.parametrize("extractor", [n for n in LIGHTGLUE if n not in ("superpoint", "dedode")])
def test_untrained_lightglue_pairs_features_of_its_extractor(room, extractor):
    profile = replace(combined(extractor, "equirectangular", "lightglue"), keypoints=40)
    pipeline = untrained(profile)
    found = extract(room(0.0, 0.0, 0.0, 400), pipeline.extractor, pipeline.representation, profile)
    pairs = pipeline.matcher.match(found, [found])[0].pairs
    assert pairs.shape[1:] == (2,)
    assert len(np.unique(pairs[:, 0])) == len(pairs)


def test_untrained_superglue_pairs_features_of_superpoint(room):
    pytest.importorskip("transformers")
    profile = replace(combined("superpoint", "equirectangular", "superglue"), keypoints=40)
    pipeline = untrained(profile)
    found = extract(room(0.0, 0.0, 0.0, 400), pipeline.extractor, pipeline.representation, profile)
    pairs = pipeline.matcher.match(found, [found])[0].pairs
    assert pairs.shape[1:] == (2,)


def test_non_commercial_weights_need_consent(monkeypatch):
    pytest.importorskip("transformers")
    monkeypatch.delenv("TOPNAV_NON_COMMERCIAL", raising=False)
    with pytest.raises(ValueError, match="non-commercial"):
        Pipeline(combined("superpoint", "equirectangular", "mutual_ratio"))
    with pytest.raises(ValueError, match="non-commercial"):
        create_matcher(combined("superpoint", "equirectangular", "superglue"), "euclidean", Runtime())


def test_weights_that_are_missing_are_not_downloaded_unasked(monkeypatch, tmp_path):
    """Nobody answers at this proxy: whoever tried would wait for minutes."""
    with socket.create_server(("127.0.0.1", 0)) as silent:
        monkeypatch.setenv("TORCH_HOME", str(tmp_path))
        monkeypatch.setenv("https_proxy", f"http://127.0.0.1:{silent.getsockname()[1]}")
        monkeypatch.delenv(DOWNLOAD, raising=False)
        with pytest.raises(WeightsError, match="topnav models pull aliked-t16"):
            Pipeline(combined("aliked-t16", "equirectangular", "mutual_ratio"))


def test_weights_that_are_not_to_be_had_are_named_with_what_to_do(monkeypatch, tmp_path):
    monkeypatch.setenv("TORCH_HOME", str(tmp_path))
    monkeypatch.setenv(DOWNLOAD, "1")
    monkeypatch.setenv("https_proxy", "http://127.0.0.1:9")
    with pytest.raises(WeightsError, match="topnav models pull aliked-t16"):
        Pipeline(combined("aliked-t16", "equirectangular", "mutual_ratio"))


def test_cuda_without_a_gpu_is_refused():
    if torch.cuda.is_available():
        pytest.skip("there is a GPU")
    with pytest.raises(ValueError, match="use device cpu"):
        device_named("cuda")


def test_every_learned_extractor_has_an_entry_in_the_catalogue_of_weights():
    covered = {name for model in MODELS for name in model.pipelines} | {"dedode"}
    assert {*KEYPOINT_NETWORKS, *PATCH_NETWORKS, *SIFT_NETWORKS} <= covered


@pytest.mark.parametrize(
    ("parts", "found"),
    [
        (("sift", "equirectangular", "lightglue"), "no lightglue for sift"),
        (("aliked-n16", "tangent", "superglue"), "superpoint alone"),
    ],
)
def test_plugins_that_do_not_work_together_are_refused(parts, found):
    with pytest.raises(ValueError, match=found):
        combined(*parts)


def test_checksums_are_those_of_the_files(repository):
    given = repository.parent / "shared" / "weights" / "SHA256SUMS"
    if not given.is_file():
        pytest.skip("trained weights are not beside the repository")
    sums = {Path(line.split()[1]).name: line.split()[0] for line in given.read_text().splitlines()}
    others = [model for model in MODELS if model.sha256 and model.source != "topnav"]
    assert sums == {model.file: model.sha256 for model in others}
