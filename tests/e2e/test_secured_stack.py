"""`topnav up --secure`: the whole stack over mTLS and access rules, and the shell on it."""

import json
import subprocess
import sys
from pathlib import Path

import httpx
import pytest

from services.launcher.client.address import find_address
from services.launcher.commands.robots.estop import ENGAGED, UNKNOWN
from services.launcher.processes.free_ports import free_ports
from shared.access.credentials import FILES
from shared.bus import wait_until
from shared.messages.estop import EStopRequest
from shared.queries import AbsentError
from shared.topics import ESTOP, TRUTH

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(900)]

STEPS = "12"
SERVICES = {"router", "map_store", "simulator", "features", "planner", "drive", "dispatch", "gateway"}


@pytest.fixture(scope="module")
def shell(tmp_path_factory, repository):
    """Call it with the words of a topnav command on the secured stack of this module."""
    data_dir, ports = tmp_path_factory.mktemp("secured"), free_ports(3)
    names = ("TOPNAV_ROUTER_PORT", "TOPNAV_GATEWAY_PORT", "TOPNAV_MAP_STORE_PORT")

    def topnav(*words, timeout_s=300):
        command = [sys.executable, "-m", "services.launcher", *words, "--data-dir", str(data_dir)]
        return subprocess.run(command, cwd=repository, capture_output=True, text=True, timeout=timeout_s)

    topnav.data_dir = data_dir
    with pytest.MonkeyPatch.context() as patch:
        for name, port in zip(names, ports, strict=True):
            patch.setenv(name, str(port))
        up = topnav("up", "--secure", "--detach", "--lockstep", "--world", "apartment", "--timeout-s", "240")
        assert up.returncode == 0, up.stderr
        yield topnav
        topnav("down")


@pytest.fixture(scope="module")
def status(shell):
    """As soon as all is well: a service that stood still for a moment is silent for that."""
    told = {}

    def healthy():
        told.update(json.loads(shell("status", "--json").stdout))
        return {service["state"] for service in told["services"].values()} == {"healthy"}

    assert wait_until(healthy, 60.0, 1.0), told
    return told


def test_every_process_is_healthy_and_knows_its_own_certificate_only(shell, status):
    assert {service["state"] for service in status["services"].values()} == {"healthy"}
    assert status["endpoint"].startswith("tls/")
    for name, service in status["services"].items():
        environment = environment_of(service["pid"])
        assert environment["TOPNAV_CERTS"] == str(shell.data_dir / "certs" / name.replace("-", "_"))
    for folder in (shell.data_dir / "certs").iterdir():
        assert folder.stat().st_mode & 0o077 == 0


def environment_of(pid):
    entries = Path(f"/proc/{pid}/environ").read_text(encoding="utf-8").split("\0")
    return dict(entry.split("=", 1) for entry in entries if "=" in entry)


@pytest.fixture(scope="module")
def mission(shell):
    """How a short exploration ended, which made the map "safe", and the states of the robot meanwhile."""
    address = find_address(None, shell.data_dir)
    with address.open() as bus:
        assert wait_until(lambda: set(bus.alive()) >= SERVICES, 60.0)
        truths = bus.subscribe(TRUTH, robot="r1")
        run = shell("explore", "--map", "safe", "--world", "apartment", "--max-steps", STEPS)
        return run, truths.take_all()


def test_a_mission_drives_and_writes_a_map(shell, mission):
    run, driven = mission
    assert f"not done within {STEPS} steps" in run.stderr
    moved_m = max(abs(t.pose.x_m - driven[0].pose.x_m) + abs(t.pose.y_m - driven[0].pose.y_m) for t in driven)
    assert moved_m > 0.3
    assert "safe" in shell("map", "list").stdout


def estop(shell, *words):
    """Exit code of the command; it is said again where drive did not answer in the two seconds it has."""
    codes = []
    assert wait_until(lambda: codes.append(shell("estop", *words).returncode) or codes[-1] != UNKNOWN, 60.0)
    return codes[-1]


def test_the_shell_stops_and_releases_the_robot(shell):
    assert estop(shell, "--why", "test") == 0
    assert estop(shell, "--status") == ENGAGED
    assert estop(shell, "--clear", "--who", "anna") == 0
    assert estop(shell, "--status") == 0


def test_a_recording_has_every_stream_that_flows(shell, tmp_path):
    run = shell("record", str(tmp_path / "one.mcap"), "--seconds", "8")
    assert run.returncode == 0, run.stderr
    for topic in ("frame", "ranges", "features", "stopped", "standing"):
        assert f"topnav/r1/{topic}" in run.stdout
    replay = shell("replay", str(tmp_path / "one.mcap"))
    assert replay.returncode == 1
    assert "is secured" in replay.stderr


@pytest.mark.usefixtures("mission")
def test_the_console_reads_maps_over_its_certificate_and_nobody_without(status):
    maps = httpx.get(f"{status['gateway_url']}/api/maps", trust_env=False, timeout=30.0).raise_for_status()
    assert "safe" in [entry["name"] for entry in maps.json()]
    plain = status["map_store_url"].replace("https:", "http:")
    with pytest.raises(httpx.TransportError):
        httpx.get(f"{plain}/maps", trust_env=False)


def test_a_viewers_certificate_stops_nothing_on_the_running_stack(shell, status, monkeypatch):
    monkeypatch.setenv("TOPNAV_CERTS", str(shell.data_dir / "certs" / "viewer"))
    elsewhere = find_address(status["endpoint"], shell.data_dir / "nowhere")
    with elsewhere.open() as bus, pytest.raises(AbsentError):
        bus.ask(ESTOP, EStopRequest(action="engage", who="thief"), 2.0, robot="r1")
    assert estop(shell, "--status") == 0


def test_a_stack_with_a_damaged_certificate_does_not_start(shell, repository, tmp_path):
    folder = tmp_path / "certs" / "drive"
    folder.mkdir(parents=True)
    for name in FILES:
        (folder / name).write_bytes((shell.data_dir / "certs" / "drive" / name).read_bytes())
    command = [sys.executable, "-m", "services.launcher", "up", "--secure", "--data-dir", str(tmp_path)]
    run = subprocess.run(command, cwd=repository, capture_output=True, text=True, timeout=300)
    assert run.returncode == 1
    assert "certificate of drive: not signed by the authority of this folder" in run.stderr
    assert len(run.stderr.strip().splitlines()) == 1
