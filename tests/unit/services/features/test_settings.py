"""Names are checked at start, choices are listed, and settings load no image library."""

import subprocess
import sys

import pytest

from services.features.pipeline import Pipeline
from services.features.pipelines import PROFILES, find_profile
from services.features.plugins import PLUGINS
from services.features.registry import create
from services.features.settings import FeaturesSettings


def test_the_default_pipeline_exists():
    assert find_profile(FeaturesSettings().pipeline).keypoints >= 150
    assert find_profile("thesis").keypoints == 150


def test_an_unknown_pipeline_lists_the_choices(monkeypatch):
    monkeypatch.setenv("FEATURES_PIPELINE", "surf")
    with pytest.raises(ValueError, match=r"'beblid'.*'sift'.*'surf'"):
        FeaturesSettings.from_environment()


def test_an_unknown_plugin_lists_the_choices():
    with pytest.raises(
        ValueError, match=r"extractor must be one of \['aliked.*'orb', 'sift'.*\], got 'surf'"
    ):
        create("extractor", "surf")


@pytest.mark.parametrize("name", sorted(PROFILES))
def test_every_profile_names_plugins_that_exist(name):
    profile = PROFILES[name]
    assert profile.extractor in PLUGINS["extractor"]
    assert profile.representation in PLUGINS["representation"]
    assert profile.matcher in PLUGINS["matcher"]


def test_an_extractor_alone_takes_the_place_of_the_pipeline(monkeypatch):
    monkeypatch.setenv("FEATURES_EXTRACTOR", "aliked-t16")
    assert FeaturesSettings().profile().extractor == "aliked-t16"
    monkeypatch.setenv("FEATURES_EXTRACTOR", "orb/tangent/brute_force")
    profile = FeaturesSettings().profile()
    assert (profile.extractor, profile.representation, profile.matcher) == ("orb", "tangent", "brute_force")
    monkeypatch.setenv("FEATURES_EXTRACTOR", "")
    assert FeaturesSettings().profile().extractor == "sift"


@pytest.mark.parametrize(
    "name", ["surf", "sift/mercator", "sift/tangent/lightglue", "sift/tangent/brute_force/x"]
)
def test_pipelines_that_cannot_be_are_refused_at_the_start(name):
    with pytest.raises(ValueError, match=r"lightglue|must be one of"):
        FeaturesSettings(pipeline=name)


def test_a_plugin_file_has_the_name_of_its_plugin():
    for choices in PLUGINS.values():
        for name, path in choices.items():
            assert path.split(":")[0].rsplit(".", 1)[1] == name.split("-")[0]  # a variant follows the dash


@pytest.mark.parametrize(
    ("module", "absent"),
    [("services.features.settings", ("torch", "cv2")), ("services.features.service", ("torch", "kornia"))],
)
def test_what_an_import_does_not_load(module, absent):
    code = f"import sys, {module}; sys.exit(any(name in sys.modules for name in {absent!r}))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_uneven_ground_asks_for_any_motion_of_the_camera():
    assert not Pipeline(FeaturesSettings().profile()).verification.fallback
    assert Pipeline(FeaturesSettings(uneven_ground=True).profile()).verification.fallback
