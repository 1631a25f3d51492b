"""Indoors and outdoors: settings of the stack and bounds of the evaluation."""

from services.drive.settings import DriveSettings
from services.launcher.client.environments import INDOOR, OUTDOOR, environment_of
from services.planner.profiles import profile_named


def test_worlds_say_what_they_are():
    assert environment_of(None) is INDOOR
    assert environment_of("apartment") is INDOOR
    assert environment_of("village") is OUTDOOR


def test_names_of_profiles_exist_in_planner_and_drive():
    for place in (INDOOR, OUTDOOR):
        for asked in ("default", "thesis"):
            name = place.profile(asked)
            assert profile_named(name).name == DriveSettings(profile=name).profile == name
    assert DriveSettings(profile=OUTDOOR.profile("thesis")).limits().speeds.max_mps == 0.8
    assert DriveSettings(profile=INDOOR.profile("thesis")).limits().speeds.max_mps == 0.4


def test_how_a_robot_decides_is_the_same_everywhere():
    assert OUTDOOR.profile("default") == INDOOR.profile("default") == "default"
    assert OUTDOOR.profile(None) is INDOOR.profile(None) is None
    assert OUTDOOR.profile("photo") == "photo"
