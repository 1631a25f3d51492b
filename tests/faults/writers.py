"""A constant load of transactions on the map store, and an exact record of what it acknowledged."""

import threading
import time
from dataclasses import dataclass, field, replace

import httpx
import numpy as np

from shared.bus import Bus
from shared.messages.maps import AddNode, MapRequest, Operation
from shared.queries import QueryError, RefusedError
from shared.topics import MAP
from shared.wire import WireError
from tests.faults.lived_maps import link, place

SHARED, OWN = "shared", "own"
ANSWER_S = 5.0
PAUSE_S = 0.03
UNDO = 0.2
"""Share of undos among the writes to the writer's own map."""

IDS = 100_000
"""Each writer takes node numbers from a range of its own."""


@dataclass(frozen=True)
class Link:
    """The way to the map store; `era` makes the names of maps."""

    bus: Bus
    rest: httpx.Client
    era: str

    def named(self, kind: str) -> str:
        """Name of the map of this kind."""
        return f"{kind}-{self.era}"


@dataclass(frozen=True)
class Transaction:
    """One write as the client knows it.

    Attributes:
        nodes, edges: what it added; none for an undo.
        acknowledged: the store said that it is done.
        revision: where it stands; None when it was not acknowledged and never asked about.
    """

    author: str
    nodes: tuple[int, ...] = ()
    edges: tuple[tuple[int, int], ...] = ()
    acknowledged: bool = False
    revision: int | None = None

    @property
    def undo(self) -> bool:
        """Whether it took back another."""
        return not self.nodes


def content(number: int) -> AddNode:
    """Node `number` with its features, large and small ones in turn."""
    return place(number, keypoints=(6, 24, 90)[number % 3])


@dataclass
class Writer:
    """Writes to one map until `stop`; keeps every transaction it tried, in order."""

    link: Link
    map: str
    author: str
    first: int
    rng: np.random.Generator
    stop: threading.Event
    done: list[Transaction] = field(default_factory=list)

    def run(self) -> None:
        """Add pairs of joined nodes."""
        while not self.stop.wait(PAUSE_S):
            self.done.append(self.add())

    def create(self) -> None:
        """Make the map, whoever comes first."""
        while not self.stop.is_set():
            try:
                self.link.bus.ask(MAP, MapRequest(action="create"), ANSWER_S, map=self.map)
            except QueryError as error:
                if not (isinstance(error, RefusedError) and error.code == "conflict"):
                    time.sleep(PAUSE_S)
                    continue
            return

    def add(self, base_revision: int | None = None, joined: int | None = None) -> Transaction:
        """Try one transaction: two nodes, the edge between them, and one to a node that is there."""
        a = self.first + 2 * len(self.done)
        edges = [(a, a + 1)] if joined is None else [(a, a + 1), (joined, a)]
        operations: list[Operation] = [content(a), content(a + 1), *(link(*edge) for edge in edges)]
        tried = Transaction(self.author, (a, a + 1), tuple(edges))
        request = MapRequest(
            action="transact", author=self.author, base_revision=base_revision, operations=tuple(operations)
        )
        try:
            reply = self.link.bus.ask(MAP, request, ANSWER_S, map=self.map)
        except (QueryError, WireError):
            return tried
        return replace(tried, acknowledged=True, revision=reply.revision)


class OwnWriter(Writer):
    """The only writer of a map: knows every revision, and takes back what it did now and then."""

    def run(self) -> None:
        """Add and undo; after a failure look what became of it."""
        revision, standing = 0, []
        while not self.stop.wait(PAUSE_S):
            undo = bool(standing) and self.rng.random() < UNDO
            tried = self.undo(revision) if undo else self.add(revision, standing[-1] if standing else None)
            if not tried.acknowledged:
                found = self.revision()
                tried = replace(tried, revision=found if found != revision else None)
            self.done.append(tried)
            if tried.revision is None:
                continue
            revision = tried.revision
            if undo:
                standing.pop()
            else:
                standing.append(tried.nodes[1])

    def undo(self, base_revision: int) -> Transaction:
        """Try to take back the newest transaction."""
        tried, where = Transaction(self.author), f"/maps/{self.map}/undo"
        try:
            answer = self.link.rest.post(
                where, params={"base_revision": base_revision}, headers={"X-Topnav-Author": self.author}
            )
        except httpx.HTTPError:
            return tried
        if answer.is_error:
            return tried
        return replace(tried, acknowledged=True, revision=answer.json()["revision"])

    def revision(self) -> int:
        """Where the map stands, asked until the store answers."""
        while True:
            try:
                return self.link.bus.ask(MAP, MapRequest(action="read"), ANSWER_S, map=self.map).revision
            except RefusedError:
                return 0  # not even the map is there: the account will say so
            except QueryError:
                time.sleep(PAUSE_S)


class Load:
    """Two writers on one map, one on another."""

    def __init__(self, link: Link, seed: int) -> None:
        self._stop = threading.Event()
        shared, own = link.named(SHARED), link.named(OWN)
        rngs = [np.random.default_rng((seed, number)) for number in range(3)]
        self._writers = [
            Writer(link, shared, "left", 0, rngs[0], self._stop),
            Writer(link, shared, "right", IDS, rngs[1], self._stop),
            OwnWriter(link, own, "own", 2 * IDS, rngs[2], self._stop),
        ]
        self._threads = [threading.Thread(target=writer.run, name=writer.author) for writer in self._writers]

    def start(self) -> None:
        """Make the maps and begin to write; each map is read in the end, also that of a writer held up."""
        for writer in self._writers:
            writer.create()
        for thread in self._threads:
            thread.start()

    def stop(self) -> None:
        """Let every writer finish what it does."""
        self._stop.set()
        for thread in self._threads:
            thread.join()

    def acknowledged(self) -> int:
        """How many transactions the store acknowledged so far."""
        return sum(each.acknowledged for writer in self._writers for each in list(writer.done))

    def transactions(self) -> dict[str, list[Transaction]]:
        """What was tried, by map; of each writer in its order."""
        tried: dict[str, list[Transaction]] = {}
        for writer in self._writers:
            tried.setdefault(writer.map, []).extend(writer.done)
        return tried
