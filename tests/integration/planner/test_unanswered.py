"""A planner whose questions nobody answers: whoever listens must not take its robot for gone."""

import time

import numpy as np
import pytest

from shared.bus import Bus, wait_until
from shared.messages.features import Features
from shared.messages.matching import MatchReply, MatchRequest
from shared.messages.sensors import Ranges
from shared.queries import Request
from shared.topics import FEATURES, MATCH, RANGES, STATUS
from tests.integration.map_store.conftest import START_S
from tests.integration.map_store.conftest import bus as bus
from tests.integration.map_store.conftest import process as process
from tests.integration.planner.test_end_of_a_mission import ask, end
from tests.integration.planner.test_end_of_a_mission import planner as planner

pytestmark = pytest.mark.usefixtures("patient_sessions")

WAITED_S = 4.0
"""Shorter than a planner waits for an answer."""


class Asked:
    """A planner that heads for a picture and asks about its frame."""

    def __init__(self, bus: Bus) -> None:
        self.statuses, self.matches = bus.subscribe(STATUS, robot="r1"), bus.requests(MATCH, robot="r1")
        self._features, self._ranges = bus.publisher(FEATURES, robot="r1"), bus.publisher(RANGES, robot="r1")
        end(bus)  # there is a map now
        ask(bus, action="goto", map="flat", goal=picture(seq=0))

    def question(self) -> Request[MatchRequest, MatchReply]:
        """The next question."""
        found: list[Request[MatchRequest, MatchReply]] = []

        def came() -> bool:
            self._features.put(picture(seq=1))
            self._ranges.put(free_ground())
            question = self.matches.take()
            found.extend([] if question is None else [question])
            return bool(found)

        assert wait_until(came, START_S)
        return found[0]

    def states_within(self, wait_s: float) -> list[str]:
        """States that the planner tells from now on."""
        self.statuses.take_all()
        until_s, told = time.monotonic() + wait_s, []
        while (status := self.statuses.wait(max(until_s - time.monotonic(), 0.0))) is not None:
            told.append(status.state)
        return told


def test_while_it_waits_for_an_answer_it_says_once_a_second_that_it_is_there(bus: Bus, planner):
    planner()
    asked = Asked(bus)
    question = asked.question()
    told = asked.states_within(WAITED_S)
    assert (set(told), len(told) >= 3) == ({"running"}, True)
    question.leave()


def test_where_its_questions_are_refused_it_says_so_too(bus: Bus, planner):
    planner()
    asked = Asked(bus)
    told, until_s = [], time.monotonic() + WAITED_S
    while time.monotonic() < until_s:
        asked.question().refuse("frame 1 is not kept", "passing")
        told.extend(status.state for status in asked.statuses.take_all())
    assert told[-2:] == ["running"] * 2


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
