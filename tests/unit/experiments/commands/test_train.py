"""The whole way of `topnav train` in small: pairs, a few steps in two goes, figures beside SIFT's."""

import json

import pytest
from safetensors import safe_open
from typer.testing import CliRunner

from experiments.commands.train import app
from experiments.training.worlds import first_worlds
from services.launcher.client.failure import ExperimentError
from tests.unit.experiments.training.patch.painted import painted_pair, write_painted


def call(*words):
    result = CliRunner().invoke(app, [str(word) for word in words])
    if result.exception is not None:
        raise result.exception
    return result.output


def test_worlds_that_judge_are_refused_before_anything_is_drawn(tmp_path):
    with pytest.raises(ExperimentError, match="of the validation split"):
        call("data", "--into", tmp_path / "pairs", "--only", "flat-0-small")
    assert not (tmp_path / "pairs").exists()


def test_patches_are_learned_in_two_goes_and_the_weights_given_away(tmp_path):
    (world,) = first_worlds("development", 1)
    write_painted(tmp_path / "pairs", world, [painted_pair()])
    short, into, weights = tmp_path / "short.json", tmp_path / "slim", tmp_path / "slim.safetensors"
    sampling, schedule = {"keypoints": 100, "per_pair": 60}, {"steps": 4, "kept_every": 2}
    short.write_text(json.dumps({"batch": 16, "sampling": sampling, "schedule": schedule}))
    training = ("patch", "--shape", "slim", "--pairs", tmp_path / "pairs", "--into", into, "--recipe", short)
    call(*training, "--until", 3)
    assert not weights.exists()
    assert "exported bytes" in call(*training, "--export", weights)
    steps = [json.loads(line)["step"] for line in (into / "log.jsonl").read_text().splitlines()]
    assert steps == [2, 3, 4]
    with safe_open(weights, "pt") as file:
        about = file.metadata()
    assert {name: about[name] for name in ("name", "licence", "steps", "data_seed")} == {
        "name": "topnav-slim", "licence": "Apache-2.0", "steps": "4", "data_seed": "7",
    }  # fmt: skip
    assert json.loads(about["recipe"])["batch"] == 16
    with pytest.raises(ExperimentError, match="another recipe"):
        call(*training, "--shape", "sosnet")


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
    call("evaluate", "--trained", into, "--models", "sift", *judged)
    written = json.loads(figures.read_text())
    assert [row["name"] for row in written["models"]] == ["sift", "residual"]
    found = [row["renderings"] for row in written["models"]]
    assert all(row["pairs"] + row["other_places"] == 2 for row in found)
    with pytest.raises(ExperimentError, match="pairs of a shard 4, now 5"):
        call(*drawn, "--pairs", 5)
