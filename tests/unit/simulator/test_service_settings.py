"""Settings of the process: where the cache lies."""

from pathlib import Path

import pytest

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
