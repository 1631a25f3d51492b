"""Save what is in a recording that was cut off."""

from dataclasses import dataclass
from pathlib import Path

from services.recorder.channels import RecordingError
from services.recorder.recording import RecordingWriter
from services.recorder.whole_part import WholePart


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
