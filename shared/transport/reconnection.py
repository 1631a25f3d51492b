"""Peers that lost sight of each other are introduced once more.

Zenoh's peers dial each other once, when the router tells of a new one, and not while they still hold a link.
Whoever stands still for about as long as the lease loses some links and keeps others for a moment. A link
that goes when the router's is up again is dialled by nobody: two processes that live never hear each other
again. So whoever had dialled a peer and lost it looks for it: unless its port refuses by now, it opens a
second session for a moment, and the router tells everybody of everybody.
"""

import logging
import socket
import threading
import time
from dataclasses import dataclass
from typing import Any, Self

import zenoh

from shared.inbox import wait_until
from shared.transport.session_config import peer_config

log = logging.getLogger(__name__)

FIRST_PAUSE_S, LONGEST_PAUSE_S = 0.5, 16.0
"""Pauses double from one introduction to the next: the other process may stand still a while longer
(decision 0027)."""
GIVE_UP_S = 600.0
"""Ten minutes: who is away for longer is taken for gone (chosen, decision 0027)."""
MEET_S = 2.0
"""Longest life of a second session; chosen: those who live answered after 1.2 s at the latest, pause and all
(`python -m tests.faults.short_freezes`)."""
CONNECT_S = 0.5
"""A port of a machine that is there refuses or accepts within this; chosen."""


@dataclass
class LostPeer:
    """A peer whose link was lost: its end of the link, when to look for it next, and the pause after that."""

    locator: str
    next_s: float
    give_up_s: float
    pause_s: float = FIRST_PAUSE_S


class PeerReconnection:
    """Looks for the peers that `session` had dialled and lost, until they are back or gone."""

    def __init__(self, session: zenoh.Session, endpoint: str) -> None:
        self._info, self._endpoint = session.info, endpoint
        self._lost: dict[str, LostPeer] = {}
        self._changed = threading.Condition()
        self._closing = False
        on_link: Any = zenoh.handlers.Callback(self._note_loss, indirect=False)
        self._listener = self._info.declare_link_events_listener(on_link)
        self._thread = threading.Thread(target=self._run, name="peer-reconnection", daemon=True)
        self._thread.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        """Stop looking; an introduction under way is cut short."""
        with self._changed:
            self._closing = True
            self._changed.notify()
        self._thread.join()
        self._listener.undeclare()  # type: ignore[no-untyped-call]

    @property
    def lost(self) -> list[str]:
        """Session ids of the peers that were lost and neither came back nor are known to be gone."""
        with self._changed:
            return list(self._lost)

    def _note_loss(self, event: zenoh.LinkEvent) -> None:
        if event.kind == zenoh.SampleKind.DELETE:
            now_s = time.monotonic()
            with self._changed:
                lost = LostPeer(event.link.dst, now_s + FIRST_PAUSE_S, now_s + GIVE_UP_S)
                self._lost[str(event.link.zid)] = lost
                self._changed.notify()

    def _run(self) -> None:
        while (due := self._wait_for_due()) is not None:
            away = [zid for zid, peer in due.items() if self._is_away(zid, peer)]
            # Zenoh itself goes on dialling a router, and one that is found again introduces everybody.
            if away and self._info.routers_zid():
                log.info("lost without having ended, introduced anew: %s", ", ".join(away))
                self._introduce(away)

    def _wait_for_due(self) -> dict[str, LostPeer] | None:
        """The peers to look for now; None when closing."""
        with self._changed:
            while not self._closing:
                now_s = time.monotonic()
                if due := {zid: peer for zid, peer in self._lost.items() if peer.next_s <= now_s}:
                    return due
                next_s = min((peer.next_s for peer in self._lost.values()), default=None)
                self._changed.wait(None if next_s is None else next_s - now_s)
        return None

    def _is_away(self, zid: str, peer: LostPeer) -> bool:
        """Whether it is not heard and may still listen where it did; otherwise it is forgotten."""
        now_s = time.monotonic()
        if self._hears(zid) or now_s > peer.give_up_s or refused(peer.locator):
            with self._changed:
                if self._lost.get(zid) is peer:
                    del self._lost[zid]
            return False
        peer.pause_s = min(2.0 * peer.pause_s, LONGEST_PAUSE_S)
        peer.next_s = now_s + peer.pause_s
        return True

    def _hears(self, zid: str) -> bool:
        return any(str(heard) == zid for heard in (*self._info.peers_zid(), *self._info.routers_zid()))

    def _introduce(self, away: list[str]) -> None:
        """Be new on the bus until those who are away are heard, two seconds at most."""
        try:
            with zenoh.open(peer_config(self._endpoint)):
                wait_until(lambda: self._closing or all(map(self._hears, away)), MEET_S)
        except zenoh.ZError as error:  # no port or no file left: it is tried again
            log.warning("no second session to introduce peers: %s", str(error)[:200])


def refused(locator: str) -> bool:
    """Whether nobody listens at `locator` (tcp/HOST:PORT), as where a link was accepted and not dialled.

    A process that stands still does not refuse, nor does a network that is cut.
    """
    host, _, port = locator.partition("/")[2].rpartition(":")
    try:
        with socket.create_connection((host.strip("[]"), int(port)), CONNECT_S):
            return False
    except (ConnectionRefusedError, ValueError):
        return True
    except OSError:
        return False
