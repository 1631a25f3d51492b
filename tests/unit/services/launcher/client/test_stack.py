"""A stack that was joined may run another world than the one named."""

from pathlib import Path

import pytest

from services.launcher.client.address import Address
from services.launcher.client.stack import Stack, other_world

ATTIC = str(Path("attic.yaml").absolute())


def joined(world):
    return Stack(None, Address("tcp/127.0.0.1:7447"), None, None, world=world)


@pytest.mark.parametrize(("runs", "named"), [("office", "office"), (ATTIC, "attic.yaml"), ("", "apartment")])
def test_nothing_is_said_where_it_is_the_same_world_or_nobody_knows(runs, named):
    assert other_world(joined(runs), named) == ""


@pytest.mark.parametrize(("runs", "named"), [("office", "apartment"), ("attic", "attic.yaml")])
def test_a_stack_in_another_world_is_told_with_what_to_do(runs, named):
    told = other_world(joined(runs), named)
    assert f"runs in {runs}, not in {named}" in told
    assert f"--world {runs}" in told
