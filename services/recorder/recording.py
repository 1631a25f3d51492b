"""Writing recordings: the bus's messages as they came, one channel per key, in an MCAP file."""

from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Self

from mcap.writer import CompressionType, Writer

from services.recorder.backlog import Sample
from services.recorder.channels import (
    MESSAGE_ENCODING,
    SCHEMA_ENCODING,
    RecordingError,
    json_schema,
    topic_of,
)
from services.recorder.reading import WholePart

CHUNK_BYTES = 1_000_000  # MCAP's usual size: packs well, and is read as a whole
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

    def __exit__(self, *_: object) -> None:
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
class Recovered:
    """What a recovery found.

    Attributes:
        messages: written to the new file.
        whole: whether the old file was complete.
        problem: where reading ended, empty for a whole file.
    """

    messages: int
    whole: bool
    problem: str


def recover(source: Path, target: Path) -> Recovered:
    """Copy every message up to the first damage into a new, whole recording.

    Raises:
        RecordingError: `source` holds no message at all, or `target` exists.
    """
    with RecordingWriter(target) as writer, source.open("rb") as stream:
        whole = WholePart(stream)
        for sample in whole:
            writer.write(sample)
        messages = sum(writer.counts.values())
    if not messages:
        target.unlink()
        raise RecordingError(f"{source} holds no message of a recording ({whole.problem or 'it is empty'})")
    return Recovered(messages, not whole.problem, whole.problem)
