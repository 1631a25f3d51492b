"""A recording as an MCAP file that Foxglove reads.

The foxglove-sdk gives the schemas and the bytes; the file is written by the library that wrote the recording.
The SDK's own writer is a sink, by default of the whole process, and a write that fails, on a full disk, is a
line in its log until the file is closed.
"""

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, TYPE_CHECKING

from mcap.writer import CompressionType, Writer

from services.recorder.backlog import Sample
from services.recorder.channels import SCHEMA_ENCODING, RecordingError, topic_of
from services.recorder.foxglove.plain_json import plain_json, plain_schema
from services.recorder.reading import WholePart
from services.recorder.recording import CHUNK_BYTES
from shared.messages.base import Message
from shared.wire import WireError, decode

if TYPE_CHECKING:
    from services.recorder.foxglove.drawings import Draw

LIBRARY = "topnav foxglove"


@dataclass(frozen=True)
class Exported:
    """What an export did.

    Attributes:
        counts: messages written, by channel.
        left_out: what could not be written, by key: how many, and why the first of them.
        problem: where reading ended, empty for a whole recording.
    """

    counts: dict[str, int]
    left_out: dict[str, tuple[int, str]]
    problem: str


def export(source: Path, target: Path, draw_more: "Draw | None" = None) -> Exported:
    """Write all messages of a recording, up to the first damage, in forms that Foxglove knows.

    Each message goes as JSON into a channel named like its key; what Foxglove can draw of it goes into one
    below.

    Args:
        source: a file of `topnav record`.
        target: a new file.
        draw_more: further drawings, of messages that this service does not look into.

    Raises:
        RecordingError: the foxglove-sdk is missing, `source` holds no readable message, or `target` exists.
    """
    draw = load_drawings()
    with source.open("rb") as recording, _new_file(target) as stream:
        whole = WholePart(recording)
        exporter = Exporter(stream, (draw,) if draw_more is None else (draw, draw_more))
        for sample in whole:
            exporter.add(sample)
        exporter.finish()
        if not exporter.counts:
            why = whole.problem or next(iter(exporter.reasons.values()), "it is empty")
            raise RecordingError(f"{source} holds no message that can be exported ({why})")
    left_out = {key: (count, exporter.reasons[key]) for key, count in exporter.left_out.items()}
    return Exported(dict(exporter.counts), left_out, whole.problem)


class Exporter:
    """Converts one message after the other."""

    def __init__(self, stream: IO[bytes], draws: "tuple[Draw, ...]") -> None:
        """Start a file.

        Args:
            stream: to write to.
            draws: each gives the drawings of the messages it knows.
        """
        self._draws = draws
        self._writer = Writer(stream, chunk_size=CHUNK_BYTES, compression=CompressionType.ZSTD)
        self._writer.start(library=LIBRARY)
        self._channels: dict[str, int] = {}
        self.counts: Counter[str] = Counter()
        self.left_out: Counter[str] = Counter()
        self.reasons: dict[str, str] = {}

    def add(self, sample: Sample) -> None:
        """Write a message in all its forms; what cannot be written is counted."""
        found = topic_of(sample.key)
        if found is None:
            self._leave_out(sample.key, "no topic of this version")
            return
        topic, _ = found
        try:
            message = decode(topic.message, sample.payload, topic.max_bytes)
        except WireError as error:
            self._leave_out(sample.key, str(error))
            return
        self._add_json(sample, message)
        self._add_drawings(sample, message)

    def finish(self) -> None:
        """Write the index."""
        self._writer.finish()  # type: ignore[no-untyped-call]

    def _add_json(self, sample: Sample, message: Message) -> None:
        if sample.key not in self._channels:
            schema = plain_schema(type(message))
            self._register(sample.key, message.SCHEMA, SCHEMA_ENCODING, schema, "json")
        self._put(sample.key, plain_json(message), sample.arrived_ns)

    def _add_drawings(self, sample: Sample, message: Message) -> None:
        from services.recorder.foxglove.drawings import NotDrawableError

        try:
            drawings = [one for draw in self._draws for one in draw(message, sample.arrived_ns)]
        except NotDrawableError as error:
            self._leave_out(f"{sample.key} as a drawing", str(error))
            return
        for drawing in drawings:
            name = f"{sample.key}/{drawing.part}"
            if name not in self._channels:
                schema = drawing.message.get_schema()
                self._register(name, schema.name, schema.encoding, schema.data, schema.encoding)
            self._put(name, drawing.message.encode(), sample.arrived_ns)

    def _leave_out(self, what: str, reason: str) -> None:
        self.left_out[what] += 1
        self.reasons.setdefault(what, reason)

    def _register(self, name: str, schema: str, schema_encoding: str, data: bytes, encoding: str) -> None:
        number = self._writer.register_schema(schema, schema_encoding, data)
        self._channels[name] = self._writer.register_channel(name, encoding, number)

    def _put(self, name: str, data: bytes, arrived_ns: int) -> None:
        self.counts[name] += 1
        self._writer.add_message(self._channels[name], arrived_ns, data, arrived_ns, self.counts[name])


def load_drawings() -> "Draw":
    """The drawings, imported only here: nothing else of the recorder needs the extra.

    Raises:
        RecordingError: the foxglove-sdk is missing.
    """
    try:
        from services.recorder.foxglove.drawings import draw
    except ImportError as error:
        raise RecordingError(
            f"an export for Foxglove needs one more package: pip install 'topnav[foxglove]' ({error})"
        ) from error
    return draw


@contextmanager
def _new_file(path: Path) -> Iterator[IO[bytes]]:
    """A file that is there only when all went well."""
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        stream = path.open("xb")
    except FileExistsError as error:
        raise RecordingError(f"{path} exists already: choose another file") from error
    try:
        with stream:
            yield stream
    except BaseException:
        path.unlink(missing_ok=True)
        raise
