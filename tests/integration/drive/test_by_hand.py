"""A person drives over a real bus: without a planner, in place of one, for as long as they say so."""

import time

from shared.messages.drive import Manual
from shared.topics import MANUAL
from tests.integration.drive.conftest import SOON_S
from tests.integration.drive.test_drive_process import go, several, still

TTL_MS = 400


class Person:
    def __init__(self, neighbours, who):
        self._out, self.who, self._seq = neighbours.bus.publisher(MANUAL, robot="r1"), who, 0

    def says(self, action="drive", ttl_ms=TTL_MS, **more):
        self._seq += 1
        self._out.put(Manual(robot="r1", seq=self._seq, who=self.who, action=action, ttl_ms=ttl_ms, **more))


def by(person, neighbours, near_m=4.0, **wished):
    """What a robot says of each frame while somebody drives it."""

    def act():
        neighbours.see(neighbours.frame(), near_m=near_m)
        person.says(**wished)

    return act


def test_a_person_drives_without_any_planner_and_what_they_leave_stands(start, neighbours):
    start()
    ada = Person(neighbours, "Ada")
    assert neighbours.drives(by(ada, neighbours, forward_mps=0.2, turn_radps=0.4))
    newest = neighbours.newest
    assert (newest.forward_mps, newest.turn_radps, newest.why) == (0.2, 0.4, "by hand: Ada")
    silent_s = time.monotonic()
    came = neighbours.commands(
        0.1, lambda: neighbours.see(neighbours.frame()), lambda came: came and came[-1].stands
    )
    assert came[-1].stands
    assert time.monotonic() - silent_s < SOON_S


def test_a_hand_comes_before_the_planner_until_it_lets_go(start, neighbours):
    start()
    assert neighbours.drives(go(neighbours))
    ada = Person(neighbours, "Ada")

    def both():
        go(neighbours)()
        ada.says(left_mps=0.1)

    came = neighbours.commands(0.6, both, lambda came: several([c for c in came if "Ada" in c.why]))
    first = next(place for place, command in enumerate(came) if command.why == "by hand: Ada")
    assert {command.why for command in came[first:]} == {"by hand: Ada"}
    ada.says("release")
    after = neighbours.commands(0.3, lambda: neighbours.see(neighbours.frame()))
    assert still(after[1:])
    assert neighbours.drives(go(neighbours))


def test_a_second_person_does_not_take_the_robot(start, neighbours):
    """The first one's wishes live long enough for a test that is held up."""
    start()
    ada, bob = Person(neighbours, "Ada"), Person(neighbours, "Bob")
    assert neighbours.drives(by(ada, neighbours, forward_mps=0.2, ttl_ms=1_000))

    def both():
        by(ada, neighbours, forward_mps=0.2, ttl_ms=1_000)()
        bob.says(forward_mps=-0.2)

    came = neighbours.commands(0.6, both, several)
    assert {command.why for command in came} == {"by hand: Ada"}


def test_the_emergency_stop_holds_a_hand_and_what_is_near_slows_it(start, neighbours):
    start()
    ada = Person(neighbours, "Ada")
    assert neighbours.drives(by(ada, neighbours, forward_mps=0.5))
    came = neighbours.commands(0.4, by(ada, neighbours, near_m=0.26, forward_mps=0.5), several)
    assert came[-1].forward_mps < 0.02
    neighbours.estop("engage", who="eve", why="a child")
    came = neighbours.commands(0.6, by(ada, neighbours, forward_mps=0.5))
    assert still(came[1:])


def test_in_lockstep_a_hand_answers_each_frame_once(start, neighbours):
    start()
    ada, stamp_ns = Person(neighbours, "Ada"), time.time_ns()

    def ask():
        neighbours.see(7, stamp_ns=stamp_ns, lockstep=True)
        ada.says(forward_mps=0.2)

    came = neighbours.commands(0.3, ask, several)
    assert {(command.seq, command.forward_mps) for command in came} == {(7, 0.2)}
