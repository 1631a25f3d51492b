"""Stand-ins for the gateway's neighbours: real Zenoh peers and a real HTTP server with canned answers."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
import uvicorn
from fastapi import FastAPI, Request
from fastapi.responses import JSONResponse, Response

from services.planner.mission_kinds import MissionError, mission_kinds
from shared.bus import Bus, open_bus, wait_until
from shared.messages.features import ExtractPhotoRequest, ExtractRequest, Features
from shared.messages.maps import MapReply, Node, NodeFeatures
from shared.messages.matching import MatchReply, MatchRequest, NodeMatch
from shared.messages.missions import CONTROLS, MissionKinds, MissionRequest, MissionStatus
from shared.topics import EXTRACT, EXTRACT_PHOTO, MAP, MATCH, MISSION, MISSION_KINDS, STATUS
from tests.integration.gateway.gateway_process import WAIT_S

PIPELINE = "standin/1"
KEYPOINTS = 40


def features_of(seq: int = 0) -> Features:
    """Features of the right shape."""
    return Features(
        seq=seq,
        pipeline=PIPELINE,
        lonlat_rad=np.zeros((KEYPOINTS, 2), np.float32),
        scores=np.zeros(KEYPOINTS, np.float32),
        descriptors=np.zeros((KEYPOINTS, 16), np.float32),
    )


class Peer:
    """A service on the bus whose loop runs on its own thread."""

    def __init__(self, endpoint: str, name: str, setup: Callable[[Bus], Callable[[], None]]) -> None:
        self.stop = threading.Event()
        self._endpoint, self._name, self._setup = endpoint, name, setup
        self._ready = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self) -> "Peer":
        self._thread.start()
        assert self._ready.wait(WAIT_S)
        return self

    def __exit__(self, *_: object) -> None:
        self.stop.set()
        self._thread.join(WAIT_S)

    def _run(self) -> None:
        with open_bus(self._endpoint) as bus:
            turn = self._setup(bus)
            bus.announce(self._name)
            self._ready.set()
            while not self.stop.is_set():
                bus.wait(0.02)
                turn()


class FeatureService:
    """Answers EXTRACT and MATCH, remembers what it was asked."""

    def __init__(self) -> None:
        self.extracted: list[ExtractRequest] = []
        self.photographed: list[ExtractPhotoRequest] = []
        self.matched: list[MatchRequest] = []
        self.behind = 0  # so many frames it does not have yet
        self.busy = 0  # for so many questions
        self.results: tuple[NodeMatch, ...] = (
            NodeMatch(node_id=3, raw_matches=20, inliers=9, status="inconsistent"),
            NodeMatch(
                node_id=7,
                raw_matches=90,
                inliers=71,
                status="ok",
                heading_rad=0.5,
                yaw_rad=0.1,
                confidence=0.9,
            ),
        )

    def setup(self, bus: Bus) -> Callable[[], None]:
        extract, match = bus.requests(EXTRACT), bus.requests(MATCH, robot="*")
        photos = bus.requests(EXTRACT_PHOTO)

        def turn() -> None:
            while (asked := extract.take()) is not None:
                self.extracted.append(asked.message)
                asked.reply(features_of())
            while (shot := photos.take()) is not None:
                self.photographed.append(shot.message)
                shot.reply(features_of().model_copy(update={"photo": shot.message.photo.view}))
            while (question := match.take()) is not None:
                self.matched.append(question.message)
                if self.behind:
                    self.behind -= 1
                    question.refuse(f"frame {question.message.seq} is not kept", "passing")
                    continue
                if self.busy:
                    self.busy -= 1
                    question.refuse("9 pictures have to be looked at: ask again", "busy")
                    continue
                if question.message.map == "nowhere":
                    question.refuse("no map 'nowhere'")
                    continue
                question.reply(
                    MatchReply(
                        map=question.message.map, pipeline=PIPELINE, max_similarity=150, results=self.results
                    )
                )

        return turn


class MapStore:
    """Answers MAP with the features of whatever is asked for, and with two nodes that no edge joins."""

    def setup(self, bus: Bus) -> Callable[[], None]:
        requests = bus.requests(MAP, map="*")

        def turn() -> None:
            while (asked := requests.take()) is not None:
                if asked.message.action == "read":
                    asked.reply(MapReply(map="flat", revision=9, nodes=(Node(node_id=3), Node(node_id=7))))
                    continue
                found = tuple(
                    NodeFeatures(node_id=node, features=features_of()) for node in asked.message.node_ids
                )
                asked.reply(MapReply(map="flat", revision=9, features=found))

        return turn


KINDS = mission_kinds()


class Planner:
    """Answers MISSION and MISSION_KINDS, and publishes the status."""

    def __init__(self, robot: str = "r1") -> None:
        self.asked: list[MissionRequest] = []
        self.status = MissionStatus(robot=robot)
        self._wanted: list[MissionStatus] = []

    def say(self, **changes: object) -> None:
        """Publish a changed status, as the planner does when a mission ends."""
        self._wanted.append(self.status.model_copy(update=changes))

    def setup(self, bus: Bus) -> Callable[[], None]:
        requests = bus.requests(MISSION, robot=self.status.robot)
        kinds = bus.requests(MISSION_KINDS, robot=self.status.robot)
        statuses = bus.publisher(STATUS, robot=self.status.robot)

        def turn() -> None:
            while self._wanted:
                self.status = self._wanted.pop(0)
                statuses.put(self.status)
            while (question := kinds.take()) is not None:
                question.reply(MissionKinds(kinds=KINDS.infos()))
            while (request := requests.take()) is not None:
                try:
                    self._answer(request.message)
                except MissionError as error:
                    request.refuse(str(error), error.code)
                else:
                    request.reply(self.status)

        return turn

    def _answer(self, wish: MissionRequest) -> None:
        self.asked.append(wish)
        states = {"pause": "paused", "cancel": "cancelled", "finish": "succeeded"}
        if 404 in (wish.goal_node, wish.parameters.get("goal_node")):
            raise MissionError("the map has no node 404", "missing")
        if wish.action not in CONTROLS:
            assert KINDS[wish.action].name == wish.action
            changes = {"mission_id": "m1", "action": wish.action, "map": wish.map, "state": "running"}
            self.status = self.status.model_copy(update=changes)
        elif wish.action != "status":
            self.status = self.status.model_copy(update={"state": states.get(wish.action, "running")})


def store_app(seen: list[tuple[str, str]], nodes: int) -> FastAPI:
    """A map store with one map, `flat`, a ring of places; `seen` gets method and path of every request."""
    app = FastAPI()

    @app.api_route("/{path:path}", methods=["GET", "POST", "PATCH", "DELETE"])
    async def answer(path: str, request: Request) -> Response:
        query = f"?{request.url.query}" if request.url.query else ""
        seen.append((request.method, f"/{path}{query}"))
        body = await request.body()
        if path == "maps/import":
            return JSONResponse({"bytes": len(body)}, 201)
        if path.startswith("maps/broken"):
            return Response("oops", 500)
        return _stored(path, nodes, body)

    return app


def _stored(path: str, nodes: int, body: bytes) -> Response:
    if path == "maps":
        return JSONResponse([{"name": "flat", "revision": 9, "nodes": nodes, "edges": nodes}])
    if path.endswith("/thumbnail"):
        return Response(b"jpeg", media_type="image/jpeg", headers={"Cache-Control": "private, no-cache"})
    if path.endswith("/keypoints"):
        return JSONResponse({"lonlat_rad": [[0.1, 0.2]], "scores": [1.0]})
    if path == "maps/flat/export":
        name = {"Content-Disposition": 'attachment; filename="flat.zip"'}
        return Response(b"PK" + bytes(3_000_000), media_type="application/zip", headers=name)
    ring = [sorted((node, (node + 1) % nodes)) for node in range(nodes)]
    known: dict[str, object] = {
        "maps/flat": {"name": "flat", "revision": 9, "sent": body.decode()},
        "maps/flat/places": [],
        "maps/flat/rules": [],
        "maps/flat/routes": [],
        "maps/flat/signs": [],
        "maps/flat/inspections": [],
        "maps/flat/compare": {"map": "flat", "from": 5, "to": 9, "nodes_added": [3]},
        "maps/flat/undo": {"map": "flat", "revision": 10, "undone": 9},
        "maps/flat/nodes": [{"node_id": node, "thumbnail": True} for node in range(nodes)],
        "maps/flat/edges": [
            {"a": a, "b": b, "inliers": 60, "confidence": 0.8, "suspended": (a, b) == (1, 2)} for a, b in ring
        ],
    }
    if path in known:
        return JSONResponse(known[path])
    problem = {
        "type": "urn:topnav:problem:missing",
        "title": "Not Found",
        "status": 404,
        "detail": "no such map",
    }
    return JSONResponse(problem, 404, media_type="application/problem+json")


@contextmanager
def served(app: FastAPI, port: int = 0) -> Iterator[int]:
    """Serve an application on a free port of loopback."""
    config = uvicorn.Config(
        app, host="127.0.0.1", port=port, log_config=None, ws="none", http="h11", lifespan="off"
    )
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, daemon=True)
    thread.start()
    assert wait_until(lambda: server.started, WAIT_S)
    yield int(server.servers[0].sockets[0].getsockname()[1])
    server.should_exit = True
    thread.join(WAIT_S)
