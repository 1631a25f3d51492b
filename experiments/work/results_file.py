"""The JSON file of a long study, which goes on where it was cut off."""

import json
from pathlib import Path
from typing import Any

from services.launcher.client.failure import ExperimentError
from services.launcher.terminal.output import write_json

Row = dict[str, Any]


class ResultsFile:
    """Tables that grow by a few rows at a time; without a path they are kept in memory only.

    Attributes:
        tables: rows by the name of their table, the main one first.
    """

    def __init__(self, path: Path | None, setup: Row, *more: str, main: str = "results") -> None:
        """Read what an earlier run left.

        Args:
            path: of the file; it need not exist.
            setup: options that all rows share; they stand beside the tables.
            more: names of tables besides the main one.
            main: name of that.

        Raises:
            ExperimentError: the file is of another setup, or no file of this study.
        """
        self._path, self._setup, self._main = path, setup, main
        names = (main, *more)
        there = path is not None and path.exists()
        self.tables: dict[str, list[Row]] = (
            _read(path, setup, names) if there and path is not None else {name: [] for name in names}
        )

    @property
    def results(self) -> list[Row]:
        """Rows of the main table."""
        return self.tables[self._main]

    def add(self, *rows: Row, table: str | None = None) -> None:
        """Keep rows, of the main table unless another is named."""
        self.tables[table or self._main] += rows
        self.write()

    def write(self, **summary: Any) -> None:
        """Write everything, with what was concluded from it."""
        if self._path is not None:
            write_json(self._path, {**self._setup, **self.tables, **summary})


def _read(path: Path, setup: Row, names: tuple[str, ...]) -> dict[str, list[Row]]:
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        tables: dict[str, list[Row]] = {name: found[name] for name in names}
        earlier = {name: found.get(name) for name in setup}
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise ExperimentError(f"{path} is no file of this study: move it away or choose another") from error
    if earlier != setup:
        raise ExperimentError(
            f"{path} was written with {earlier}, now asked for {setup}: same options, or another file"
        )
    return tables
