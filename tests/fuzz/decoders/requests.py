"""Bodies of HTTP requests to the gateway, and paths and bodies of those to the map store."""

import asyncio
import json
import re
from http import HTTPStatus
from pathlib import Path
from typing import Any
from urllib.parse import unquote_to_bytes

from pydantic import BaseModel
from starlette.requests import Request

from services.gateway.http.bodies import read_json, read_picture
from services.gateway.routes.estop import Clear
from services.gateway.routes.missions import StartMission
from services.map_store.storage.database import Database
from services.map_store.store import MapStore
from shared.web.problems import ProblemError
from tests.fuzz.decoder import Decoder, Shape
from tests.unit.services.map_store.conftest import app_of

TOKENS = (b"NaN", b"1e999", b"[" * 2000, b'{"a":' * 2000, b"\xed\xa0\x80", b'"\\ud800"', b'"map":"flat",')
FORM_TOKENS = (
    b"--b\r\n",
    b"--b--",
    b"\r\n\r\n",
    b"filename*=utf-8''%00",
    b"Content-Transfer-Encoding: base64\r\n",
)
PATH_TOKENS = (
    b"%00",
    b"%0a",
    b"..%2f",
    b"..%5c",
    b"/maps/",
    b"flat",
    b"/nodes/",
    b"/edges/",
    b"?from=",
    b"*",
    b"%ff",
)
FORM = (
    b'--b\r\nContent-Disposition: form-data; name="picture"; filename="a.png"\r\n'
    b"Content-Type: image/png\r\n\r\n\x89PNG\r\n\x1a\n\r\n--b--\r\n"
)
VISIBLE = re.compile(rb"[\x21-\x7e]+")
BODIES: tuple[tuple[type[BaseModel], dict[str, Any]], ...] = (
    (StartMission, {"action": "explore", "map": "flat", "seed": 1}),
    (Clear, {"who": "me"}),
)
PATHS = (
    b"GET /maps/flat",
    b"GET /maps/flat/nodes/0",
    b"DELETE /maps/flat/edges/0/1",
    b"GET /maps/flat/compare?from=1",
    b'POST /maps {"name": "more"}',
    b'POST /maps/flat/merge {"other": "more"}',
    b"GET /maps/flat/revisions?limit=3&before=9",
    b"GET /maps/flat/export",
)


def decoders(scratch: Path) -> list[Decoder]:
    """JSON bodies by kind, the form of an upload, and whole requests to the map store."""
    shape = Shape(_from_json, _to_json)
    loop = asyncio.new_event_loop()
    return [
        *(
            Decoder(f"requests/{kind.__name__.lower()}", _json_reader(loop, kind), (ProblemError,),
                    (_to_json(body),), TOKENS, shape)
            for kind, body in BODIES
        ),
        Decoder("requests/form", _form_reader(loop), (ProblemError,), (FORM,), FORM_TOKENS),
        Decoder("requests/map-store", _map_store(loop, scratch), (_RefusedError,), PATHS, PATH_TOKENS),
    ]  # fmt: skip


class _RefusedError(Exception):
    """An answer of 4xx."""


def _request(body: bytes, content_type: str) -> Request:
    async def receive() -> dict[str, Any]:
        return {"type": "http.request", "body": body, "more_body": False}

    headers = [(b"content-type", content_type.encode())]
    scope = {"type": "http", "method": "POST", "path": "/", "query_string": b"", "headers": headers}
    return Request(scope, receive)


def _json_reader(loop: asyncio.AbstractEventLoop, kind: type[BaseModel]) -> Any:
    def run(data: bytes) -> None:
        wish = loop.run_until_complete(read_json(_request(data, "application/json"), kind, 5.0))
        assert isinstance(wish, kind)

    return run


def _form_reader(loop: asyncio.AbstractEventLoop) -> Any:
    def run(data: bytes) -> None:
        request = _request(data, "multipart/form-data; boundary=b")
        picture, _ = loop.run_until_complete(read_picture(request, 100_000, 5.0))
        assert len(picture) <= 100_000

    return run


def _map_store(loop: asyncio.AbstractEventLoop, scratch: Path) -> Any:
    """Method, path, query and body as one line, put to the application as a server would."""
    (scratch / "fuzzed.sqlite3").unlink(missing_ok=True)
    store = MapStore(Database(f"sqlite:///{scratch}/fuzzed.sqlite3"), lambda: 1, lambda _delta: None)
    store.create("flat")
    app = app_of(store, max_archive_bytes=100_000)

    def run(data: bytes) -> None:
        head, _, body = data.partition(b" {")
        method, _, target = head.partition(b" ")
        path, _, query = target.partition(b"?")
        if not VISIBLE.fullmatch(target):
            raise _RefusedError("the server takes visible ASCII only as a target")
        status = loop.run_until_complete(_answered(app, method, path, query, b"{" + body))
        assert status < 500, f"answered {status}"
        if status >= 400:
            raise _RefusedError(HTTPStatus(status).phrase)

    return run


async def _answered(app: Any, method: bytes, path: bytes, query: bytes, body: bytes) -> int:
    statuses: list[int] = []
    events: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
    events.put_nowait({"type": "http.request", "body": body, "more_body": False})

    async def send(message: dict[str, Any]) -> None:
        if message["type"] == "http.response.start":
            statuses.append(message["status"])

    scope = {
        "type": "http", "asgi": {"version": "3.0"}, "http_version": "1.1", "scheme": "http",
        "method": method.decode("ascii", "replace"), "raw_path": path, "query_string": query,
        "path": unquote_to_bytes(path).decode("utf-8", "replace"), "root_path": "",
        "headers": [(b"content-type", b"application/json")], "server": ("127.0.0.1", 80), "client": None,
    }  # fmt: skip
    await app(scope, events.get, send)
    return statuses[0]


def _from_json(data: bytes) -> Any:
    return json.loads(data)


def _to_json(tree: Any) -> bytes:
    return json.dumps(tree).encode()
