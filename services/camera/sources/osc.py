"""Open Spherical Camera over wifi: the live preview of a RICOH THETA, `osc://192.168.1.1`.

The preview is a Motion JPEG that ends whenever somebody touches the camera, it takes a picture or changes
its mode; then it is asked for anew. In a house's network a THETA wants user and password, which are its
serial number with and without the letters: `osc://THETAYL00100001:00100001@192.168.1.50`.
"""

import json
import threading
import time
from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel, ConfigDict, Field

from services.camera.camera_url import CameraUrl
from services.camera.source import CameraFacts, Picture, SourceError, SourceKind
from services.camera.streaming.connection import Answer, Request, ask
from services.camera.streaming.multipart import Parts

ANSWER_S = 5.0
"""Chosen: a camera that wakes up."""
FIRST_S = 10.0
"""Until the first picture of a preview; chosen: a THETA changes its mode first."""
SILENCE_S = 2.0
"""Chosen: sixteen pictures at the slowest rate of a preview, 8 Hz."""
STATE_PERIOD_S = 30.0
"""Between two looks at the battery; chosen."""
MAX_JSON_BYTES = 100_000
JSON = (("Content-Type", "application/json; charset=utf-8"), ("X-XSRF-Protected", "1"))
TYPICAL_DELAY_S = 0.4
"""Of the preview of a THETA over its own wifi, as its users measured."""
AWAKE = 65_535
"""What the interface has for "never": a robot's camera must not fall asleep while it looks."""


class OscOptions(BaseModel):
    """Size and rate of the preview, of those that the camera has; it keeps its own where it has not these."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    width: int = Field(default=1024, ge=320, le=4096)
    rate: int = Field(default=30, ge=1, le=60)


class OscSource:
    """One preview."""

    def __init__(self, url: CameraUrl, options: OscOptions, stop: threading.Event) -> None:
        self._url, self._stop = url, stop
        self._model = str(self._json("GET", "/osc/info").get("model", ""))[:80]
        size = {"width": options.width, "height": options.width // 2, "framerate": options.rate}
        # One by one: a camera refuses all of a list for one option that it lacks.
        for option in (
            {"captureMode": "image"},
            {"previewFormat": size},
            {"_topBottomCorrection": "Apply"},  # its own level keeps the horizon
            {"sleepDelay": AWAKE},
            {"offDelay": AWAKE},
        ):
            self._command("camera.setOptions", {"options": option})
        self._look_s = time.monotonic()
        self.facts = self._facts()
        self._answer = self._preview()
        try:
            self._parts = Parts(self._answer, self._answer.content_type)
        except SourceError:
            self._answer.close()
            raise
        self._patience_s = FIRST_S

    def read(self) -> Picture:
        """The next picture of the preview."""
        if time.monotonic() - self._look_s > STATE_PERIOD_S:
            self._look_s = time.monotonic()
            self.facts = self._facts()
        self._answer.allow(self._patience_s)
        data = self._parts.next_jpeg()
        self._patience_s = SILENCE_S
        return Picture(data, time.time_ns())

    def close(self) -> None:
        """End the preview."""
        self._answer.close()

    def _preview(self) -> Answer:
        body = _command_body("camera.getLivePreview", {})
        answer = ask(self._url, Request("POST", "/osc/commands/execute", body, JSON), self._stop, FIRST_S)
        if answer.content_type.lower().startswith("multipart/"):
            return answer
        with answer:
            raise SourceError(f"no live preview: {_refusal(answer)}")

    def _facts(self) -> CameraFacts:
        """Battery and mode; what cannot be had is left out."""
        state = self._try("POST", "/osc/state", b"{}").get("state")
        battery = state.get("batteryLevel") if isinstance(state, dict) else None
        known = float(battery) if isinstance(battery, int | float) and 0.0 <= battery <= 1.0 else None
        options = self._command("camera.getOptions", {"optionNames": ["captureMode"]}).get("results")
        options = options.get("options") if isinstance(options, dict) else None
        mode = options.get("captureMode", "") if isinstance(options, dict) else ""
        return CameraFacts(self._model, str(mode)[:40], known)

    def _command(self, name: str, parameters: Mapping[str, Any]) -> dict[str, Any]:
        return self._try("POST", "/osc/commands/execute", _command_body(name, parameters))

    def _try(self, method: str, path: str, body: bytes) -> dict[str, Any]:
        try:
            return self._json(method, path, body)
        except SourceError:
            return {}

    def _json(self, method: str, path: str, body: bytes | None = None) -> dict[str, Any]:
        with ask(self._url, Request(method, path, body, JSON), self._stop, ANSWER_S) as answer:
            if answer.status != 200:
                raise SourceError(f"{path}: {_refusal(answer)}")
            try:
                found = json.loads(answer.read(MAX_JSON_BYTES))
            except (ValueError, RecursionError) as error:
                raise SourceError(f"{path}: no Open Spherical Camera answers there") from error
        if not isinstance(found, dict):
            raise SourceError(f"{path}: no Open Spherical Camera answers there")
        return found


def _command_body(name: str, parameters: Mapping[str, Any]) -> bytes:
    return json.dumps({"name": name, "parameters": dict(parameters)}).encode()


def _refusal(answer: Answer) -> str:
    """What the camera says against it, in one line."""
    text = answer.read(2000).decode("utf-8", "replace")
    try:
        error = json.loads(text)["error"]
        return f"{error['code']}: {error['message']}"[:200]
    except (ValueError, KeyError, TypeError, RecursionError):
        hint = ", give its user and password" if answer.status == 401 else ""
        return f"HTTP {answer.status}{hint}"


KIND = SourceKind(
    schemes=("osc",),
    example="osc://192.168.1.1",
    options=OscOptions,
    open=OscSource,
    delay_s=TYPICAL_DELAY_S,
)
