"""A stack in real time, with a small map that was explored in lockstep before."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pytest

from experiments.exploration import Exploration, explore
from experiments.rounds import Game
from experiments.stack import Stack, StackChoice, open_stack
from simulator.freespace import FreeSpace, free_space
from simulator.world_file import load_world

WORLD = "apartment"
MAP = "small"
STEPS = 60


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
