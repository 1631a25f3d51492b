"""The whole way of `topnav train` in small: pairs, a few steps in two goes, figures beside SIFT's."""

import json

import pytest
from typer.testing import CliRunner

from experiments.commands.train import app
from services.launcher.client.failure import ExperimentError


def call(*words):
    result = CliRunner().invoke(app, [str(word) for word in words])
    if result.exception is not None:
        raise result.exception
    return result.output


def test_worlds_that_judge_are_refused_before_anything_is_drawn(tmp_path):
    with pytest.raises(ExperimentError, match="of the validation split"):
        call("data", "--into", tmp_path / "pairs", "--only", "flat-0-small")
    assert not (tmp_path / "pairs").exists()


@pytest.mark.render
@pytest.mark.slow
def test_pairs_are_drawn_learned_from_and_judged(tmp_path):
    small, short = tmp_path / "small.json", tmp_path / "short.json"
    small.write_text(json.dumps({"width_px": 512, "apart_m": [0.3, 0.6], "negatives": 0.0, "disturbed": 0.0}))
    short.write_text(json.dumps({"hidden": 8, "batch": 2, "schedule": {"steps": 6, "kept_every": 2}}))
    pairs, into, figures = tmp_path / "pairs", tmp_path / "residual", tmp_path / "figures.json"
    drawn = ("data", "--into", pairs, "--worlds", 1, "--shards", 1, "--pairs", 4, "--recipe", small)
    call(*drawn)
    assert "made now" in call(*drawn, "--draw", tmp_path / "pairs.png")
    assert (tmp_path / "pairs.png").stat().st_size > 10_000
    training = ("residual", "--pairs", pairs, "--into", into, "--recipe", short)
    call(*training, "--until", 3)
    call(*training)
    steps = [json.loads(line)["step"] for line in (into / "log.jsonl").read_text().splitlines()]
    assert steps == [2, 3, 4, 6]
    judged = ("--into", tmp_path / "judged", "--worlds", 1, "--pairs", 2, "--json", figures)
    call("evaluate", "--trained", into, "--against", "sift", *judged)
    written = json.loads(figures.read_text())
    assert [row["name"] for row in written["models"]] == ["sift", "residual"]
    assert all(row["pairs"] + row["other_places"] == 2 for row in written["models"])
    with pytest.raises(ExperimentError, match="pairs of a shard 4, now 5"):
        call(*drawn, "--pairs", 5)
