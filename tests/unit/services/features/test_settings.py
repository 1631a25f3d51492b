"""Names are checked at start, choices are listed, and settings load no image library."""

import datetime as dt
import subprocess
import sys

import pytest

from services.features.pipeline.named_pipelines import PROFILES, find_profile
from services.features.pipeline.pipeline import Pipeline
from services.features.pipeline.plugins import PLUGINS, create
from services.features.settings import FeaturesSettings
from shared.certificates.holders import everyone
from shared.certificates.issuing import make


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


def test_an_extractor_alone_replaces_the_pipeline(monkeypatch):
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


@pytest.mark.parametrize(
    ("kind", "name"), [(kind, name) for kind, names in PLUGINS.items() for name in names]
)
def test_a_plugin_file_has_the_name_of_its_plugin(repository, kind, name):
    file = repository / "services/features" / f"{kind}s" / f"{name.partition('-')[0]}.py"
    assert f"class {PLUGINS[kind][name]}" in file.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("module", "absent"),
    [("services.features.settings", ("torch", "cv2")), ("services.features.service", ("torch", "kornia"))],
)
def test_what_an_import_does_not_load(module, absent):
    code = f"import sys, {module}; sys.exit(any(name in sys.modules for name in {absent!r}))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_cameras_may_lean_unless_somebody_says_that_they_do_not():
    assert Pipeline(FeaturesSettings().profile()).verification.tilting
    assert not Pipeline(FeaturesSettings(tilting=False).profile()).verification.tilting


def test_one_service_may_serve_several_robots_by_default_its_own(monkeypatch):
    monkeypatch.setenv("TOPNAV_ROBOT", "r7")
    assert FeaturesSettings.from_environment().served == ("r7",)
    monkeypatch.setenv("FEATURES_ROBOTS", "")
    assert FeaturesSettings.from_environment().served == ("r7",)
    monkeypatch.setenv("FEATURES_ROBOTS", "r1, r2")
    assert FeaturesSettings.from_environment().served == ("r1", "r2")


@pytest.mark.parametrize("names", ["r1,r1", "r1,", "R1", "r1;r2", "*", "r1,maps"])
def test_robots_are_named_once_and_well(monkeypatch, names):
    monkeypatch.setenv("FEATURES_ROBOTS", names)
    with pytest.raises(
        ValueError, match=r"^FEATURES_ROBOTS: (every robot must be named once|a robot's name)"
    ):
        FeaturesSettings.from_environment()


def test_a_certificate_is_for_one_robot(tmp_path):
    make(tmp_path, everyone("r1"), dt.datetime.now(dt.UTC))
    assert FeaturesSettings(robots="r1", certs=tmp_path / "features").served == ("r1",)
    with pytest.raises(ValueError, match="names 2 robots and a certificate is for one"):
        FeaturesSettings(robots="r1,r2", certs=tmp_path / "features")
