"""Reading recordings: whole ones by their index and to the end, broken ones as far as they are whole."""

import os
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from mcap.exceptions import McapError
from mcap.reader import FOOTER_SIZE
from mcap.records import Channel, Footer, Message, Statistics
from mcap.stream_reader import MAGIC_SIZE
from zstandard import ZstdError

from services.recorder.backlog import Sample
from services.recorder.channels import RecordingError
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


@dataclass(frozen=True)
class Contents:
    """What a finished recording holds.

    Attributes:
        counts: messages by key.
        duration_s: from the first message to the last.
    """

    counts: dict[str, int]
    duration_s: float


def contents(path: Path) -> Contents:
    """The index at the end of a finished file.

    Raises:
        RecordingError: as for `read`.
    """
    with _opened(path) as stream:
        if not (start := _footer(stream).summary_start):
            return Contents({}, 0.0)
        stream.seek(start)
        channels: dict[int, str] = {}
        statistics: Statistics | None = None
        for record in records(stream, skip_magic=True, chunks=False):
            if isinstance(record, Channel):
                channels[record.id] = record.topic
            elif isinstance(record, Statistics):
                statistics = record
    if statistics is None:
        return Contents({}, 0.0)
    counts = {topic: statistics.channel_message_counts.get(number, 0) for number, topic in channels.items()}
    return Contents(counts, (statistics.message_end_time - statistics.message_start_time) / 1e9)


def read(path: Path) -> Iterator[Sample]:
    """All messages of a finished file, in the order of arrival.

    Raises:
        RecordingError: no recording, one that was cut off, or one that unpacks to more than it may.
    """
    with _opened(path) as stream:
        _footer(stream)  # before the first message is given away
        stream.seek(0)
        yield from samples(stream)


def _footer(stream: IO[bytes]) -> Footer:
    stream.seek(-(FOOTER_SIZE + MAGIC_SIZE), os.SEEK_END)
    footer = next(records(stream, skip_magic=True, chunks=False), None)
    if not isinstance(footer, Footer):
        raise McapError(f"a footer expected at the end, got {type(footer).__name__}")
    return footer


@contextmanager
def _opened(path: Path) -> Iterator[IO[bytes]]:
    with path.open("rb") as stream:
        try:
            yield stream
        except (*DAMAGE, OSError) as error:  # OSError: shorter than a footer
            told = f"{type(error).__name__}: {str(error)[:200]}".rstrip(": ")
            raise RecordingError(
                f"{path} is no whole recording ({told}): 'topnav recover' saves what is in it"
            ) from error
