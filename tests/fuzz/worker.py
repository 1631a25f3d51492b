"""One process that fuzzes: `python -m tests.fuzz.worker NAME... --executions N`. A line of JSON per decoder.

The input that is being executed lies in a mapped file, so that it is not lost when it ends the process.
"""

import argparse
import json
import logging
import mmap
import signal
import sys
import tempfile
import warnings
from pathlib import Path
from typing import Any

from tests.fuzz.campaign import Campaign
from tests.fuzz.catalogue import chosen

CURRENT = "current"
ROOM_BYTES = 4_000_000
HANG_S = 60
"""An execution that takes longer ends the process by SIGALRM."""


class Current:
    """The file with the input that is being executed."""

    def __init__(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        with (folder / CURRENT).open("w+b") as file:
            file.truncate(ROOM_BYTES)
            self._map = mmap.mmap(file.fileno(), ROOM_BYTES)

    def note(self, data: bytes) -> None:
        """Put an input there and wind the clock up."""
        kept = data[: ROOM_BYTES - 8]
        self._map[:8] = len(kept).to_bytes(8, "little")
        self._map[8 : 8 + len(kept)] = kept
        signal.alarm(HANG_S)

    def done(self) -> None:
        """Stop the clock."""
        signal.alarm(0)


def read_current(folder: Path) -> bytes:
    """The input that a process that is gone executed last."""
    data = (folder / CURRENT).read_bytes()
    return data[8 : 8 + int.from_bytes(data[:8], "little")]


def arguments(parser: argparse.ArgumentParser) -> None:
    """What worker and command have in common."""
    parser.add_argument("--executions", type=int, default=None, help="of each decoder")
    parser.add_argument("--seconds", type=float, default=None, help="for each decoder")
    parser.add_argument("--seed", type=int, default=1, help="the same seed gives the same inputs")
    parser.add_argument("--keep", type=Path, default=Path("runs/fuzz"), help="folder for what crashes")


def main(given: list[str]) -> None:
    """Fuzz the named decoders one after the other."""
    parser = argparse.ArgumentParser(prog="tests.fuzz.worker", description=__doc__)
    parser.add_argument("names", nargs="*")
    arguments(parser)
    options: Any = parser.parse_args(given)
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    logging.disable()
    warnings.simplefilter("ignore")
    current = Current(options.keep)
    with tempfile.TemporaryDirectory(prefix="topnav-fuzz-") as scratch:
        for decoder in chosen(options.names, Path(scratch)):
            sys.stdout.write(f"{decoder.name}\n")
            sys.stdout.flush()
            campaign = Campaign(decoder, options.seed, options.keep, current)
            tally = campaign.run(options.executions, options.seconds)
            sys.stdout.write(json.dumps(tally.as_json()) + "\n")
            sys.stdout.flush()


if __name__ == "__main__":
    main(sys.argv[1:])
