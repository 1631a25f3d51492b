"""What the experimenter asks and sees passes by ROS: true states and requests between the two buses.

No service hears it: TRUTH and SIMULATION are for evaluation only, as with a simulator of the stack itself.
"""

import threading

from shared.bus import Bus
from shared.queries import QueryError
from shared.topics import SIMULATION, TRUTH

PERIOD_S = 0.05
ANSWER_S = 25.0
"""Less than the experimenter waits (services/launcher/client/experimenter.py)."""


class TruthRelay:
    """Between the simulator's bus and the stack's, where it stands in for the simulator.

    Args:
        simulator: the bus of the simulator.
        stack: the bus of the stack whose robot it is.
        robot: name on both.
    """

    def __init__(self, simulator: Bus, stack: Bus, robot: str) -> None:
        self._simulator, self._robot = simulator, robot
        self._truths = simulator.subscribe(TRUTH, robot=robot)
        self._told = stack.publisher(TRUTH, robot=robot)
        self._requests = stack.requests(SIMULATION, robot=robot)
        self._end = threading.Event()
        self._threads = [threading.Thread(target=one, daemon=True) for one in (self._tell, self._answer)]
        stack.announce("simulator")
        for thread in self._threads:
            thread.start()

    def close(self) -> None:
        """Relay no more."""
        self._end.set()
        for thread in self._threads:
            thread.join()

    def _tell(self) -> None:
        while not self._end.is_set():
            self._simulator.wait(PERIOD_S)
            for truth in self._truths.take_all():
                self._told.put(truth)

    def _answer(self) -> None:
        while not self._end.wait(PERIOD_S):
            while (request := self._requests.take()) is not None:
                try:
                    request.reply(
                        self._simulator.ask(SIMULATION, request.message, ANSWER_S, robot=self._robot)
                    )
                except QueryError as error:
                    request.refuse(str(error))
