"""Pictures as arguments of tools."""

import base64
import binascii
from dataclasses import dataclass
from typing import Annotated

from mcp.server.mcpserver.exceptions import ToolError
from pydantic import Field

LONGEST = 4_000_000
"""Characters: 3 MB, a panorama of 4096 pixels as JPEG."""

Photo = Annotated[
    str,
    Field(
        max_length=LONGEST,
        description="a panorama, twice as wide as high, or an ordinary photo: JPEG in base64",
    ),
]


SIGNATURES = {b"\xff\xd8\xff": "image/jpeg", b"\x89PNG\r\n\x1a\n": "image/png", b"RIFF": "image/webp"}


@dataclass(frozen=True)
class Picture:
    """Bytes of a file, and the type that they begin as; whether they are one the gateway sees."""

    data: bytes
    media_type: str


def picture_of(photo: str) -> Picture:
    """The picture in an argument.

    Raises:
        ToolError: no base64, or no JPEG, PNG or WebP.
    """
    try:
        data = base64.b64decode(photo, validate=True)
    except binascii.Error as error:
        raise ToolError(f"photo must be base64 of a picture's bytes: {error}") from None
    for signature, media_type in SIGNATURES.items():
        if data.startswith(signature):
            return Picture(data, media_type)
    raise ToolError(f"photo must be a JPEG, PNG or WebP, got bytes that begin {data[:8]!r}")
