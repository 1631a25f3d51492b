"""The bus: every kind of message, and the arrays inside them."""

from pathlib import Path
from typing import Annotated, Any, get_args

import msgpack
import numpy as np

from shared.messages import all_messages
from shared.messages.arrays import ArraySpec
from shared.messages.base import Message
from shared.topics import QUERIES, TOPICS
from shared.wire import WireError, decode, encode
from tests.contract.samples import GOLDEN
from tests.fuzz.decoder import Decoder, Shape

DAMAGING = (
    b"\xdd\xff\xff\xff\xff",
    b"\xdf\xff\xff\xff\xff",
    b"\xc6\xff\xff\xff\xff",
    b"\xdb\xff\xff\xff\xff",
)
TOKENS = (
    *DAMAGING,
    b"\xc9\xff\xff\xff\xff\x01",
    b"\xc1",
    b"\xd6\xff",
    b"\xcb\x7f\xf8\0\0\0\0\0\0",
    b"\x91" * 600,
)
FEATURES_SHAPE = Annotated[np.ndarray, ArraySpec(("float32", "uint8"), (None, 2), 512)]


def decoders(_scratch: Path) -> list[Decoder]:
    """One per kind of message, with the longest payload its stream allows."""
    return [*(_message(kind) for kind in all_messages()), _array()]


def unpacked(data: bytes) -> Any:
    """Msgpack -> tree."""
    try:
        return msgpack.unpackb(data, strict_map_key=False)
    except (msgpack.UnpackException, RecursionError, TypeError) as error:
        raise ValueError(str(error)) from error


def packed(tree: Any) -> bytes:
    """Tree -> msgpack."""
    data = msgpack.packb(tree)
    assert isinstance(data, bytes)
    return data


MSGPACK = Shape(unpacked, packed)


def _message(kind: type[Message]) -> Decoder:
    streams = [(stream.message, stream.max_bytes) for stream in TOPICS]
    streams += [(end, query.max_bytes) for query in QUERIES for end in (query.request, query.reply)]
    most = max(max_bytes for message, max_bytes in streams if message is kind)
    seeds = tuple(path.read_bytes() for path in sorted(GOLDEN.glob(f"{kind.SCHEMA}*.msgpack")))

    def run(data: bytes) -> None:
        message = decode(kind, data, most)
        again = encode(message)
        assert encode(decode(kind, again, most + 1_000)) == again, "what was accepted changes when sent on"

    return Decoder(f"bus/{kind.SCHEMA}", run, (WireError,), seeds, TOKENS, MSGPACK)


def _array() -> Decoder:
    spec = next(entry for entry in get_args(FEATURES_SHAPE) if isinstance(entry, ArraySpec))
    good = [np.zeros((3, 2), np.float32), np.full((0, 2), 7, np.uint8)]
    seeds = [packed({"dtype": a.dtype.name, "shape": list(a.shape), "data": a.tobytes()}) for a in good]

    def run(data: bytes) -> None:
        array = spec.check(unpacked(data))
        assert array.shape[1:] == (2,)
        assert np.isfinite(array).all()

    return Decoder("bus/array", run, (ValueError,), tuple(seeds), TOKENS, MSGPACK)
