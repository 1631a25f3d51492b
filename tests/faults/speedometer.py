"""`python -m tests.faults.speedometer FILE`: the simulator, which notes its true speed beside it.

When the network is cut nobody hears how the robot goes on: it has to be written down where it is.
"""

import runpy
import sys
from pathlib import Path
from typing import Any

from shared.bus import Publisher
from shared.messages.simulation import Truth


def speeds_in(file: Path) -> list[tuple[float, float]]:
    """Wall time in seconds and true speed in m/s, as they were noted."""
    lines = file.read_text(encoding="utf-8").split("\n")[:-1]  # the last may be half written
    return [(float(time), float(speed)) for time, speed in map(str.split, lines)]


def main() -> None:
    """Run the simulator; every true state it publishes becomes a line of the file."""
    put = Publisher.put

    def noting(publisher: Publisher[Any], message: Any) -> None:
        if isinstance(message, Truth):
            notes.write(f"{message.stamp_ns / 1e9:.3f} {message.speed_mps:.4f}\n")
        put(publisher, message)

    with Path(sys.argv.pop(1)).open("a", buffering=1, encoding="utf-8") as notes:
        Publisher.put = noting  # type: ignore[method-assign]
        runpy.run_module("simulator", run_name="__main__", alter_sys=True)


if __name__ == "__main__":
    main()
