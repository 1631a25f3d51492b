"""Which connections a server holds when more come than it may have: whoever says nothing makes room."""

import ipaddress
import re
from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass
from enum import Enum
from typing import Protocol

RESERVE = 64
"""Chosen: connections beyond all limits, on which only `ConnectionLimits.always` is answered."""
V6_PREFIX = 64
"""One customer's share of IPv6 (RFC 6177): its addresses count as one client."""


@dataclass(frozen=True)
class ConnectionLimits:
    """What connections may do.

    Attributes:
        header_s: to the end of a request's head, from the connection's start or the last answer's end.
        unread_s: how long what was sent may wait for the other side to take it.
        most: connections in all, WebSockets not counted.
        most_per_client: of these of one client.
        unlimited: addresses, for example of a proxy, that have no such share.
        admitted: common names of certificates, others are not even read; None: whoever connects.
        always: paths that are served however many connections there are.
    """

    header_s: float
    unread_s: float
    most: int
    most_per_client: int
    unlimited: Collection[str] = ()
    admitted: Collection[str] | None = None
    always: re.Pattern[str] | None = None


class Connection(Protocol):
    """What is known of one here."""

    def evict(self) -> None:
        """End it."""


class Admission(Enum):
    """How one may come in; on a reserved one little is answered."""

    FREE = "free"
    RESERVED = "reserved"
    REFUSED = "refused"


class Crowd:
    """The connections of one server. One that waits for a request's head makes room for one that comes.

    Lives in the asyncio thread.
    """

    def __init__(self, limits: ConnectionLimits) -> None:
        self._limits = limits
        self._clients: dict[Connection, str] = {}
        self._reserved: set[Connection] = set()
        self._counts: Counter[str] = Counter()
        self._waiting: dict[Connection, None] = {}  # in the order in which they began to

    def admit(self, connection: Connection, host: str) -> Admission:
        """Let one in that comes from an address."""
        client, limits = client_of(host), self._limits
        full = self._counts[client] >= limits.most_per_client and host not in limits.unlimited
        if (full and not self._make_room(client)) or (
            len(self._clients) >= limits.most and not self._make_room(None)
        ):
            return self._admit_reserved(connection)
        self._clients[connection] = client
        self._counts[client] += 1
        return Admission.FREE

    def forget(self, connection: Connection) -> None:
        """It has ended, or become a WebSocket."""
        self._waiting.pop(connection, None)
        self._reserved.discard(connection)
        client = self._clients.pop(connection, None)
        if client is not None:
            self._counts[client] -= 1
            if not self._counts[client]:
                del self._counts[client]

    def waits(self, connection: Connection) -> None:
        """From now on it waits for a request."""
        self._waiting.setdefault(connection)

    def works(self, connection: Connection) -> None:
        """It sent the head of a request, which is being answered."""
        self._waiting.pop(connection, None)

    def _admit_reserved(self, connection: Connection) -> Admission:
        if self._limits.always is None:
            return Admission.REFUSED
        if len(self._reserved) >= RESERVE:
            oldest = next((other for other in self._waiting if other in self._reserved), None)
            if oldest is None:
                return Admission.REFUSED
            self._end(oldest)
        self._reserved.add(connection)
        return Admission.RESERVED

    def _make_room(self, client: str | None) -> bool:
        """End the connection, of a client or any, that has waited longest; whether there was one."""
        held = (one for one in self._waiting if one in self._clients)
        oldest = next((one for one in held if client in (None, self._clients[one])), None)
        if oldest is None:
            return False
        self._end(oldest)
        return True

    def _end(self, connection: Connection) -> None:
        self.forget(connection)
        connection.evict()


def client_of(host: str) -> str:
    """Whom an address counts for: itself, or the network of an IPv6 address."""
    try:
        address = ipaddress.ip_address(host)
    except ValueError:
        return host[:64]
    if isinstance(address, ipaddress.IPv6Address) and address.ipv4_mapped is None and not address.is_loopback:
        return str(ipaddress.ip_network((int(address), V6_PREFIX), strict=False))
    return str(address)
