"""Passes: whose, how long, and what makes one worthless."""

import pytest

from services.gateway.auth.passes import LIFETIME_S, Passes
from shared.access.token import Token, digest_of

ANNA = Token(name="anna", role="viewer", sha256=digest_of("s1"))


def test_a_pass_names_its_holder_and_ends() -> None:
    passes = Passes()
    value = passes.issue(ANNA, 1000.0)
    assert passes.name_of(value) == "anna"
    assert passes.good(value, ANNA, 1000.0)
    assert passes.good(value, ANNA, 999.0 + LIFETIME_S)
    assert not passes.good(value, ANNA, 1001.0 + LIFETIME_S)


def test_a_pass_is_of_one_token_and_one_process() -> None:
    passes = Passes()
    value = passes.issue(ANNA, 1000.0)
    assert not passes.good(value, ANNA.model_copy(update={"sha256": digest_of("s2")}), 1000.0)
    assert not Passes().good(value, ANNA, 1000.0)


@pytest.mark.parametrize(
    "forged",
    [
        "anna|99999999999|",
        "anna|99999999999|" + "0" * 64,
        "anna||",
        "anna|x|y",
        "anna|1e99|y",
        "anna|²|y",
        "anna|99999999999|ä",
        "anna|9|9|9",
        "anna",
    ],
)
def test_forged_passes_are_worthless(forged: str) -> None:
    assert not Passes().good(forged, ANNA, 1000.0)


@pytest.mark.parametrize("value", ["", "anna", "anna|" + "x" * 300])
def test_what_is_no_pass_has_no_name(value: str) -> None:
    assert Passes.name_of(value) is None


def test_a_longer_life_cannot_be_written_in() -> None:
    passes = Passes()
    name, until, seal = passes.issue(ANNA, 1000.0).split("|")
    assert not passes.good(f"{name}|{int(until) + 1}|{seal}", ANNA, 1000.0)
