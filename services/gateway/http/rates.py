"""How often one client may write, upload and be wrong about a token; bounded in memory."""

import math
import time
from collections import OrderedDict
from collections.abc import Callable
from typing import Any

from starlette.requests import HTTPConnection

from services.gateway.settings import GatewaySettings
from shared.web.crowding import client_of
from shared.web.problems import ProblemError

STOPS_PER_S, STOP_BURST = 5.0, 20
"""Of one robot, each passed on by itself: nobody presses faster. Others are coalesced, never refused."""
WISHES_PER_S, WISH_BURST = 20.0, 60
"""Of one client that drives by hand, which wishes anew seven times a second; chosen: three of its pages."""
MOST_KEYS = 4096
"""Clients remembered; the one heard of longest ago is forgotten, which at worst gives it a full bucket."""


class TokenBuckets:
    """So many at once, then so many a second: one bucket for each key, full at first.

    Args:
        rate_per_s: how fast a bucket fills.
        burst: how much it holds.
        most_keys: how many are remembered.
    """

    def __init__(self, rate_per_s: float, burst: int, most_keys: int = MOST_KEYS) -> None:
        self._rate_per_s, self._burst, self._most_keys = rate_per_s, burst, most_keys
        self._levels: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def take(self, key: str, now_s: float) -> float:
        """Take one; 0 when there was one, else the seconds until there will be."""
        wait_s = self.wait_s(key, now_s)
        if wait_s == 0.0:
            self._levels[key] = self._level(key, now_s) - 1.0, now_s
            _forget_oldest(self._levels, key, self._most_keys)
        return wait_s

    def wait_s(self, key: str, now_s: float) -> float:
        """Seconds until one can be taken."""
        missing = 1.0 - self._level(key, now_s)
        return max(0.0, missing / self._rate_per_s) if missing > 1e-9 else 0.0

    def __len__(self) -> int:
        return len(self._levels)

    def _level(self, key: str, now_s: float) -> float:
        level, then_s = self._levels.get(key, (float(self._burst), now_s))
        return min(float(self._burst), level + (now_s - then_s) * self._rate_per_s)


class RateLimits:
    """All rate limits of a gateway. Lives in the asyncio thread."""

    def __init__(self, settings: GatewaySettings, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._writes = TokenBuckets(settings.writes_per_s, settings.write_burst)
        self._uploads = TokenBuckets(settings.uploads_per_s, settings.upload_burst)
        self._comparisons = TokenBuckets(settings.comparisons_per_s, settings.comparison_burst)
        self._failures = TokenBuckets(settings.failures_per_s, settings.failure_burst)
        self._stops = TokenBuckets(STOPS_PER_S, STOP_BURST)
        self._wishes = TokenBuckets(WISHES_PER_S, WISH_BURST)
        self._proven: OrderedDict[tuple[str, str], None] = OrderedDict()

    def write(self, client: str) -> None:
        """Count a write; raises ProblemError 429."""
        _refuse(self._writes.take(client, self._clock()), "writes")

    def upload(self, client: str) -> None:
        """Count a picture or an archive; raises ProblemError 429."""
        _refuse(self._uploads.take(client, self._clock()), "uploads")

    def comparison(self, client: str) -> None:
        """Count a comparison of pictures, which reads only but computes; raises ProblemError 429."""
        _refuse(self._comparisons.take(client, self._clock()), "comparisons")

    def wish(self, client: str) -> None:
        """Count a wish of somebody who drives by hand; raises ProblemError 429."""
        _refuse(self._wishes.take(client, self._clock()), "wishes")

    def stop(self, robot: str) -> bool:
        """Count an emergency stop; whether it is passed on at once, or together with others."""
        return self._stops.take(robot, self._clock()) == 0.0

    def before_token(self, address: str, digest: str) -> None:
        """Refuse to look at more tokens of an address that was wrong too often; raises ProblemError 429.

        A token that was right from there before is looked at all the same: who guesses beside an operator,
        behind one proxy or on one machine, must not lock the operator out.
        """
        if (address, digest) not in self._proven:
            _refuse(self._failures.wait_s(address, self._clock()), "wrong tokens")

    def after_token(self, address: str, digest: str, right: bool) -> None:
        """Remember how that ended."""
        if right:
            self._proven[address, digest] = None
            _forget_oldest(self._proven, (address, digest), MOST_KEYS)
        else:
            self._failures.take(address, self._clock())


def address_of(connection: HTTPConnection) -> str:
    """Where a connection comes from; a network's name for IPv6."""
    return client_of(connection.client.host if connection.client else "unknown")


def _forget_oldest(used: OrderedDict[Any, Any], key: object, most: int) -> None:
    """Count `key` as the newest, and keep the newest `most`."""
    used.move_to_end(key)
    while len(used) > most:
        used.popitem(last=False)


def _refuse(wait_s: float, what: str) -> None:
    if wait_s > 0.0:
        seconds, expected = math.ceil(wait_s), f"fewer {what} from one client"
        raise ProblemError(
            429, "too_many_requests", expected, "one more", f"wait {seconds} s", retry_after_s=seconds
        )
