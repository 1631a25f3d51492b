"""A profile from a file is a named one with other thresholds; what is wrong in it is told by name."""

import json

import pytest
from pydantic import ValidationError

from services.launcher.processes.stack_settings import profile_variables
from services.planner.profiles import PHOTO
from services.planner.settings import PlannerSettings


@pytest.fixture
def write(tmp_path):
    def make(content):
        path = tmp_path / "mine.json"
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path

    return make


def test_thresholds_of_the_file_replace_those_of_its_base(write):
    path = write({"base": "photo", "thresholds": {"s_edge_min": 33, "departure_m": 3.0}})
    rules = PlannerSettings(profile_file=path).rules()
    assert rules == PHOTO.replaced(s_edge_min=33, departure_m=3.0)
    assert (rules.mapping.s_edge_min, rules.mapping.departure_m) == (33, 3.0)


def test_no_file_leaves_the_named_profile():
    assert PlannerSettings(profile="photo", profile_file="").rules() == PHOTO


def test_the_launcher_gives_the_base_to_everybody_and_the_file_to_the_planner(write):
    path = write({"base": "photo", "thresholds": {"s_edge_min": 33}})
    assert profile_variables(str(path)) == {"TOPNAV_PROFILE": "photo", "TOPNAV_PROFILE_FILE": str(path)}
    assert profile_variables("thesis") == {"TOPNAV_PROFILE": "thesis"}
    other = path.rename(path.with_suffix(".yaml"))  # whatever --write was told
    assert profile_variables(str(other))["TOPNAV_PROFILE_FILE"] == str(other)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("{", "not one of"),
        ("1" * 5_000, "not one of"),
        ({"thresholds": {}}, "base"),
        ({"base": "moon", "thresholds": {}}, "must be one of"),
        ({"base": "photo", "thresholds": {"s_edge_mim": 3}}, "s_edge_mim"),
        ({"base": "photo", "thresholds": {"s_edge_min": -3}}, "s_edge_min"),
    ],
)
def test_what_does_not_fit_is_told_by_name(write, content, words):
    with pytest.raises(ValidationError, match=words):
        PlannerSettings(profile_file=write(content))


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(ValidationError, match=r"nowhere\.json"):
        PlannerSettings(profile_file=tmp_path / "nowhere.json")


@pytest.mark.parametrize("opening", ["[", '{"base":'])
def test_a_file_nested_without_end_is_refused(write, opening):
    path = write(opening * 100_000)
    with pytest.raises(ValueError, match="topnav calibrate --write"):
        PlannerSettings(profile_file=path).rules()
    with pytest.raises(ValueError, match="topnav calibrate --write"):
        profile_variables(str(path))
