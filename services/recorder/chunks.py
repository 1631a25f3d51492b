"""Records of an MCAP stream, with chunks unpacked up to a limit: a few kilobytes may unpack to gigabytes."""

import io
import zlib
from collections.abc import Iterator
from typing import IO

import lz4.frame  # type: ignore[import-untyped]
import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, McapRecord, Message
from mcap.stream_reader import StreamReader

MAX_RECORD_BYTES = 256_000_000
"""A longer record is damage: the longest message has 64 MB."""
MAX_CHUNK_BYTES = 80_000_000
"""Unpacked: recorders end a chunk after a few megabytes, and the longest message has 64."""


class ChunkError(McapError):
    """A chunk that is not what its head says, or too large; the text says what was expected."""


def records(stream: IO[bytes], *, skip_magic: bool = False, chunks: bool = True) -> Iterator[McapRecord]:
    """All records from here on; in the place of a chunk, the channels and messages in it.

    Args:
        stream: an MCAP file, or with `skip_magic` a part of one.
        skip_magic: it does not stand at its beginning.
        chunks: unpack chunks; otherwise they are left out.

    Raises:
        ChunkError: a chunk is damaged or would take more than MAX_CHUNK_BYTES.
        Exception: what the MCAP library raises on damage, see `reading.DAMAGE`.
    """
    reader = StreamReader(
        stream,
        skip_magic=skip_magic,
        emit_chunks=True,
        validate_crcs=not skip_magic,
        record_size_limit=MAX_RECORD_BYTES,
    )
    for record in reader.records:
        if not isinstance(record, Chunk):
            yield record
        elif chunks:
            yield from _contents(_unpacked(record))


def _unpacked(chunk: Chunk) -> bytes:
    """The bytes of a chunk. The sizes in the heads may lie: never more is unpacked than they allow."""
    size = chunk.uncompressed_size
    if size > MAX_CHUNK_BYTES:
        raise ChunkError(f"at most {MAX_CHUNK_BYTES} bytes expected in a chunk, got {size}")
    if chunk.compression == "zstd":
        data = zstandard.ZstdDecompressor().stream_reader(chunk.data).read(size + 1)
    elif chunk.compression == "lz4":
        try:
            data = lz4.frame.LZ4FrameDecompressor().decompress(chunk.data, max_length=size + 1)
        except RuntimeError as error:
            raise ChunkError(f"chunk cannot be unpacked: {error}") from error
    elif chunk.compression == "":
        data = chunk.data
    else:
        raise ChunkError(f"chunk packed by zstd, lz4 or not at all expected, got {chunk.compression[:40]!r}")
    if len(data) != size:
        got = f"more (at most {MAX_CHUNK_BYTES} are allowed)" if len(data) > size else len(data)
        raise ChunkError(f"{size} bytes expected in a chunk by its head, got {got}")
    if chunk.uncompressed_crc not in (0, zlib.crc32(data)):
        raise ChunkError("a chunk does not match its checksum")
    return data


def _contents(data: bytes) -> Iterator[Channel | Message]:
    """One after the other: a list of all could take ten times the bytes of the chunk."""
    stream = ReadDataStream(io.BytesIO(data))
    while stream.count < len(data):
        opcode, length = stream.read1(), stream.read8()
        if opcode == Opcode.CHANNEL:
            yield Channel.read(stream)
        elif opcode == Opcode.MESSAGE:
            yield Message.read(stream, length)
        else:
            stream.read(length)
