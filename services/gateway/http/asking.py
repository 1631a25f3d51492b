"""Questions to other services from asyncio: a small thread pool, and bus errors as problems."""

import asyncio
import threading
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from services.gateway.http.metrics import Metrics
from shared.bus import Bus
from shared.messages.base import Message
from shared.queries import AbsentError, RefusedError, TimedOutError
from shared.topics import Query
from shared.web.problems import ProblemError
from shared.wire import WireError

Q = TypeVar("Q", bound=Message)
R = TypeVar("R", bound=Message)

THREADS = 16
"""Questions asked at once; chosen: each waits on a thread, and several consoles ask few."""
WAITING = 3
"""For each thread: more questions are refused at once instead of piling up behind a service that hangs."""


class Asker:
    """Asks on threads; raises `ProblemError` where the bus raises its own errors.

    Args:
        bus: to ask on.
        metrics: what to count in.
        threads: questions asked at once; three times as many may be on their way.
    """

    def __init__(self, bus: Bus, metrics: Metrics, threads: int = THREADS) -> None:
        self._bus, self._metrics, self._most = bus, metrics, WAITING * threads
        self._pool = ThreadPoolExecutor(threads, thread_name_prefix="ask")
        self._waiting = 0
        self._closed = threading.Event()

    async def ask(self, service: str, query: Query[Q, R], request: Q, timeout_s: float, **names: str) -> R:
        """Ask `service`.

        Raises:
            ProblemError: 503 absent or busy, 504 too slow, 409 refused (422 for good), 502 answered nonsense.
        """
        if self._waiting >= self._most:
            expected, got = f"at most {self._most} questions on their way", str(self._waiting)
            raise ProblemError(503, "gateway_busy", expected, got, "wait a second and try again")
        self._waiting += 1
        try:
            with self._metrics.asked.labels(type(request).__name__).time():
                loop = asyncio.get_running_loop()
                return await loop.run_in_executor(
                    self._pool, lambda: self._call(query, request, timeout_s, names)
                )
        except AbsentError as error:
            raise absent(service, f"the {service} service on the bus", "no such service") from error
        except TimedOutError as error:
            raise slow(service, f"an answer of {service} within {timeout_s:g} s", "none") from error
        except RefusedError as error:
            raise _refused(service, error) from error
        except WireError as error:
            raise bad_answer(service, f"a valid message from {service}", str(error)[:300]) from error
        finally:
            self._waiting -= 1

    def close(self) -> None:
        """Start nothing new; what is on its way ends when the bus closes."""
        self._closed.set()
        self._pool.shutdown(wait=False, cancel_futures=True)

    def _call(self, query: Query[Q, R], request: Q, timeout_s: float, names: dict[str, str]) -> R:
        if self._closed.is_set():
            raise AbsentError("the gateway is stopping")
        return self._bus.ask(query, request, timeout_s, **names)


def absent(service: str, expected: str, got: str) -> ProblemError:
    """A service that cannot be reached."""
    next_step = f"start {service} (see /readyz) and try again"
    return ProblemError(503, "service_absent", expected, got, next_step, service=service)


def slow(service: str, expected: str, got: str) -> ProblemError:
    """A service that does not answer in time."""
    next_step = "try again; if it stays so, look at the service's log"
    return ProblemError(504, "service_slow", expected, got, next_step, service=service)


def bad_answer(service: str, expected: str, got: str) -> ProblemError:
    """A service that answers something else than it should."""
    next_step = "see the service's log; run the same version of every service"
    return ProblemError(502, "bad_answer", expected, got, next_step, service=service)


def _refused(service: str, error: RefusedError) -> ProblemError:
    expected, got = f"a request {service} can carry out", str(error)[:300]
    next_step = (
        "choose another goal, or have the rule lifted"
        if error.code == "forbidden"
        else "change what the service objects to"
    )
    status = 422 if error.code == "invalid" else 409
    return ProblemError(status, "refused", expected, got, next_step, service=service, reason=error.code)
