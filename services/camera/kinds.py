"""Every kind of source by the schemes of its URLs."""

import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel, ValidationError

from services.camera.camera_url import CameraUrl, parse_camera_url
from services.camera.source import Source, SourceKind
from services.camera.sources import file, http, osc, rtsp, v4l2

KINDS: tuple[SourceKind[Any], ...] = (osc.KIND, v4l2.KIND, http.KIND, rtsp.KIND, file.KIND)


@dataclass(frozen=True)
class CameraAddress:
    """A URL whose kind and options are known to be right.

    Attributes:
        stepped: each picture waits until the last one was worked on.
    """

    url: CameraUrl
    kind: SourceKind[Any]
    options: BaseModel | None

    @property
    def stepped(self) -> bool:
        """Whether each picture waits until the last one was worked on."""
        return self.kind.stepped(self.options)

    def opener(self, stop: threading.Event) -> Callable[[], Source]:
        """What opens the source, each time anew."""
        return lambda: self.kind.open(self.url, self.options, stop)


def find_camera(text: str) -> CameraAddress:
    """What a URL names.

    Raises:
        ValueError: no URL of a camera, or an option that its kind does not have.
    """
    url = parse_camera_url(text)
    kind = next((one for one in KINDS if url.scheme in one.schemes), None)
    if kind is None:
        examples = ", ".join(one.example for one in KINDS)
        raise ValueError(f"a camera's URL such as {examples} expected, got {url.shown[:80]!r}")
    if kind is not file.KIND and kind is not v4l2.KIND and not url.host:
        raise ValueError(f"{url.shown[:80]!r} names no host, as {kind.example} does")
    if kind.options is None:
        return CameraAddress(url, kind, None)
    try:
        return CameraAddress(url, kind, kind.options.model_validate(dict(url.options)))
    except ValidationError as error:
        fault = error.errors()[0]
        name = ".".join(map(str, fault["loc"]))
        known = ", ".join((*kind.options.model_fields, "fisheye", "mask_deg"))
        raise ValueError(f"{url.shown[:80]}: option {name!r}: {fault['msg']}; there are {known}") from error
