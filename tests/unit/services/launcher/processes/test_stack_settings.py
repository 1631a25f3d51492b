"""From a caller's choices to the variables of the Compose file."""

from pathlib import Path

import pytest

from services.launcher.processes.stack_settings import Ports, StackSettings


def test_choices_replace_the_environment_and_what_is_not_chosen_stays():
    settings = StackSettings(Path("/d"), world="apartment", lockstep=True, seed=3, ports=Ports(1, 2, 3))
    variables = settings.variables({"TOPNAV_SEED": "9", "TOPNAV_PROFILE": "thesis", "OTHER": "x"})
    assert variables["TOPNAV_SEED"] == "3"
    assert variables["TOPNAV_LOCKSTEP"] == "true"
    assert variables["TOPNAV_PROFILE"] == "thesis"
    assert variables["TOPNAV_ROUTER_PORT"] == "1"
    assert variables["TOPNAV_GATEWAY_PORT"] == "2"
    assert variables["TOPNAV_MAP_STORE_PORT"] == "3"
    assert variables["OTHER"] == "x"


def test_local_processes_listen_on_loopback_whatever_the_environment_says():
    assert StackSettings(Path("/d")).variables({"TOPNAV_BIND": "0.0.0.0"})["TOPNAV_BIND"] == "127.0.0.1"


def test_lockstep_can_be_switched_off_explicitly():
    settings = StackSettings(Path("/d"), lockstep=False)
    assert settings.variables({"TOPNAV_LOCKSTEP": "true"})["TOPNAV_LOCKSTEP"] == "false"


def test_free_ports_differ_and_named_ones_are_read():
    ports = Ports.free()
    assert len({ports.router, ports.gateway, ports.map_store}) == 3
    assert Ports.from_variables({"TOPNAV_GATEWAY_PORT": "9000", "TOPNAV_ROUTER_PORT": ""}) == Ports(
        gateway=9000
    )
    with pytest.raises(ValueError, match="invalid literal"):
        Ports.from_variables({"TOPNAV_GATEWAY_PORT": "web"})


def test_world_file_is_found_from_any_folder_and_a_name_stays_a_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert StackSettings(Path("/d"), world="my/w.yaml").variables({})["TOPNAV_WORLD"] == str(
        tmp_path / "my/w.yaml"
    )
    assert StackSettings(Path("/d"), world="village").variables({})["TOPNAV_WORLD"] == "village"
