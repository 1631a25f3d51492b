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
from services.recorder.channels import RecordingError
from services.recorder.foxglove.forms import Form, as_drawings, as_json, load_drawings, message_of
from services.recorder.reading import WholePart
from services.recorder.recording import CHUNK_BYTES
from shared.wire import WireError

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
        from services.recorder.foxglove.drawings import NotDrawableError

        try:
            message = message_of(sample.key, sample.payload)
        except WireError as error:
            self._leave_out(sample.key, str(error))
            return
        self._put(as_json(sample.key, message), sample.arrived_ns)
        try:
            for form in as_drawings(sample.key, message, sample.arrived_ns, self._draws):
                self._put(form, sample.arrived_ns)
        except NotDrawableError as error:
            self._leave_out(f"{sample.key} as a drawing", str(error))

    def finish(self) -> None:
        """Write the index."""
        self._writer.finish()  # type: ignore[no-untyped-call]

    def _leave_out(self, what: str, reason: str) -> None:
        self.left_out[what] += 1
        self.reasons.setdefault(what, reason)

    def _put(self, form: Form, arrived_ns: int) -> None:
        name = form.channel
        if name not in self._channels:
            schema = form.schema()
            number = self._writer.register_schema(schema.name, schema.encoding, schema.definition)
            self._channels[name] = self._writer.register_channel(name, schema.message_encoding, number)
        self.counts[name] += 1
        self._writer.add_message(self._channels[name], arrived_ns, form.data, arrived_ns, self.counts[name])


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
