"""How often one client may write, upload and be wrong about a token; bounded in memory."""

import ipaddress
import math
import time
from collections import OrderedDict
from collections.abc import Callable

from starlette.requests import HTTPConnection

from services.gateway.http.buckets import MOST_KEYS, Buckets
from services.gateway.http.problems import ProblemError
from services.gateway.settings import GatewaySettings

STOPS_PER_S, STOP_BURST = 5.0, 20
V6_PREFIX = 64
"""One customer's share of IPv6: its addresses count as one client."""


class Limits:
    """All rate limits of a gateway. Lives in the asyncio thread."""

    def __init__(self, settings: GatewaySettings, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._writes = Buckets(settings.writes_per_s, settings.write_burst)
        self._uploads = Buckets(settings.uploads_per_s, settings.upload_burst)
        self._failures = Buckets(settings.failures_per_s, settings.failure_burst)
        self._stops = Buckets(STOPS_PER_S, STOP_BURST)
        self._proven: OrderedDict[tuple[str, str], None] = OrderedDict()

    def write(self, client: str) -> None:
        """Count a write; raises ProblemError 429."""
        _refuse(self._writes.take(client, self._clock()), "writes")

    def upload(self, client: str) -> None:
        """Count a picture or an archive; raises ProblemError 429."""
        _refuse(self._uploads.take(client, self._clock()), "uploads")

    def stop(self, robot: str) -> bool:
        """Count an emergency stop; whether it is passed on at once, or gathered with others."""
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
        if not right:
            self._failures.take(address, self._clock())
            return
        self._proven[address, digest] = None
        self._proven.move_to_end((address, digest))
        while len(self._proven) > MOST_KEYS:
            self._proven.popitem(last=False)


def address_of(connection: HTTPConnection) -> str:
    """Where a connection comes from; a network's name for IPv6."""
    host = connection.client.host if connection.client else "unknown"
    try:
        address = ipaddress.ip_address(host)
    except ValueError:
        return host[:64]
    if isinstance(address, ipaddress.IPv6Address) and address.ipv4_mapped is None and not address.is_loopback:
        return str(ipaddress.ip_network((int(address), V6_PREFIX), strict=False))
    return str(address)


def _refuse(wait_s: float, what: str) -> None:
    if wait_s > 0.0:
        raise ProblemError(
            429,
            "too_many_requests",
            expected=f"fewer {what} from one client",
            got="one more",
            next_step=f"wait {math.ceil(wait_s)} s",
            retry_after_s=math.ceil(wait_s),
        )
