"""Processes to do harm to: a stack in real time that knows a small map, a drive service between stand-ins."""

import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import pytest

from services.launcher.client.stack import Stack, StackChoice, open_stack
from services.launcher.evaluation.exploration import Exploration, explore
from services.launcher.evaluation.rounds import Game
from simulator.world.freespace import FreeSpace, free_space
from simulator.world.world_file import load_world
from tests.integration.drive.conftest import neighbours as neighbours
from tests.integration.drive.conftest import start as start_drive

WORLD = "apartment"
MAP = "small"
STEPS = 60

__all__ = ["RealTime", "neighbours", "real_time", "start_drive"]


@dataclass(frozen=True)
class RealTime:
    """A running stack in real time and the map it knows."""

    stack: Stack
    space: FreeSpace
    result: Exploration
    game: Game


@pytest.fixture(scope="module")
def real_time(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RealTime]:
    """Explore a part of the apartment, then start again with the wall clock leading."""
    data_dir, space = tmp_path_factory.mktemp("stack"), free_space(load_world(WORLD))
    with open_stack(StackChoice(data_dir, WORLD, seed=1, lockstep=True)) as stack:
        result = explore(stack, WORLD, MAP, seed=1, max_steps=STEPS)
    with open_stack(StackChoice(data_dir, WORLD, seed=1, lockstep=False)) as stack:
        yield RealTime(stack, space, result, Game(stack, space, MAP, np.random.default_rng(1)))


@pytest.fixture
def rogue(router_endpoint: str) -> Iterator[Callable[..., subprocess.Popen[str]]]:
    """Start a process of tests.faults.rogue; returns it once it has said something."""
    processes: list[subprocess.Popen[str]] = []

    def start(*arguments: str) -> subprocess.Popen[str]:
        command = [sys.executable, "-m", "tests.faults.rogue", router_endpoint, *arguments]
        processes.append(subprocess.Popen(command, stdout=subprocess.PIPE, text=True))
        assert processes[-1].stdout is not None
        assert processes[-1].stdout.readline()
        return processes[-1]

    yield start
    for process in processes:
        process.kill()
        process.communicate()
