"""Save what is in a recording that was cut off."""

import struct
from dataclasses import dataclass
from pathlib import Path

from mcap.exceptions import McapError
from mcap.records import Channel, Message
from mcap.stream_reader import StreamReader
from zstandard import ZstdError

from services.recorder.backlog import Sample
from services.recorder.channels import RecordingError
from services.recorder.recording import RecordingWriter


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
    problem = ""
    with RecordingWriter(target) as writer, source.open("rb") as stream:
        channels: dict[int, str] = {}
        try:
            for record in StreamReader(stream, validate_crcs=True).records:
                if isinstance(record, Channel):
                    channels[record.id] = record.topic
                elif isinstance(record, Message) and record.channel_id in channels:
                    writer.write(Sample(channels[record.channel_id], record.data, record.log_time))
        except (McapError, EOFError, struct.error, ZstdError, ValueError) as error:
            problem = f"{type(error).__name__}: {error}"
        messages = sum(writer.counts.values())
    if not messages:
        target.unlink()
        raise RecordingError(f"{source} holds no message of a recording ({problem or 'it is empty'})")
    return Recovered(messages, not problem, problem)
