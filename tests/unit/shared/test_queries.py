"""Questions whose askers have given up: which are dropped, and how an asker says how long it waits."""

import contextlib
import threading

import pytest
import zenoh

from shared.bus import Bus, wait_until
from shared.messages.maps import MapRequest
from shared.messages.matching import MatchRequest
from shared.queries import AbsentError, TimedOutError
from shared.topics import MAP, MATCH, Query
from shared.wire import encode

SOON_S = 30.0

pytestmark = pytest.mark.usefixtures("patient_sessions")


@pytest.mark.parametrize(
    ("patience", "query", "dropped"),
    [
        (b"0", MATCH, True),
        (b"0", MAP, False),
        (None, MATCH, False),
        (b"600000", MATCH, False),
        (b"soon", MATCH, False),
        (b"0" * 1000, MATCH, False),
    ],
)
def test_only_questions_that_change_nothing_are_dropped_once_their_asker_has_given_up(
    here: Bus, there: Bus, patience: bytes | None, query: Query, dropped: bool
):
    name = {"robot": "r1"} if query is MATCH else {"map": "flat"}
    requests = here.requests(query, **name)
    payload = encode(MatchRequest(map="flat") if query is MATCH else MapRequest(action="read"))
    found: list = []

    def ask() -> None:
        list(there._session.get(query.key(**name), payload=payload, timeout=SOON_S, attachment=patience))

    def dealt_with() -> bool:
        asker = threading.Thread(target=ask)
        asker.start()
        while asker.is_alive():
            if (question := requests.take()) is not None:
                question.leave()
                found.append(question)
        return bool(found) or bool(here.counters.snapshot())  # peers find each other in their own time

    assert wait_until(dealt_with, SOON_S)
    assert (len(found), here.counters.snapshot()) == ((0, {"lapsed": 1}) if dropped else (1, {}))


def test_an_asker_says_how_long_it_waits_where_that_matters(here: Bus, there: Bus):
    told: list = []
    for query, key in ((MATCH, {"robot": "r1"}), (MAP, {"map": "flat"})):
        handler = zenoh.handlers.Callback(
            lambda asked: (told.append(asked.attachment and asked.attachment.to_bytes()), asked.drop()),
            indirect=False,
        )
        declared = here._session.declare_queryable(query.key(**key), handler)
        question = MatchRequest(map="flat") if query is MATCH else MapRequest(action="read")
        told.clear()

        def heard(query=query, key=key, question=question) -> bool:
            with contextlib.suppress(AbsentError, TimedOutError):
                there.ask(query, question, 0.25, **key)
            return bool(told)

        assert wait_until(heard, SOON_S)
        declared.undeclare()
        assert set(told) == {b"250" if query is MATCH else None}
