"""The bus side of the map store: answers questions and publishes deltas, all in one loop."""

import logging
from collections import deque
from collections.abc import Callable
from functools import partial
from threading import Event
from typing import TypeVar

from services.map_store.errors import ConflictError, InvalidError, MapError
from services.map_store.inspections.store import InspectionStore
from services.map_store.merging.merge import Matcher
from services.map_store.storage.missions import MissionStore
from services.map_store.store import MapStore
from services.map_store.tasks.queue import TaskStore
from shared.bus import Bus, Publisher, Request
from shared.messages.base import Message
from shared.messages.maps import MapDelta, MapReply, MapRequest, MissionRecord, MissionRecordRequest
from shared.topics import INSPECTION, MAP, MAP_DELTA, MAP_READ, MATCH, MISSION_RECORD, TASKS
from shared.wire import encode

Q = TypeVar("Q", bound=Message)
R = TypeVar("R", bound=Message)
log = logging.getLogger(__name__)

PERIOD_S = 0.5
"""A signal to stop is seen after at most this long; questions and deltas end the wait at once."""

READING = frozenset({"read", "read_features", "read_pictures"})


class Deltas:
    """Deltas between the thread that commits and the loop that publishes, in order."""

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self._waiting: deque[MapDelta] = deque()
        self._publishers: dict[str, Publisher[MapDelta]] = {}

    def push(self, delta: MapDelta) -> None:
        """Store one; any thread."""
        self._waiting.append(delta)
        self._bus.wake.set()

    def publish(self) -> None:
        """Send all that wait. One too long for the bus becomes a reset: followers then read the map."""
        while self._waiting:
            delta = self._waiting.popleft()
            if len(encode(delta)) > MAP_DELTA.max_bytes:
                delta = delta.model_copy(update={"operations": (), "reset": True})
            if delta.map not in self._publishers:
                self._publishers[delta.map] = self._bus.publisher(MAP_DELTA, map=delta.map)
            self._publishers[delta.map].put(delta)


def matcher(bus: Bus, robot: str, timeout_s: float) -> Matcher:
    """Asks the feature service of `robot`; any thread may."""
    return lambda wish: bus.ask(MATCH, wish, timeout_s, robot=robot)


def answer_map(store: MapStore, name: str, request: MapRequest) -> MapReply:
    """Do what `request` asks of map `name`; raises MapError."""
    if request.action == "create":
        return MapReply(map=name, revision=store.create(name, request.request_id))
    if request.action == "transact":
        revision = store.transact(
            name, request.operations, request.author, request.base_revision, request.request_id
        )
        return MapReply(map=name, revision=revision)
    if request.action == "read_features":
        found, features = store.contents.features(name, request.node_ids)
        return MapReply(map=name, revision=found.revision, features=features)
    if request.action == "read_pictures":
        found, pictures = store.contents.pictures(name, request.node_ids)
        return MapReply(map=name, revision=found.revision, pictures=pictures)
    revision, graph = store.graph(name)
    nodes = tuple(stored.node for stored in graph.nodes.values())
    edges, marks = tuple(graph.edges.values()), graph.marks
    return MapReply(
        map=name,
        revision=revision,
        nodes=nodes,
        edges=edges,
        places=marks.places,
        rules=marks.rules,
        routes=marks.routes,
        signs=marks.signs,
    )


def answer_reader(store: MapStore, name: str, request: MapRequest) -> MapReply:
    """Answer who may read only; raises MapError, also for a request that writes."""
    if request.action not in READING:
        raise InvalidError(f"this key only reads, one of {sorted(READING)} expected, got {request.action!r}")
    return answer_map(store, name, request)


def answer_mission(missions: MissionStore, robot: str, request: MissionRecordRequest) -> MissionRecord:
    """Claim or save the record of `robot`; raises MapError."""
    if request.record.robot != robot:
        raise InvalidError(f"record of robot {request.record.robot!r} sent to the key of {robot!r}")
    return missions.claim(robot) if request.action == "claim" else missions.save(request.record)


def run(
    bus: Bus,
    stop: Event,
    store: MapStore,
    missions: MissionStore,
    tasks: TaskStore,
    visits: InspectionStore,
    deltas: Deltas,
    ready: Callable[[], None],
) -> None:
    """Answer until `stop`; `ready` is called once questions can be asked."""
    maps, records = bus.requests(MAP, map="*"), bus.requests(MISSION_RECORD, robot="*")
    readers, queues = bus.requests(MAP_READ, map="*"), bus.requests(TASKS, queue="*")
    inspections = bus.requests(INSPECTION, map="*")
    _reset_followers(store, deltas)
    ready()
    while not stop.is_set():
        bus.wait(PERIOD_S)
        while (question := maps.take()) is not None:
            _answer(question, partial(answer_map, store))
            deltas.publish()
        while (reading := readers.take()) is not None:
            _answer(reading, partial(answer_reader, store))
        while (mission := records.take()) is not None:
            _answer(mission, partial(answer_mission, missions))
        while (task := queues.take()) is not None:
            _answer(task, tasks.answer)
        while (inspection := inspections.take()) is not None:
            _answer(inspection, visits.answer)
        deltas.publish()


def _reset_followers(store: MapStore, deltas: Deltas) -> None:
    """Have all maps read again: a delta may have been lost with the process that committed it."""
    try:
        records = store.summaries()
    except MapError as error:
        log.error("no map can be read, every question will be refused: %s", error)
        return
    for record in records:
        deltas.push(MapDelta(map=record.name, revision=record.revision, reset=True))
    deltas.publish()


def _answer(question: Request[Q, R], answer: Callable[[str, Q], R]) -> None:
    try:
        reply = answer(question.name, question.message)
    except MapError as error:
        level = logging.INFO if isinstance(error, InvalidError | ConflictError) else logging.WARNING
        log.log(level, "refused: %s", error)
        question.refuse(str(error), error.code)
        return
    question.reply(reply)
