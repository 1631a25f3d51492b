"""A camera that speaks Open Spherical Camera as a RICOH THETA does, with its quirk and its moods."""

import contextlib
import json
import socket
import threading
import time
from collections import deque
from collections.abc import Callable
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any, Self

BOUNDARY = b"---osclivepreview---"  # in the header, and before parts, where the rule wants two hyphens more
HOST = "127.0.0.1"
PICTURES_KEPT = 200

Pictures = Callable[[float], bytes]
"""The JPEG that is exposed at a time, monotonic seconds."""


class OscCamera:
    """The camera. What people do to it are methods; what it was asked for stands in `asked`.

    Args:
        pictures: what it sees.
        rate_hz: of its preview.
        delay_s: from exposure until the picture is sent.
    """

    def __init__(self, pictures: Pictures, rate_hz: float = 20.0, delay_s: float = 0.0) -> None:
        self._pictures, self._rate_hz, self.delay_s = pictures, rate_hz, delay_s
        self.battery, self.mode, self.model = 0.63, "image", "RICOH THETA Z1"
        self.user = self.password = ""
        self.asked: deque[str] = deque(maxlen=PICTURES_KEPT)
        self.options: dict[str, Any] = {}
        self.previews = 0
        self.silent = threading.Event()
        self._touched = threading.Event()
        self._sockets: set[socket.socket] = set()
        self._server: ThreadingHTTPServer | None = None
        self.port = 0

    @property
    def url(self) -> str:
        who = f"{self.user}:{self.password}@" if self.user else ""
        return f"osc://{who}{HOST}:{self.port}"

    def plug(self) -> None:
        """Switch it on, at the same address as before."""
        camera = self

        class Handler(_Handler):
            owner = camera

        self._touched = threading.Event()
        self._server = _Server((HOST, self.port), Handler)
        self.port = self._server.server_address[1]
        threading.Thread(target=self._server.serve_forever, args=(0.02,), daemon=True).start()

    def unplug(self) -> None:
        """Take its battery out: connections break and nothing listens."""
        assert self._server is not None
        self._touched.set()
        self._server.shutdown()
        self._server.server_close()
        for one in list(self._sockets):
            with contextlib.suppress(OSError):
                one.shutdown(socket.SHUT_RDWR)
        self._server = None

    def touch(self, mode: str = "video") -> None:
        """Press its mode button: the preview ends."""
        self.mode = mode
        before, self._touched = self._touched, threading.Event()
        before.set()

    def __enter__(self) -> Self:
        self.plug()
        return self

    def __exit__(self, *_: object) -> None:
        if self._server is not None:
            self.unplug()


class _Server(ThreadingHTTPServer):
    allow_reuse_address = True
    daemon_threads = True
    block_on_close = False

    def handle_error(self, *_: Any) -> None:
        """A client that goes away is no news."""


class _Handler(BaseHTTPRequestHandler):
    owner: OscCamera
    protocol_version = "HTTP/1.1"

    def setup(self) -> None:
        super().setup()
        self.owner._sockets.add(self.connection)

    def finish(self) -> None:
        self.owner._sockets.discard(self.connection)
        with contextlib.suppress(OSError):
            super().finish()

    def log_message(self, *_: Any) -> None:
        """Nothing on standard error."""

    def do_GET(self) -> None:
        self._serve(b"")

    def do_POST(self) -> None:
        self._serve(self.rfile.read(int(self.headers.get("Content-Length", 0))))

    def _serve(self, body: bytes) -> None:
        camera = self.owner
        if camera.user and "Authorization" not in self.headers:
            self._answer(401, {}, 'Digest realm="RICOH THETA", nonce="0123", qop="auth", algorithm=MD5')
            return
        command = json.loads(body) if body else {}
        camera.asked.append(command.get("name", self.path))
        if self.path == "/osc/info":
            self._answer(200, {"model": camera.model, "apiLevel": [2]})
        elif self.path == "/osc/state":
            self._answer(200, {"fingerprint": "F", "state": {"batteryLevel": camera.battery}})
        elif self.path == "/osc/commands/execute":
            self._execute(command["name"], command.get("parameters", {}))
        else:
            self._answer(404, {})

    def _execute(self, name: str, parameters: dict[str, Any]) -> None:
        camera = self.owner
        if name == "camera.setOptions":
            camera.options |= parameters["options"]
            camera.mode = parameters["options"].get("captureMode", camera.mode)
            self._answer(200, {"name": name, "state": "done"})
        elif name == "camera.getOptions":
            self._answer(200, {"state": "done", "results": {"options": {"captureMode": camera.mode}}})
        elif camera.mode != "image":
            error = {"code": "disabledCommand", "message": "Command is currently disabled."}
            self._answer(400, {"name": name, "state": "error", "error": error})
        else:
            self._preview()

    def _answer(self, status: int, answer: dict[str, Any], challenge: str = "") -> None:
        data = json.dumps(answer).encode()
        self.send_response(status)
        if challenge:
            self.send_header("WWW-Authenticate", challenge)
        self.send_header("Content-Type", "application/json;charset=utf-8")
        self.send_header("Content-Length", str(len(data)))
        self.end_headers()
        self.wfile.write(data)

    def _preview(self) -> None:
        camera, touched = self.owner, self.owner._touched
        camera.previews += 1
        self.send_response(200)
        self.send_header("Content-Type", f'multipart/x-mixed-replace; boundary="{BOUNDARY.decode()}"')
        self.send_header("Transfer-Encoding", "chunked")
        self.end_headers()
        waiting: deque[tuple[float, bytes]] = deque()
        while not touched.wait(1.0 / camera._rate_hz):
            now_s = time.monotonic()
            waiting.append((now_s + camera.delay_s, camera._pictures(now_s)))
            while waiting and waiting[0][0] <= time.monotonic() and not camera.silent.is_set():
                self._part(waiting.popleft()[1])
        self.close_connection = True

    def _part(self, jpeg: bytes) -> None:
        head = BOUNDARY + b"\r\nContent-type: image/jpeg\r\nContent-Length: %d\r\n\r\n" % len(jpeg)
        data = head + jpeg + b"\r\n"
        # Chunks end where they like, and not where parts do.
        for piece in (data[:1000], data[1000:]):
            if piece:
                self.wfile.write(b"%x\r\n" % len(piece) + piece + b"\r\n")
