"""Settings of the process: where the cache lies."""

import datetime as dt
from pathlib import Path

import pytest

from shared.certificates.holders import everyone
from shared.certificates.issuing import make
from simulator.service_settings import SimulatorSettings


@pytest.fixture(autouse=True)
def environment(monkeypatch):
    monkeypatch.delenv("SIMULATOR_CACHE_DIR", raising=False)
    monkeypatch.setenv("HOME", "/home/somebody")
    return monkeypatch


@pytest.mark.parametrize(
    ("variables", "folder"),
    [
        ({}, Path("/home/somebody/.cache/topnav")),
        ({"XDG_CACHE_HOME": "/fast"}, Path("/fast/topnav")),
        ({"XDG_CACHE_HOME": "not/absolute"}, Path("/home/somebody/.cache/topnav")),
        ({"SIMULATOR_CACHE_DIR": "/data/cache"}, Path("/data/cache")),
        ({"SIMULATOR_CACHE_DIR": ""}, None),
    ],
)
def test_cache_folder_is_the_one_given_else_below_the_users(environment, variables, folder):
    environment.delenv("XDG_CACHE_HOME", raising=False)
    for name, value in variables.items():
        environment.setenv(name, value)
    settings = SimulatorSettings.from_environment()
    assert settings.cache_dir == folder
    assert settings.simulation().cache_dir == folder


@pytest.mark.parametrize(
    ("names", "why"),
    [("r1", "names other robots, got 'r1'"), ("r2,r2", "named once"), ("R2", "a robot's name")],
)
def test_company_are_other_robots_named_once(environment, names, why):
    environment.setenv("SIMULATOR_COMPANY", "r2, r3")
    assert SimulatorSettings.from_environment().simulation().company == ("r2", "r3")
    environment.setenv("SIMULATOR_COMPANY", names)
    with pytest.raises(ValueError, match=why):
        SimulatorSettings.from_environment()


def test_on_the_secured_bus_a_simulator_hears_of_no_other_robot(tmp_path):
    make(tmp_path, everyone("r1"), dt.datetime.now(dt.UTC))
    with pytest.raises(ValueError, match="a certificate is for one"):
        SimulatorSettings(company="r2", certs=tmp_path / "simulator")
