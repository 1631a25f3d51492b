"""Reading a recording that may have been cut off, as far as it is whole."""

import struct
from collections.abc import Iterator
from typing import IO

from mcap.exceptions import McapError
from mcap.records import Channel, Message
from mcap.stream_reader import StreamReader
from zstandard import ZstdError

from services.recorder.backlog import Sample

MAX_RECORD_BYTES = 256_000_000
"""A longer record is damage: the longest message has 64 MB."""

DAMAGE = (McapError, EOFError, struct.error, ZstdError, ValueError, ArithmeticError, LookupError, MemoryError)
"""What the reader of MCAP files raises on damaged ones."""


class WholePart:
    """The messages of a recording up to the first damage; `problem` then says what ended them."""

    def __init__(self, stream: IO[bytes]) -> None:
        self._stream = stream
        self.problem = ""

    def __iter__(self) -> Iterator[Sample]:
        channels: dict[int, str] = {}
        reader = StreamReader(self._stream, validate_crcs=True, record_size_limit=MAX_RECORD_BYTES)
        try:
            for record in reader.records:
                if isinstance(record, Channel):
                    channels[record.id] = record.topic
                elif isinstance(record, Message) and record.channel_id in channels:
                    yield Sample(channels[record.channel_id], record.data, record.log_time)
        except DAMAGE as error:
            self.problem = f"{type(error).__name__}: {error}"
