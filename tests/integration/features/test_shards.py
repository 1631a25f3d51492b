"""Several robots on several feature services: who takes whose frames, one answer each, and turns for all."""

import statistics
import threading
from collections import Counter
from collections.abc import Callable, Iterator
from itertools import count

import pytest
import zenoh

from services.features.service import run
from services.features.settings import FeaturesSettings
from shared.bus import Bus, Inbox, open_bus, wait_until
from shared.messages.features import ExtractRequest, Features
from shared.messages.matching import MatchRequest
from shared.messages.sensors import Frame
from shared.topics import EXTRACT, FEATURES, FRAME, MATCH
from shared.wire import encode
from tests.integration.features.test_feature_service import frame_at

ROBOTS = ("r1", "r2", "r3")
ANSWER_S, AGAIN_S = 60.0, 3.0


@pytest.fixture
def serve(endpoint: str, bus: Bus) -> Iterator[Callable[[str], None]]:
    """Start a feature service for some robots, on a session of its own."""
    stop, threads = threading.Event(), []

    def start(robots: str) -> None:
        settings = FeaturesSettings(endpoint=endpoint, robots=robots, threads=1)

        def loop() -> None:
            with open_bus(endpoint) as mine:
                run(settings, mine, stop)

        threads.append(threading.Thread(target=loop))
        threads[-1].start()
        assert wait_until(lambda: len(bus.alive("features")) == len(threads), ANSWER_S)

    yield start
    stop.set()
    for thread in threads:
        thread.join()


class Robot:
    """Sends frames and counts what comes back."""

    def __init__(self, bus: Bus, name: str) -> None:
        self.name = name
        self._publisher = bus.publisher(FRAME, robot=name)
        self._inbox: Inbox[Features] = bus.subscribe(FEATURES, robot=name)
        self._numbers = count()
        self._frame = frame_at(0.0, 0.0).model_copy(update={"robot": name})
        self.answers: Counter[int] = Counter()

    def send(self) -> int:
        """Send the next frame."""
        seq = next(self._numbers)
        again: Frame = self._frame.model_copy(update={"seq": seq, "stamp_ns": seq + 1, "lockstep": False})
        self._publisher.put(again)
        return seq

    def read(self) -> int:
        """Count what has come; how many features altogether."""
        for features in self._inbox.take_all():
            assert features.robot == self.name
            self.answers[features.seq] += 1
        return sum(self.answers.values())

    def send_and_wait(self) -> int:
        """Send a frame and wait for its features; the number of the frame.

        Frames and features are dropped under load, so after a while the next one is sent.
        """
        sent: list[int] = []

        def answered() -> bool:
            sent.append(self.send())
            return wait_until(lambda: bool(self.read()) and sent[-1] in self.answers, AGAIN_S)

        assert wait_until(answered, ANSWER_S), (self.name, sent)
        return sent[-1]


def met(robot: Robot) -> None:
    """Until the service hears this robot: what is sent before that is lost."""
    assert wait_until(lambda: robot.send() >= 0 and robot.read() > 0, ANSWER_S, period_s=0.2)


def test_two_services_share_three_robots_and_answer_each_frame_once(
    serve: Callable[[str], None], bus: Bus
) -> None:
    serve("r1,r3")
    serve("r2")
    robots = [Robot(bus, name) for name in ROBOTS]
    for robot in robots:
        met(robot)
    sent = {robot.name: [robot.send_and_wait() for _ in range(5)] for robot in robots}
    for robot in robots:
        robot.read()
        assert len(set(sent[robot.name])) == 5
        assert set(robot.answers.values()) == {1}, robot.name
        reply = bus.ask(MATCH, MatchRequest(map="flat", seq=sent[robot.name][-1]), ANSWER_S, robot=robot.name)
        assert reply.seq == sent[robot.name][-1]


def test_a_goal_picture_is_worked_on_by_one_service_only(serve: Callable[[str], None], bus: Bus) -> None:
    serve("r1")
    serve("r2,r3")
    request = encode(ExtractRequest(frame=frame_at(0.0, 0.0, seq=4)))
    for _ in range(3):
        answers = list(
            bus._session.get(
                EXTRACT.key(), payload=request, timeout=ANSWER_S, consolidation=zenoh.ConsolidationMode.NONE
            )
        )
        assert [answer.ok is not None for answer in answers] == [True]


def test_a_robot_that_floods_the_service_leaves_the_others_their_turn(
    serve: Callable[[str], None], bus: Bus
) -> None:
    serve("r1,r2")
    loud, quiet = Robot(bus, "r1"), Robot(bus, "r2")
    met(loud)
    met(quiet)
    enough = threading.Event()

    def flood() -> None:
        while not enough.wait(0.005):
            loud.send()
            loud.read()

    thread = threading.Thread(target=flood)
    thread.start()
    try:
        assert wait_until(lambda: loud.answers.total() > 10, ANSWER_S)
        between = []
        for _ in range(7):
            before = loud.answers.total()
            quiet.send_and_wait()
            between.append(loud.answers.total() - before)
    finally:
        enough.set()
        thread.join()
    # A frame may get lost beside many; it is sent again after seconds, in which the other goes on.
    assert statistics.median(between) <= 4, "one frame of each in turn, and what was on its way"
