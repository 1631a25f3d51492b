"""The pictures of a Motion JPEG stream: parts of `multipart/x-mixed-replace`, by Content-Length where given.

Boundaries are taken as they are found, with or without the two hyphens that RFC 2046 puts before them: RICOH
THETAs leave them out, so that parsers which go by the rule find no part at all.
"""

import re
from typing import Protocol

from services.camera.source import MAX_PICTURE_BYTES, SourceError
from shared.jpeg import END_MARK, TAIL_BYTES, BadPictureError, jpeg_size

MAX_LINE_BYTES = 1024
MAX_HEADERS = 32
"""Lines of a part's head and their length; chosen: cameras send two or three short ones."""
BOUNDARY = re.compile(r"boundary=\"?([^\";,]{1,100})", re.IGNORECASE)


class Lines(Protocol):
    """What a stream is read by."""

    def read(self, count: int) -> bytes:
        """Read `count` bytes, fewer at the end."""

    def readline(self, most: int) -> bytes:
        """Read one line or `most` bytes of it; empty at the end."""


class Parts:
    """Reads one part after the other."""

    def __init__(self, stream: Lines, content_type: str) -> None:
        """Prepare.

        Args:
            stream: the body of the answer.
            content_type: its header, which names the boundary.

        Raises:
            SourceError: no multipart.
        """
        found = BOUNDARY.search(content_type)
        if not content_type.lower().startswith("multipart/") or found is None:
            raise SourceError(f"a multipart stream of pictures expected, got {content_type[:80]!r}")
        self._stream, self._name = stream, found[1].strip().strip("-").encode("latin-1", "replace")
        self._at_boundary = False

    def next_jpeg(self) -> bytes:
        """The next part's picture.

        Raises:
            BadPictureError: no JPEG, or not a whole one; the next part may be.
            SourceError: the stream ended, or breaks its own rules.
        """
        self._find_boundary()
        length = self._read_head()
        data = self._up_to_boundary() if length is None else self._stream.read(length)
        if length is not None and len(data) < length:
            raise SourceError(f"the stream ended within a picture, after {len(data)} of {length} bytes")
        jpeg_size(data)
        if END_MARK not in data[-TAIL_BYTES:]:
            why = "it is cut short" + ("" if length is None else ", or its Content-Length lies")
            raise BadPictureError(f"a part of {len(data)} bytes is no whole JPEG: {why}")
        return data

    def _find_boundary(self) -> None:
        """Skip what stands before a part: an empty line, or what is left of one whose length was wrong."""
        skipped = 0
        while not self._at_boundary:
            line = self._stream.readline(MAX_LINE_BYTES)
            if not line:
                raise SourceError("the stream ended")
            self._at_boundary = self._is_boundary(line)
            skipped += len(line)
            if skipped > MAX_PICTURE_BYTES:
                raise SourceError(f"no boundary within {MAX_PICTURE_BYTES} bytes: no stream of pictures")
        self._at_boundary = False

    def _is_boundary(self, line: bytes) -> bool:
        return line.startswith(b"--") and line.strip().strip(b"-") == self._name

    def _read_head(self) -> int | None:
        """Length of the part, None where its head does not say."""
        length = None
        for _ in range(MAX_HEADERS):
            line = self._stream.readline(MAX_LINE_BYTES)
            if not line.endswith(b"\n"):
                raise SourceError(
                    f"the head of a part breaks off, or has a line of over {MAX_LINE_BYTES} bytes"
                )
            if not line.strip():
                return length
            name, _, value = line.partition(b":")
            if name.strip().lower() == b"content-length":
                length = _length(value)
        raise SourceError(f"the head of a part has more than {MAX_HEADERS} lines")

    def _up_to_boundary(self) -> bytes:
        pieces: list[bytes] = []
        size = 0
        while True:
            line = self._stream.readline(MAX_PICTURE_BYTES)
            if not line:
                raise SourceError("the stream ended")
            if self._is_boundary(line):
                self._at_boundary = True
                return b"".join(pieces).rstrip(b"\r\n")
            size += len(line)
            if size > MAX_PICTURE_BYTES:
                raise SourceError(f"a part has more than {MAX_PICTURE_BYTES} bytes")
            pieces.append(line)


def _length(value: bytes) -> int:
    text = value.strip()
    if not text.isdigit() or not 0 < int(text[:12]) <= MAX_PICTURE_BYTES:
        raise SourceError(f"Content-Length of 1 to {MAX_PICTURE_BYTES} expected, got {text[:20]!r}")
    return int(text)
