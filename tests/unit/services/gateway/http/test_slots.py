"""Places: in all, for one client, and free again whatever happens."""

import contextlib

import pytest

from services.gateway.http.slots import Slots
from shared.web.problems import ProblemError


def test_one_client_cannot_take_all_places() -> None:
    slots = Slots("uploads", most=3, most_per_client=2)
    with slots.hold("a"), slots.hold("a"):
        with pytest.raises(ProblemError) as caught, slots.hold("a"):
            pass
        assert (caught.value.status_code, caught.value.code) == (429, "too_many_uploads")
        with slots.hold("b"):
            with pytest.raises(ProblemError) as caught, slots.hold("c"):
                pass
            assert caught.value.status_code == 503
    assert slots.taken == 0


def test_places_are_free_again_after_an_error_and_nobody_is_remembered() -> None:
    slots = Slots("uploads", most=1, most_per_client=1)
    for number in range(5):
        with contextlib.suppress(RuntimeError), slots.hold(f"client {number}"):
            raise RuntimeError
    assert slots.taken == 0
    assert not slots._open
