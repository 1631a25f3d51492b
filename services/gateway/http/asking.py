"""Questions to other services from asyncio: a small thread pool, and bus errors as problems."""

import asyncio
import threading
from concurrent.futures import ThreadPoolExecutor
from typing import Protocol, TypeVar

from services.gateway.http.metrics import Metrics
from services.gateway.http.problems import ProblemError
from shared.messages.base import Message
from shared.queries import AbsentError, RefusedError, TimedOutError
from shared.topics import Query
from shared.wire import WireError

Q = TypeVar("Q", bound=Message)
R = TypeVar("R", bound=Message)

THREADS = 16
MAX_WAITING = 48
"""Questions on their way; more are refused at once instead of piling up behind a service that hangs."""


class Asks(Protocol):
    """The part of the bus that asks."""

    def ask(self, query: Query[Q, R], request: Q, timeout_s: float, **names: str) -> R:
        """Ask and wait."""


class Asker:
    """Asks on threads; raises `ProblemError` where the bus raises its own errors."""

    def __init__(self, bus: Asks, metrics: Metrics) -> None:
        self._bus, self._metrics = bus, metrics
        self._pool = ThreadPoolExecutor(THREADS, thread_name_prefix="ask")
        self._waiting = 0
        self._closed = threading.Event()

    async def ask(self, service: str, query: Query[Q, R], request: Q, timeout_s: float, **names: str) -> R:
        """Ask `service`.

        Raises:
            ProblemError: 503 absent or busy, 504 too slow, 409 refused, 502 answered nonsense.
        """
        if self._waiting >= MAX_WAITING:
            raise ProblemError(
                503,
                "gateway_busy",
                expected=f"at most {MAX_WAITING} questions on their way",
                got=str(self._waiting),
                next_step="wait a second and try again",
            )
        self._waiting += 1
        try:
            with self._metrics.asked.labels(type(request).__name__).time():
                loop = asyncio.get_running_loop()
                return await loop.run_in_executor(
                    self._pool, lambda: self._call(query, request, timeout_s, names)
                )
        except (AbsentError, TimedOutError, RefusedError, WireError) as error:
            raise _problem(service, error, timeout_s) from error
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


def _problem(service: str, error: Exception, timeout_s: float) -> ProblemError:
    got = str(error)[:300]
    if isinstance(error, AbsentError):
        return ProblemError(
            503,
            "service_absent",
            expected=f"the {service} service on the bus",
            got="no such service",
            next_step=f"start {service} (see /readyz) and try again",
            service=service,
        )
    if isinstance(error, TimedOutError):
        return ProblemError(
            504,
            "service_slow",
            expected=f"an answer of {service} within {timeout_s:g} s",
            got="none",
            next_step="try again; if it stays so, look at the service's log",
            service=service,
        )
    if isinstance(error, RefusedError):
        return ProblemError(
            409,
            "refused",
            expected=f"a request {service} can carry out",
            got=got,
            next_step="change what the service objects to",
            service=service,
            reason=error.code,
        )
    return ProblemError(
        502,
        "bad_answer",
        expected=f"a valid message from {service}",
        got=got,
        next_step="run the same version of every service",
        service=service,
    )
