"""A router on a free port, the feature service in a thread, and a stand-in for the map store."""

import threading
from collections.abc import Iterator

import pytest

from services.features.service import run
from services.features.settings import FeaturesSettings
from shared.bus import Bus, Request, open_bus, wait_until
from shared.messages.features import Features
from shared.messages.maps import AddNode, MapDelta, MapReply, MapRequest, Node, NodeFeatures, NodePicture
from shared.messages.matching import MatchRequest
from shared.queries import RefusedError
from shared.topics import MAP_DELTA, MAP_READ, MATCH
from tests.bare_places import FEATURES

ANSWER_S = 60.0


class StandInStore:
    """Answers questions about a map and publishes deltas, as the map store would."""

    def __init__(self, bus: Bus, name: str) -> None:
        self.name, self.revision, self.reads = name, 0, 0
        self.nodes: dict[int, Features] = {}
        self.pieces: list[int] = []
        self.pictured: list[int] = []
        """Nodes whose pictures were read."""
        self.going: tuple[int, ...] = ()
        """Nodes that are deleted right after the graph was read."""
        self._bus = bus
        self._deltas = bus.publisher(MAP_DELTA, map=name)
        self._requests = bus.requests(MAP_READ, map="*")
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._serve)
        self._thread.start()

    def _serve(self) -> None:
        while not self._stop.is_set():
            self._bus.wait(0.05)
            while (request := self._requests.take()) is not None:
                if request.name != self.name:
                    request.refuse(f"no map {request.name!r}")
                    continue
                self._answer(request)

    def _answer(self, request: Request[MapRequest, MapReply]) -> None:
        asked = request.message
        if asked.action == "read":
            self.reads += 1
            nodes = tuple(Node(node_id=node_id) for node_id in self.nodes)
            request.reply(MapReply(map=self.name, revision=self.revision, nodes=nodes))
            self.nodes = {n: f for n, f in self.nodes.items() if n not in self.going}
            self.going = ()
            return
        assert asked.action in ("read_features", "read_pictures")
        assert asked.node_ids
        if gone := [node_id for node_id in asked.node_ids if node_id not in self.nodes]:
            request.refuse(f"no node {gone}")
            return
        if asked.action == "read_pictures":
            pictures = tuple(NodePicture(node_id=n, picture=self.nodes[n].thumbnail) for n in asked.node_ids)
            self.pictured.extend(asked.node_ids)
            request.reply(MapReply(map=self.name, revision=self.revision, pictures=pictures))
            return
        features = tuple(NodeFeatures(node_id=n, features=self.nodes[n]) for n in asked.node_ids)
        self.pieces.append(len(features))
        request.reply(MapReply(map=self.name, revision=self.revision, features=features))

    def add(self, node_id: int, features: Features, tell: bool = True) -> None:
        """Add a node; `tell` sends the delta."""
        self.nodes[node_id] = features
        self.revision += 1
        if tell:
            operation = AddNode(node=Node(node_id=node_id), features=features)
            self._deltas.put(MapDelta(map=self.name, revision=self.revision, operations=(operation,)))

    def reset(self) -> None:
        """Say that the map was replaced."""
        self.revision += 1
        self._deltas.put(MapDelta(map=self.name, revision=self.revision, reset=True))

    def close(self) -> None:
        self._stop.set()
        self._thread.join()


@pytest.fixture(scope="module", autouse=True)
def _patient(patient_sessions: None) -> None:
    """All sessions are in this process, and stand still with it."""


@pytest.fixture
def endpoint(router_endpoint: str) -> str:
    """A router."""
    return router_endpoint


@pytest.fixture
def bus(endpoint: str) -> Iterator[Bus]:
    """The test's own session."""
    with open_bus(endpoint) as mine:
        yield mine


@pytest.fixture
def store(endpoint: str, bus: Bus, service: None) -> Iterator[StandInStore]:
    """A map store with one empty map, `flat`; the feature service has met it."""
    del service  # only asked for to be up
    question = MatchRequest(map="no-map-at-all", features=FEATURES, best_k=1)

    def met() -> bool:
        with pytest.raises(RefusedError) as refused:
            bus.ask(MATCH, question, ANSWER_S, robot="r1")
        return "is not known to the map store" in str(refused.value)

    with open_bus(endpoint) as mine:
        stand_in = StandInStore(mine, "flat")
        try:
            assert wait_until(met, ANSWER_S)
            yield stand_in
        finally:
            stand_in.close()


@pytest.fixture
def service(endpoint: str, bus: Bus) -> Iterator[None]:
    """The feature service, alive on the bus."""
    stop = threading.Event()
    settings = FeaturesSettings(endpoint=endpoint, map_timeout_s=ANSWER_S / 2)

    def serve() -> None:
        with open_bus(endpoint) as mine:
            run(settings, mine, stop)

    thread = threading.Thread(target=serve)
    thread.start()
    try:
        assert wait_until(lambda: bus.alive("features") == ["features"], ANSWER_S)
        yield
    finally:
        stop.set()
        thread.join()
