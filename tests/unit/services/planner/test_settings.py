"""Planner settings: profiles by name, the heading method on its own, clear refusals."""

import pytest

from services.planner.heading.methods import METHOD_NAMES
from services.planner.settings import PlannerSettings


def test_default_profile_uses_two_view_headings(monkeypatch):
    monkeypatch.delenv("PLANNER_PROFILE", raising=False)
    assert PlannerSettings.from_environment().rules().sensing.heading_method == "epipolar"


@pytest.mark.parametrize("method", METHOD_NAMES)
def test_every_heading_method_can_be_chosen(monkeypatch, method):
    monkeypatch.setenv("PLANNER_HEADING_METHOD", method)
    assert PlannerSettings.from_environment().rules().sensing.heading_method == method


def test_thesis_profile_is_strict(monkeypatch):
    monkeypatch.setenv("PLANNER_PROFILE", "thesis")
    rules = PlannerSettings.from_environment().rules()
    assert rules.travel.delete_edges
    assert (rules.travel.suspend_after, rules.travel.path_cost) == (1, "nodes")
    assert rules.mapping.exploration == "strategies"


def test_unknown_profile_lists_the_choices(monkeypatch):
    monkeypatch.setenv("PLANNER_PROFILE", "thesiss")
    with pytest.raises(ValueError, match=r"default.*thesis"):
        PlannerSettings.from_environment()
