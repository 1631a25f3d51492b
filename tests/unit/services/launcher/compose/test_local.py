"""Translation of a Compose service into a local process."""

from pathlib import Path

import pytest

from services.launcher.compose.compose_file import Service
from services.launcher.compose.local import LocalMachine, local_process
from services.map_store.integrity.backup import file_of

MACHINE = LocalMachine("/venv/bin/python", Path("/data"))
HOSTS = ("router", "map-store", "db")


def translate(**fields):
    return local_process("a", Service.model_validate({"command": ("x",), **fields}), HOSTS, MACHINE)


def test_python_becomes_the_launchers_own_and_other_commands_stay():
    assert translate(command=["python", "-m", "m"]).command == ("/venv/bin/python", "-m", "m")
    assert translate(command=["serve", "python"]).command == ("serve", "python")


def test_service_host_names_become_loopback_and_nothing_else_changes():
    environment = {
        "BUS": "tcp/router:7447",
        "URL": "http://map-store:8001/router:x",
        "DB": "postgresql://user:secret@db:5432/router",
        "OTHER": "http://myrouter:1 router",
    }
    assert translate(environment=environment).environment == {
        "BUS": "tcp/127.0.0.1:7447",
        "URL": "http://127.0.0.1:8001/router:x",
        "DB": "postgresql://user:secret@127.0.0.1:5432/router",
        "OTHER": "http://myrouter:1 router",
    }


@pytest.mark.parametrize("name", ["q?mode=memory", "pct%20x", "a#b", "with space", "ümlaut"])
def test_a_folder_of_any_name_is_itself_in_the_url_of_a_database(name):
    machine = LocalMachine("python", Path("/data") / name)
    fields = {"volumes": ["maps:/var/maps"], "environment": {"DB": "sqlite:////var/maps/m.sqlite3"}}
    spec = local_process("a", Service.model_validate({"command": ("x",), **fields}), HOSTS, machine)
    assert file_of(spec.environment["DB"]) == Path("/data") / name / "maps" / "m.sqlite3"


def test_a_named_volume_becomes_a_data_folder():
    spec = translate(volumes=["maps:/var/maps"], environment={"DB": "sqlite:////var/maps/m.sqlite3"})
    assert spec.environment == {"DB": "sqlite:////data/maps/m.sqlite3"}
    assert spec.data_folders == (Path("/data/maps"),)


def test_a_folder_of_the_machine_is_read_where_it_is_and_not_made(tmp_path):
    machine = LocalMachine("python", Path("/data"), root=tmp_path)
    mounted = {"volumes": ["./own:/files:ro", "maps:/maps"], "environment": {"WORLD": "/files/a.yaml"}}
    spec = local_process("a", Service.model_validate({"command": ("x",), **mounted}), HOSTS, machine)
    assert spec.environment == {"WORLD": str(tmp_path / "own" / "a.yaml")}
    assert spec.data_folders == (Path("/data/maps"),)


def test_the_liveliness_check_becomes_a_token_and_any_other_stays_a_command():
    by_token = translate(healthcheck={"test": ["CMD", "python", "-m", "shared.health", "map_store"]})
    assert (by_token.alive_as, by_token.check) == ("map_store", None)
    by_command = translate(healthcheck={"test": ["CMD", "python", "check.py"], "interval": "2s"})
    assert (by_command.alive_as, by_command.check) == (None, ("/venv/bin/python", "check.py"))
    assert by_command.check_interval_s == 2.0
    by_shell = translate(healthcheck={"test": ["CMD-SHELL", "true && true"]})
    assert by_shell.check == ("/bin/sh", "-c", "true && true")
    without = translate()
    assert (without.alive_as, without.check) == (None, None)


def test_restart_policy_and_needs_are_kept():
    spec = translate(
        restart="unless-stopped", depends_on={"router": {"condition": "service_healthy"}, "db": {}}
    )
    assert spec.restart
    assert spec.needs == {"router": True, "db": False}
    assert not translate().restart
