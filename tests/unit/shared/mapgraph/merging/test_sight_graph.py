"""What the nodes of a map see of one another, and the way along them."""

import math

import pytest

from tests.merge_world import Streets, map_of, seen


def test_a_chain_adds_up_the_yaws_on_the_way():
    world = Streets(3)
    exact = map_of(world.base, world.rng)
    chains = exact.chains(2)
    assert chains[9].hops == 7
    for node in (3, 9, 40):
        assert math.remainder(chains[node].yaw_rad - seen(world.base[2], world.base[node])[1], math.tau) == (
            pytest.approx(0.0, abs=1e-9)
        )
