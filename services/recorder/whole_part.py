"""Reading a recording that may have been cut off, as far as it is whole."""

import struct
from collections.abc import Iterator
from typing import IO

from mcap.exceptions import McapError
from mcap.records import Channel, Message
from zstandard import ZstdError

from services.recorder.backlog import Sample
from services.recorder.chunks import records

DAMAGE = (McapError, EOFError, struct.error, ZstdError, ValueError, ArithmeticError, LookupError, MemoryError)
"""What the reader of MCAP files raises on damaged ones."""


def samples(stream: IO[bytes]) -> Iterator[Sample]:
    """All messages of a recording, as they were written.

    Raises:
        Exception: one of DAMAGE, where the whole part ends.
    """
    channels: dict[int, str] = {}
    for record in records(stream):
        if isinstance(record, Channel):
            channels[record.id] = record.topic
        elif isinstance(record, Message) and record.channel_id in channels:
            yield Sample(channels[record.channel_id], record.data, record.log_time)


class WholePart:
    """The messages of a recording up to the first damage; `problem` then says what ended them."""

    def __init__(self, stream: IO[bytes]) -> None:
        self._stream = stream
        self.problem = ""

    def __iter__(self) -> Iterator[Sample]:
        try:
            yield from samples(self._stream)
        except DAMAGE as error:
            self.problem = f"{type(error).__name__}: {error}"
