"""URLs of cameras, taken apart. Pure."""

from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import parse_qsl, unquote, urlencode, urlsplit

WIDEST_MASK_DEG = 30.0
OURS = ("fisheye", "mask_deg")
"""Options of any source; all others belong to the source."""


@dataclass(frozen=True)
class CameraUrl:
    """A camera's URL.

    Attributes:
        scheme: "osc", "v4l2", "http", …; "file" of a plain path.
        host, port, user, password: of a camera in a network, else empty.
        path: after the host; of files and devices the path itself.
        options: what follows the question mark, without what is ours.
        fisheye: calibration of a camera that gives two fisheyes in one picture.
        mask_deg: half the width of the band along their seam that is blurred.
    """

    scheme: str
    host: str = ""
    port: int | None = None
    user: str = ""
    password: str = field(default="", repr=False)
    path: str = ""
    options: tuple[tuple[str, str], ...] = ()
    fisheye: Path | None = None
    mask_deg: float = 0.0

    @property
    def shown(self) -> str:
        """The URL for logs and people: without the password."""
        return self._written(f"{self.user}:***@" if self.user else "")

    @property
    def plain(self) -> str:
        """The URL as the camera needs it, without what is ours."""
        return self._written(f"{self.user}:{self.password}@" if self.user else "")

    def _written(self, who: str) -> str:
        if not self.host:
            return f"{self.scheme}:{self.path}"
        query = f"?{urlencode(self.options)}" if self.options else ""
        port = f":{self.port}" if self.port else ""
        return f"{self.scheme}://{who}{self.host}{port}{self.path}{query}"


def parse_camera_url(text: str) -> CameraUrl:
    """Take a URL apart; a path without a scheme is a file's or folder's.

    Raises:
        ValueError: it is no URL, or an option of ours makes no sense.
    """
    if not text.strip():
        raise ValueError("a camera's URL expected, such as osc://192.168.1.1 or v4l2:/dev/video0, got none")
    parts = urlsplit(text.strip() if ":" in text.partition("/")[0] else f"file:{text.strip()}")
    try:
        port = parts.port
    except ValueError as error:
        raise ValueError(f"{text[:80]!r} is no URL: {error}") from error
    given = parse_qsl(parts.query, keep_blank_values=True)
    ours = {name: value for name, value in given if name in OURS}
    return CameraUrl(
        scheme=parts.scheme,
        host=parts.hostname or "",
        port=port,
        user=unquote(parts.username or ""),
        password=unquote(parts.password or ""),
        path=unquote(parts.path) if not parts.hostname else parts.path,
        options=tuple((name, value) for name, value in given if name not in OURS),
        fisheye=Path(ours["fisheye"]) if ours.get("fisheye") else None,
        mask_deg=_mask_deg(ours.get("mask_deg", "0")),
    )


def _mask_deg(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.0 <= value <= WIDEST_MASK_DEG:
        raise ValueError(f"mask_deg must be degrees from 0 to {WIDEST_MASK_DEG:.0f}, got {text[:40]!r}")
    return value
