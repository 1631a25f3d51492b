"""Cookies: whose, how long, and what makes one worthless."""

import pytest

from services.gateway.auth.sessions import LIFETIME_S, Sessions
from shared.access.tokens import Token, digest_of

ANNA = Token(name="anna", role="viewer", sha256=digest_of("s1"))


def holder(sessions: Sessions, cookie: str, token: Token = ANNA, now_s: float = 1000.0) -> Token | None:
    return sessions.token_of(cookie, {token.name: token}.get, now_s)


def test_a_cookie_names_its_holder_and_ends() -> None:
    sessions = Sessions()
    cookie = sessions.issue(ANNA, 1000.0)
    assert cookie.startswith("anna|")
    assert holder(sessions, cookie) == ANNA
    assert holder(sessions, cookie, now_s=999.0 + LIFETIME_S) == ANNA
    assert holder(sessions, cookie, now_s=1001.0 + LIFETIME_S) is None


def test_a_cookie_is_of_one_token_and_one_process() -> None:
    sessions = Sessions()
    cookie = sessions.issue(ANNA, 1000.0)
    assert holder(sessions, cookie, ANNA.model_copy(update={"sha256": digest_of("s2")})) is None
    assert holder(sessions, cookie, ANNA.model_copy(update={"name": "bert"})) is None
    assert holder(Sessions(), cookie) is None


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
        "anna|" + "9" * 300 + "|y",
        "anna|" + "x" * 300,
        "anna",
        "",
    ],
)
def test_forged_cookies_are_worthless(forged: str) -> None:
    assert holder(Sessions(), forged) is None


def test_a_longer_life_cannot_be_written_in() -> None:
    sessions = Sessions()
    name, until, seal = sessions.issue(ANNA, 1000.0).split("|")
    assert holder(sessions, f"{name}|{int(until) + 1}|{seal}") is None
