"""Chunks that unpack to more than they may are refused before they do, whatever their heads say."""

import resource
import struct

import lz4.frame
import pytest
import zstandard
from mcap.data_stream import RecordBuilder
from mcap.records import Chunk, DataEnd, Footer, Header

from services.recorder import chunks
from services.recorder.channels import RecordingError
from services.recorder.chunks import MAX_CHUNK_BYTES
from services.recorder.reading import contents, read
from services.recorder.recording import recover

MAGIC = bytes((137, 77, 67, 65, 80, 48, 13, 10))
BLOCK = 128 * 1024
GIGABYTE = 2**30
MOST_MB = 300
"""More memory than before: a chunk as large as allowed, once as bytes and once as a stream."""


def zstd_bomb(size):
    """A frame of `size` zeros that nobody had to pack: runs of one byte, 4 bytes for 128 kB."""
    blocks = size // BLOCK
    runs = b"".join(
        struct.pack("<I", (number == blocks - 1) | 1 << 1 | BLOCK << 3)[:3] + b"\0"
        for number in range(blocks)
    )
    return b"\x28\xb5\x2f\xfd" + bytes((0b11000000, 0x38)) + struct.pack("<Q", size) + runs


def lz4_bomb(size):
    packer = lz4.frame.LZ4FrameCompressor()
    packed = packer.begin() + b"".join(packer.compress(bytes(2**24)) for _ in range(size // 2**24))
    return packed + packer.flush()


def file_of(path, data, said, compression, summary=False):
    """A file with one chunk said to hold `said` bytes; with `summary` it stands where the index should."""
    builder = RecordBuilder()
    Header(profile="", library="test").write(builder)
    at = len(MAGIC) + builder.count
    Chunk(
        compression=compression,
        data=data,
        message_start_time=0,
        message_end_time=0,
        uncompressed_crc=0,
        uncompressed_size=said,
    ).write(builder)
    DataEnd(data_section_crc=0).write(builder)
    Footer(summary_start=at if summary else 0, summary_offset_start=0, summary_crc=0).write(builder)
    path.write_bytes(MAGIC + builder.end() + MAGIC)
    return path


def peak_mb():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


BOMBS = [
    pytest.param(zstd_bomb, GIGABYTE, "zstd", f"at most {MAX_CHUNK_BYTES} bytes expected", id="honest"),
    pytest.param(zstd_bomb, 100, "zstd", "100 bytes expected .* got more", id="says little"),
    pytest.param(zstd_bomb, MAX_CHUNK_BYTES, "zstd", "got more", id="says as much as allowed"),
    pytest.param(lz4_bomb, 100, "lz4", "100 bytes expected .* got more", id="lz4"),
]


def test_the_bomb_is_one():
    assert zstandard.ZstdDecompressor().decompress(zstd_bomb(8 * BLOCK)) == bytes(8 * BLOCK)
    assert len(zstd_bomb(GIGABYTE)) < 40_000


@pytest.mark.parametrize(("bomb", "said", "compression", "told"), BOMBS)
def test_a_bomb_is_refused_with_file_and_limit(tmp_path, bomb, said, compression, told):
    path = file_of(tmp_path / "bomb.mcap", bomb(GIGABYTE), said, compression)
    before_mb = peak_mb()
    with pytest.raises(RecordingError, match=rf"bomb\.mcap .*{told}"):
        list(read(path))
    with pytest.raises(RecordingError, match=rf"bomb\.mcap .*{told}"):
        recover(path, tmp_path / "saved.mcap")
    assert peak_mb() - before_mb < MOST_MB


def test_a_bomb_in_the_place_of_the_index_is_not_unpacked(tmp_path, monkeypatch):
    monkeypatch.setattr(chunks, "_unpacked", pytest.fail)
    path = file_of(tmp_path / "bomb.mcap", zstd_bomb(GIGABYTE), 100, "zstd", summary=True)
    assert contents(path).counts == {}


@pytest.mark.parametrize(
    ("pack", "compression"), [(zstandard.compress, "zstd"), (lz4.frame.compress, "lz4"), (bytes, "")]
)
def test_chunks_are_read_however_they_are_packed(tmp_path, pack, compression):
    data = struct.pack("<BQ", 0x7F, 3) + b"abc"  # a record of a kind that we skip
    assert list(read(file_of(tmp_path / "a.mcap", pack(data), len(data), compression))) == []
    with pytest.raises(RecordingError, match=f"{len(data) + 1} bytes expected in a chunk"):
        list(read(file_of(tmp_path / "b.mcap", pack(data), len(data) + 1, compression)))


def test_other_packers_are_named(tmp_path):
    with pytest.raises(RecordingError, match="zstd, lz4 or not at all expected, got 'brotli'"):
        list(read(file_of(tmp_path / "a.mcap", b"abc", 3, "brotli")))
