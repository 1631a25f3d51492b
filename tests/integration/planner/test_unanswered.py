"""A planner whose questions nobody answers: whoever listens must not take its robot for gone."""

import numpy as np
import pytest

from shared.bus import Bus, wait_until
from shared.messages.features import Features
from shared.messages.matching import MatchReply, MatchRequest
from shared.messages.missions import MissionStatus
from shared.messages.sensors import Ranges
from shared.queries import Requests
from shared.topics import FEATURES, MATCH, RANGES, STATUS
from tests.integration.map_store.conftest import START_S
from tests.integration.map_store.conftest import bus as bus
from tests.integration.map_store.conftest import process as process
from tests.integration.planner.test_end_of_a_mission import ask, end
from tests.integration.planner.test_end_of_a_mission import planner as planner

pytestmark = pytest.mark.usefixtures("patient_sessions")

QUESTIONS = 40
"""In one and a half seconds a question is asked some fifteen times, for nobody may be there yet."""


def test_it_says_all_the_while_that_it_is_there(bus: Bus, planner):
    planner()
    statuses, matches = bus.subscribe(STATUS, robot="r1"), bus.requests(MATCH, robot="r1")
    features, ranges = bus.publisher(FEATURES, robot="r1"), bus.publisher(RANGES, robot="r1")
    end(bus)  # there is a map now
    ask(bus, action="goto", map="flat", goal=picture(seq=0))
    asked: list[MatchRequest] = []
    told: list[MissionStatus] = []

    def look() -> bool:
        features.put(picture(seq=1))
        ranges.put(free_ground())
        asked.extend(unanswered(matches))
        if len(asked) == 1:
            statuses.take_all()
        told.extend(statuses.take_all() if asked else [])
        return len(asked) >= QUESTIONS

    assert wait_until(look, START_S)
    assert {status.state for status in told} == {"running"}
    assert len(told) >= 2


def picture(seq: int) -> Features:
    """Features of a picture."""
    lonlat, scores, descriptors = np.zeros((1, 2), "f4"), np.ones(1, "f4"), np.zeros((1, 128), "u1")
    return Features(
        robot="r1",
        seq=seq,
        stamp_ns=1,
        pipeline="p",
        lonlat_rad=lonlat,
        scores=scores,
        descriptors=descriptors,
    )


def free_ground() -> Ranges:
    """Distances with nothing nearby."""
    angles, distances = np.linspace(-3.0, 3.0, 12, dtype="f4"), np.full(12, 2.0, "f4")
    return Ranges(seq=1, stamp_ns=1, robot="r1", angles_rad=angles, distances_m=distances, max_range_m=2.5)


def unanswered(matches: Requests[MatchRequest, MatchReply]) -> list[MatchRequest]:
    """The questions that wait, each of them left without an answer."""
    found = []
    while (question := matches.take()) is not None:
        question.leave()
        found.append(question.message)
    return found
