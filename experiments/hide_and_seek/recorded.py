"""Recordings of rounds that fail, to look at afterwards: `topnav replay`."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from services.launcher.client.stack import Stack
from services.launcher.evaluation.outcome import Round
from services.recorder.recorder import record
from services.recorder.recording import RecordingWriter
from shared.lifecycle import in_thread


def played_on_record(stack: Stack, file: Path | None, play: Callable[[], Round]) -> Round:
    """Play a round; what the bus said is kept if it fails.

    Args:
        stack: that plays.
        file: MCAP file; one that is there is replaced. None records nothing.
        play: plays the round.
    """
    if file is None:
        return play()
    file.unlink(missing_ok=True)
    with _recording(stack, file):
        played = play()
    if played.success:
        file.unlink()
    return played


@contextmanager
def _recording(stack: Stack, file: Path) -> Iterator[None]:
    with (
        RecordingWriter(file) as writer,
        stack.address.open() as bus,
        in_thread(lambda stop: record(bus, writer, (), stop, None), "recorder"),
    ):
        yield
