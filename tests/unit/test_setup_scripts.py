"""deploy/setup/*.sh with stand-ins for apt, dpkg and id: nothing is installed."""

import os
import subprocess

import pytest

BOOKWORM, TRIXIE = "bookworm", "trixie"


class Machine:
    """A made-up Debian: PATH holds stand-ins that log what they were asked."""

    def __init__(self, folder, script):
        self.folder, self.script = folder, script
        self.bin, self.log, self.sources = folder / "bin", folder / "log", folder / "topnav.list"
        self.bin.mkdir()
        self.version, self.offered = folder / "installed", folder / "offered"
        for name in ("bash", "sed", "grep", "sh", "cat", "ls"):
            self.command(name, None)

    def command(self, name, body):
        path = self.bin / name
        if body is None:
            path.symlink_to(f"/bin/{name}" if os.path.exists(f"/bin/{name}") else f"/usr/bin/{name}")  # noqa: PTH110
        else:
            path.write_text(f"#!/bin/sh\n{body}\n", encoding="utf-8")
            path.chmod(0o755)

    def describe(self, codename, installed, offered, after_install="", uid=0):
        """Set the release, the versions before and after, and who we are."""
        (self.folder / "os-release").write_text(f"VERSION_CODENAME={codename}\n", encoding="utf-8")
        self.version.write_text(f"installed {installed}" if installed else "", encoding="utf-8")
        self.command("id", f"echo {uid}")
        self.command("dpkg-query", f"cat {self.version}")
        self.command("dpkg", 'exec /usr/bin/dpkg "$@"')
        self.command("apt-cache", f'echo "  Candidate: {offered or "(none)"}"')
        install = f'case "$*" in *install*) echo "installed {after_install}" > {self.version};; esac'
        self.command("apt-get", f'echo "$*" >> {self.log}; {install}')

    def run(self):
        environment = {
            "PATH": str(self.bin),
            "TOPNAV_OS_RELEASE": str(self.folder / "os-release"),
            "TOPNAV_BACKPORTS_LIST": str(self.sources),
            "TOPNAV_NVIDIA_VERSION": str(self.folder / "nvidia"),
            "TOPNAV_POSTGRES_FOLDER": str(self.folder / "postgresql"),
        }
        command = ["/bin/bash", str(self.script)]
        return subprocess.run(
            command, env=environment, capture_output=True, text=True, timeout=30, check=False
        )

    @property
    def installs(self):
        asked = self.log.read_text(encoding="utf-8").splitlines() if self.log.exists() else []
        return [line for line in asked if line.startswith("install")]


@pytest.fixture
def machine(tmp_path, repository):
    if not os.access("/usr/bin/dpkg", os.X_OK):
        pytest.skip("compares Debian version numbers with dpkg, which this machine lacks")
    return Machine(tmp_path, repository / "deploy/setup/vulkan.sh")


def test_a_driver_that_is_new_enough_is_left_alone(machine):
    machine.describe(BOOKWORM, installed="25.0.7-2~bpo12+1", offered="25.0.7-2~bpo12+1")
    assert machine.run().returncode == 0
    assert not machine.log.exists()


def test_an_nvidia_driver_is_enough(machine):
    machine.describe(BOOKWORM, installed="", offered="22.3.6")
    (machine.folder / "nvidia").touch()
    assert machine.run().returncode == 0
    assert not machine.log.exists()


def test_root_on_debian_12_gets_the_backport_and_its_source(machine):
    machine.describe(BOOKWORM, installed="22.3.6-1", offered="22.3.6-1", after_install="25.0.7-2~bpo12+1")
    run = machine.run()
    assert run.returncode == 0, run.stderr
    assert machine.installs == ["install -y -t bookworm-backports mesa-vulkan-drivers libvulkan1"]


def test_root_on_debian_13_installs_plainly(machine):
    machine.describe(TRIXIE, installed="", offered="25.0.7-2", after_install="25.0.7-2")
    assert machine.run().returncode == 0
    assert machine.installs == ["install -y mesa-vulkan-drivers libvulkan1"]
    assert not machine.sources.exists()


def test_others_are_told_the_exact_command_and_it_stops(machine):
    machine.describe(BOOKWORM, installed="22.3.6-1", offered="22.3.6-1", uid=1000)
    run = machine.run()
    assert run.returncode == 1
    assert "sudo apt-get install -y -t bookworm-backports mesa-vulkan-drivers libvulkan1" in run.stderr
    assert not machine.log.exists()


def test_a_release_without_a_new_enough_driver_is_named(machine):
    machine.describe("bullseye", installed="20.3", offered="20.3")
    run = machine.run()
    assert run.returncode == 1
    assert "No Mesa Vulkan driver 24.3 or newer for 'bullseye'" in run.stderr
    assert machine.installs == []


@pytest.fixture
def bare_machine(tmp_path, repository):
    machine = Machine(tmp_path, repository / "deploy/setup/test_programs.sh")
    machine.describe(BOOKWORM, installed="", offered="")
    return machine


def test_root_gets_the_programs_of_the_tests_that_are_missing(bare_machine):
    bare_machine.command("chromium", "true")
    assert bare_machine.run().returncode == 0
    assert bare_machine.installs == ["install -y --no-install-recommends postgresql"]


def test_programs_that_are_there_are_left_alone(bare_machine):
    bare_machine.command("google-chrome", "true")
    server = bare_machine.folder / "postgresql/15/bin/initdb"
    server.parent.mkdir(parents=True)
    server.touch()
    assert bare_machine.run().returncode == 0
    assert not bare_machine.log.exists()


def test_others_are_told_what_is_skipped_and_the_tests_go_on(bare_machine):
    bare_machine.command("id", "echo 1000")
    run = bare_machine.run()
    assert run.returncode == 0
    assert "sudo apt-get install -y --no-install-recommends chromium postgresql" in run.stderr
    assert not bare_machine.log.exists()


def test_a_machine_without_packages_to_install_goes_on(bare_machine):
    bare_machine.command("apt-get", "exit 100")
    run = bare_machine.run()
    assert run.returncode == 0
    assert "the tests that need them are skipped" in run.stderr
