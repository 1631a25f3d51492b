"""Parts of a Motion JPEG stream: with and without the rule's hyphens and a length, and broken."""

import io

import pytest

from services.camera.source import SourceError
from services.camera.streaming.multipart import Parts
from shared.jpeg import BadPictureError
from tests.noisy_pictures import NoisyPictures, painted

THETA = 'multipart/x-mixed-replace; boundary="---osclivepreview---"'
JPEG = NoisyPictures(painted(64))()


def part(before: bytes, data: bytes, length: int | None = None, newline: bytes = b"\r\n") -> bytes:
    told = b"" if length is None else b"Content-Length: %d" % length + newline
    return before + newline + b"Content-type: image/jpeg" + newline + told + newline + data + newline


def parts(body: bytes, content_type: str = THETA) -> Parts:
    return Parts(io.BytesIO(body), content_type)


@pytest.mark.parametrize(
    ("before", "content_type"),
    [
        (b"---osclivepreview---", THETA),
        (b"-----osclivepreview---", THETA),
        (b"--frame", "multipart/x-mixed-replace;boundary=frame"),
        (b"--frame", "multipart/x-mixed-replace; boundary=--frame"),
    ],
    ids=["theta", "by the rule", "plain", "hyphens in the header"],
)
@pytest.mark.parametrize("length", [len(JPEG), None], ids=["with length", "without"])
@pytest.mark.parametrize("newline", [b"\r\n", b"\n"], ids=["crlf", "lf"])
def test_pictures_are_found_however_the_boundary_is_written(before, content_type, length, newline):
    body = part(before, JPEG, length, newline) * 3 + before
    stream = parts(body, content_type)
    assert [stream.next_jpeg() for _ in range(3)] == [JPEG] * 3


def test_a_boundary_within_a_picture_is_no_end_where_the_length_is_known():
    tricky = JPEG[:-2] + b"\r\n---osclivepreview---\r\n" + b"\xff\xd9"
    stream = parts(part(b"---osclivepreview---", tricky, len(tricky)))
    assert stream.next_jpeg() == tricky


def test_a_length_that_lies_costs_one_picture():
    short = part(b"---osclivepreview---", JPEG, len(JPEG) - 100)
    stream = parts(short + part(b"---osclivepreview---", JPEG, len(JPEG)))
    with pytest.raises(BadPictureError, match="no whole JPEG: it is cut short, or its Content-Length lies"):
        stream.next_jpeg()
    assert stream.next_jpeg() == JPEG


@pytest.mark.parametrize(
    ("body", "said"),
    [
        (b"", "the stream ended"),
        (part(b"---osclivepreview---", JPEG, len(JPEG))[:200], "ended within a picture"),
        (part(b"---osclivepreview---", JPEG, 10**9), "Content-Length of 1 to"),
        (b"---osclivepreview---\r\n" + b"x" * 3000, "head of a part breaks off"),
        (b"---osclivepreview---\r\n" + b"a: b\r\n" * 40, "more than 32 lines"),
        (b"x" * 20_000_000, "no boundary within"),
    ],
    ids=["nothing", "cut", "huge", "line", "lines", "noise"],
)
def test_a_stream_that_breaks_its_rules_is_given_up(body, said):
    with pytest.raises(SourceError, match=said):
        parts(body).next_jpeg()


def test_a_page_is_no_stream():
    with pytest.raises(SourceError, match="multipart stream of pictures expected, got 'text/html'"):
        parts(b"", "text/html")
