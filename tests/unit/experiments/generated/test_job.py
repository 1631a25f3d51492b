"""A world that fails is told, and the suite goes on; each is played with what the suite was asked for."""

import json
from dataclasses import replace

import pytest

from experiments.generated import job
from experiments.generated.plan import WorldPlan
from services.launcher.client.failure import ExperimentError
from services.launcher.processes.wait import LaunchError
from simulator.generation.mending import GenerationError

PLAN = WorldPlan("flat", 9, "small", 10, 1500)


@pytest.mark.parametrize(
    "failure",
    [
        ExperimentError("the stack ended"),
        LaunchError("features: no sign of life in 120 s"),
        GenerationError("flat 9: no way to the bathroom"),
    ],
)
def test_a_world_that_fails_is_told_in_its_row(failure, tmp_path, monkeypatch):
    def fails(*_arguments):
        raise failure

    monkeypatch.setattr(job, "generate", fails)
    row = job.play_or_tell(PLAN, str(tmp_path))
    assert row == {"kind": "flat", "seed": 9, "size": "small", "error": str(failure)}


def test_a_world_played_before_is_read_and_not_played_again(tmp_path, monkeypatch):
    monkeypatch.setattr(job, "generate", None)
    own = tmp_path / PLAN.name
    own.mkdir()
    (own / job.ROW).write_text('{"kind": "flat", "coverage": 1.0}', encoding="utf-8")
    assert job.play_or_tell(PLAN, str(tmp_path)) == {"kind": "flat", "coverage": 1.0}


def test_map_and_rounds_are_of_the_pipeline_and_by_the_rules_that_were_asked_for(tmp_path, monkeypatch):
    asked = []

    def explored(plan, _folder):
        asked.append((plan.pipeline, plan.profile))
        return {job.FIGURES: json.dumps({"nodes": 1}).encode()}

    def played(plan, *_where):
        asked.append((plan.pipeline, plan.profile, plan.map_profile))
        raise ExperimentError("enough")

    monkeypatch.setattr(job, "map_or_part", explored)
    monkeypatch.setattr(job, "play_run", played)
    job.play_or_tell(PLAN, str(tmp_path / "plain"))
    job.play_or_tell(replace(PLAN, pipeline="orb", profile="own.json"), str(tmp_path / "own"))
    assert asked == [
        (None, None),
        (None, "default", None),
        ("orb", "own.json"),
        ("orb", "own.json", "own.json"),
    ]
