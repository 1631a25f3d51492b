"""The text that sets the levels, and what it says about wrong ones."""

import pytest

from simulator.disturbances.levels import Disturbances
from simulator.service_settings import SimulatorSettings


def test_text_sets_the_named_levels_and_leaves_the_others_off():
    levels = Disturbances.parse(" fog=0.5, noise=1 ")
    assert (levels.fog, levels.noise, levels.rain) == (0.5, 1.0, 0.0)
    assert Disturbances.parse(levels.text()) == levels


def test_empty_text_is_no_disturbance():
    assert Disturbances.parse("") == Disturbances()
    assert Disturbances().text() == ""


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("mist=0.5", "no disturbance 'mist': choose from illumination, fog"),
        ("fog", "fog needs a level from 0 to 1, got ''"),
        ("fog=much", "got 'much'"),
        ("fog=1.5", "must be a level from 0 to 1, got 1.5"),
        ("fog=nan", "must be a level from 0 to 1"),
        ("fog=0.1,fog=0.2", "fog is given twice"),
    ],
)
def test_wrong_text_is_refused_by_name(text, says):
    with pytest.raises(ValueError, match=says):
        Disturbances.parse(text)


def test_environment_sets_levels_of_the_process(monkeypatch):
    monkeypatch.setenv("SIMULATOR_DISTURBANCE", "fog=0.5,tilt=0.2")
    levels = SimulatorSettings.from_environment().simulation().disturbances
    assert (levels.fog, levels.tilt, levels.noise) == (0.5, 0.2, 0.0)
    monkeypatch.setenv("SIMULATOR_DISTURBANCE", "")
    assert SimulatorSettings.from_environment().disturbance == Disturbances()


def test_environment_with_an_unknown_disturbance_stops_the_process(monkeypatch):
    monkeypatch.setenv("SIMULATOR_DISTURBANCE", "snow=0.5")
    with pytest.raises(ValueError, match="no disturbance 'snow'"):
        SimulatorSettings.from_environment()
