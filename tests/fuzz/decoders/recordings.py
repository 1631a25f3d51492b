"""MCAP recordings: whole ones, and those of which the whole part is saved."""

import io
from pathlib import Path

from services.recorder.backlog import Sample
from services.recorder.channels import RecordingError
from services.recorder.reading import WholePart, contents, read
from services.recorder.recording import RecordingWriter
from shared.messages.sensors import Ranges
from shared.wire import encode
from tests.fuzz.decoder import Decoder

TOKENS = (b"\x89MCAP0\r\n", b"zstd", b"lz4", b"topnav/r1/ranges", b"\x05", b"\x06", b"\x0f", b"\xff" * 8)


def decoders(scratch: Path) -> list[Decoder]:
    """Reading by the index, and from start to damage."""
    good = recording(scratch / "seed.mcap")
    file = scratch / "fuzzed.mcap"

    def indexed(data: bytes) -> None:
        file.write_bytes(data)
        contents(file)
        for sample in read(file):
            assert isinstance(sample.payload, bytes)

    return [
        Decoder("recordings/read", indexed, (RecordingError,), (good, good[:-200]), TOKENS),
        Decoder("recordings/recover", _whole_part, (RecordingError,), (good, good[:-200]), TOKENS),
    ]


def recording(path: Path) -> bytes:
    """A small recording of two keys."""
    path.unlink(missing_ok=True)
    with RecordingWriter(path) as writer:
        for number in range(8):
            ranges = Ranges(
                robot="r1", seq=number, angles_rad=(0.0,) * 12, distances_m=(1.0,) * 12, max_range_m=4.0
            )
            writer.write(Sample(f"topnav/r{1 + number % 2}/ranges", encode(ranges), 10**9 + number))
            if number == 4:
                writer.flush()
    return path.read_bytes()


def _whole_part(data: bytes) -> None:
    whole = WholePart(io.BytesIO(data))
    for sample in whole:
        assert isinstance(sample.payload, bytes)
    if whole.problem:
        raise RecordingError(whole.problem)
