"""Indoors and outdoors: settings of the stack and bounds of the evaluation."""

from services.drive.settings import DriveSettings
from services.features.pipeline.named_pipelines import find_profile
from services.launcher.client.environments import INDOOR, OUTDOOR, environment_of
from services.planner.profiles import profile_named


def test_worlds_say_what_they_are():
    assert environment_of(None) is INDOOR
    assert environment_of("apartment") is INDOOR
    assert environment_of("village") is OUTDOOR


def test_names_of_profiles_exist_in_planner_and_drive():
    for asked in (None, "default", "thesis"):
        name = OUTDOOR.profile(asked)
        assert name is not None
        outside, inside = (profile_named(each).sensing.disparity_rad_per_m for each in (name, "default"))
        assert outside < inside
        assert DriveSettings(profile=name).limits().wheels.max_radps == 10.0
    assert OUTDOOR.pipeline is not None
    assert find_profile(OUTDOOR.pipeline).keypoints == 500


def test_a_profile_asked_for_by_its_own_name_is_kept():
    assert OUTDOOR.profile("outdoor") == "outdoor"
    assert INDOOR.profile("thesis") == "thesis"
    assert INDOOR.profile(None) is None
