"""A recording: the bus's messages as they came, one channel per key, in an MCAP file."""

import os
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import IO, Self

from mcap.exceptions import McapError
from mcap.reader import FOOTER_SIZE
from mcap.records import Channel, Footer, Statistics
from mcap.stream_reader import MAGIC_SIZE
from mcap.writer import CompressionType, Writer

from services.recorder.backlog import Sample
from services.recorder.channels import (
    MESSAGE_ENCODING,
    SCHEMA_ENCODING,
    RecordingError,
    json_schema,
    topic_of,
)
from services.recorder.chunks import records
from services.recorder.whole_part import DAMAGE, samples

CHUNK_BYTES = 1_000_000
LIBRARY = "topnav recorder"


class RecordingWriter:
    """Writes one file; what was flushed can be recovered even when the process dies."""

    def __init__(self, path: Path) -> None:
        """Start a file.

        Raises:
            RecordingError: it exists already.
        """
        if path.exists():
            raise RecordingError(f"{path} exists already: choose another file")
        path.parent.mkdir(parents=True, exist_ok=True)
        self.counts: Counter[str] = Counter()
        self._stream = path.open("wb")
        self._writer = Writer(self._stream, chunk_size=CHUNK_BYTES, compression=CompressionType.ZSTD)
        self._writer.start(library=LIBRARY)
        self._channels: dict[str, int] = {}

    def write(self, sample: Sample) -> None:
        """Append one message; those of keys that are no topic of ours are left out."""
        channel = self._channels.get(sample.key)
        if channel is None:
            channel = self._register(sample.key)
            if channel is None:
                return
        self.counts[sample.key] += 1
        sequence = self.counts[sample.key]
        self._writer.add_message(channel, sample.arrived_ns, sample.payload, sample.arrived_ns, sequence)

    def flush(self) -> None:
        """Hand everything to the operating system."""
        self._writer.flush()  # type: ignore[no-untyped-call]
        self._stream.flush()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._writer.finish()  # type: ignore[no-untyped-call]
        self._stream.close()

    def _register(self, key: str) -> int | None:
        found = topic_of(key)
        if found is None:
            return None
        topic, _ = found
        schema = self._writer.register_schema(topic.message.SCHEMA, SCHEMA_ENCODING, json_schema(topic))
        self._channels[key] = self._writer.register_channel(key, MESSAGE_ENCODING, schema)
        return self._channels[key]


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
