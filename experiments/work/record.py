"""What a study leaves for the list of runs in the console."""

import functools
import os
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from services.launcher.terminal import options


def on_record(command: str) -> Callable[[Callable[..., int]], Callable[..., None]]:
    """A command with a record at its end; the function returns the number of its results."""

    def decorate(study: Callable[..., int]) -> Callable[..., None]:
        @functools.wraps(study)
        def run(**chosen: Any) -> None:
            from services.launcher.client.run_record import keep_run

            started = datetime.now(UTC)
            results = study(**chosen)
            world = chosen.get("world")
            keep_run(
                chosen.get("data_dir") or Path(os.environ.get("TOPNAV_DATA_DIR") or options.DATA_DIR),
                command,
                started,
                {"study": command.split()[-1], "results": results},
                worlds=[world] if world else [],
                map_name=chosen.get("map_name"),
                seed=chosen.get("seed"),
                json_file=chosen.get("json_file"),
            )

        return run

    return decorate
