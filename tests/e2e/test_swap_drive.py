"""A drive controller that knows only the schemas takes the place of ours."""

import subprocess
import sys
from collections.abc import Iterator

import numpy as np
import pytest

from services.launcher.client.address import Address
from services.launcher.client.stack import ROBOT, Stack
from services.launcher.evaluation.exploration import explore
from services.launcher.evaluation.rounds import Game
from services.launcher.processes.supervisor import Launcher
from shared.bus import open_bus, wait_until
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world
from tests.e2e.closet import CLOSET
from tests.e2e.near_node import hiding_place_near_a_node

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(600)]

WORLD = "closet.yaml"
OURS = ("map-store", "simulator", "features", "planner")


@pytest.fixture
def stack(tmp_path, repository) -> Iterator[Stack]:
    """All but our drive service, and the script instead."""
    script = repository / "deploy/examples/swap_drive.py"
    (tmp_path / WORLD).write_text(CLOSET)
    with Launcher(tmp_path, world=str(tmp_path / WORLD), lockstep=True, seed=1, only=OURS) as launcher:
        other = subprocess.Popen([sys.executable, str(script), launcher.endpoint, ROBOT], cwd=tmp_path)
        try:
            with open_bus(launcher.endpoint) as bus:
                assert wait_until(lambda: bool(bus.alive("drive")), timeout_s=60.0)
                yield Stack(bus, Address(launcher.endpoint), None, launcher)
        finally:
            other.kill()
            other.wait()


def test_the_script_imports_nothing_of_this_project(repository):
    source = (repository / "deploy/examples/swap_drive.py").read_text(encoding="utf-8")
    for package in ("shared", "services", "simulator", "experiments"):
        assert f"import {package}" not in source
        assert f"from {package}" not in source


def test_a_mission_succeeds_with_the_other_controller(stack, tmp_path):
    world = str(tmp_path / WORLD)
    space = free_space(load_world(world))
    result = explore(stack, world, "swap", seed=1, max_steps=40)
    assert len(result.graph.nodes) > 3
    game = Game(stack, space, "swap", np.random.default_rng(1))
    start = game.begin(seed=1).pose
    played = game.seek(start, hiding_place_near_a_node(result, space, start), seed=2, max_steps=200)
    assert played.success, played.run.status.reason
