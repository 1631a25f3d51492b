"""What studies leave for the console's list of runs."""

from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from experiments.work.record import on_record
from tests.unit.services.launcher.client.test_run_record import records


def test_a_study_keeps_its_options_and_leaves_a_record(tmp_path: Path) -> None:
    def main(world: str = "village", seed: int = 1, data_dir: Path = tmp_path) -> int:
        """Count."""
        assert (world, data_dir) == ("village", tmp_path)
        return seed + 1

    app = typer.Typer()
    app.command()(on_record("study counting")(main))
    shown = CliRunner().invoke(app, ["--seed", "6", "--data-dir", str(tmp_path)])
    assert shown.exit_code == 0, shown.output
    (record,) = records(tmp_path)
    assert (record.command, record.world, record.seed) == ("study counting", "village", 6)
    assert record.figures == {"study": "counting", "results": 7}
    assert "Count." in CliRunner().invoke(app, ["--help"]).output


def test_a_study_without_a_data_folder_uses_the_usual_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TOPNAV_DATA_DIR", str(tmp_path))
    on_record("study counting")(lambda: 3)()
    assert records(tmp_path)[0].figures["results"] == 3


def test_a_study_that_fails_leaves_none(tmp_path: Path) -> None:
    def main(data_dir: Path) -> int:
        raise ValueError(data_dir)

    with pytest.raises(ValueError, match="pytest"):
        on_record("study failing")(main)(data_dir=tmp_path)
    assert not (tmp_path / "runs").exists()
