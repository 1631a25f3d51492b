"""One stack in lockstep, with a small map explored in it, for all end-to-end tests of a session."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import httpx
import numpy as np
import pytest

from services.launcher.client.stack import Stack, StackChoice, open_stack
from services.launcher.evaluation.exploration import Exploration, explore
from services.launcher.evaluation.rounds import Game
from simulator.world.freespace import FreeSpace, free_space
from simulator.world.world_file import load_world

WORLD = "apartment"
MAP = "small"
WAIT_S = 60.0
STEPS = 80
PATIENT = {
    "GATEWAY_ASK_TIMEOUT_S": "60",
    "GATEWAY_COMPUTE_TIMEOUT_S": "60",
    "MAP_STORE_COMPUTE_TIMEOUT_S": "60",
}
"""On a busy machine services stand still for seconds; the console shall not call them slow for that."""

OWN = {"PLANNER_MISSIONS_FOLDER": str(Path(__file__).with_name("own_missions"))}


@dataclass(frozen=True)
class Explored:
    """A running stack and what was explored in it."""

    stack: Stack
    space: FreeSpace
    result: Exploration
    game: Game
    data_dir: Path


@pytest.fixture(scope="session")
def explored(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Explored]:
    """A part of the apartment, explored in a limited number of steps."""
    data_dir = tmp_path_factory.mktemp("stack")
    space = free_space(load_world(WORLD))
    with open_stack(StackChoice(data_dir, WORLD, seed=1, lockstep=True, environment=PATIENT | OWN)) as stack:
        result = explore(stack, WORLD, MAP, seed=1, max_steps=STEPS)
        game = Game(stack, space, MAP, np.random.default_rng(1))
        yield Explored(stack, space, result, game, data_dir)


@pytest.fixture
def http(explored: Explored) -> Iterator[httpx.Client]:
    """A client of the stack's gateway."""
    with httpx.Client(base_url=str(explored.stack.gateway_url), trust_env=False, timeout=WAIT_S) as client:
        yield client
