"""Maps and rounds of a suite are of the pipeline and the rules that were asked for."""

import json

import pytest

from experiments.hide_and_seek import jobs
from experiments.hide_and_seek.jobs import ARCHIVE, FIGURES, TRUTH, make_map, play_run
from experiments.hide_and_seek.plan import MapPlan, RunPlan
from services.launcher.evaluation.truth_file import MapTruth, save_truth


class AskedError(Exception):
    """Instead of a stack: what was asked for."""


@pytest.fixture(autouse=True)
def _no_stack(monkeypatch):
    def asked(choice):
        raise AskedError(choice.world, choice.profile, choice.pipeline)

    monkeypatch.setattr(jobs, "open_stack", asked)


@pytest.mark.parametrize(("pipeline", "rules"), [(None, None), ("orb/tangent", "orb.json")])
def test_a_map_is_made_with_the_pipeline_and_rounds_are_played_with_it(tmp_path, pipeline, rules):
    plan = RunPlan("apartment", "thesis", 3, 1, 100, pipeline=pipeline, map_profile=rules)
    with pytest.raises(AskedError) as stack:
        make_map(plan.map, str(tmp_path))
    assert stack.value.args == ("apartment", rules, pipeline)
    save_truth(tmp_path / TRUTH, "suite", MapTruth("apartment", {}, {}))
    files = {ARCHIVE: b"", TRUTH: (tmp_path / TRUTH).read_bytes(), FIGURES: b"{}"}
    with pytest.raises(AskedError) as stack:
        play_run(plan, files, str(tmp_path))
    assert stack.value.args == ("apartment", "thesis", pipeline)


def test_a_map_of_another_pipeline_or_of_other_rules_is_not_taken(tmp_path):
    kept = tmp_path / "apartment"
    kept.mkdir()
    for name in (ARCHIVE, TRUTH):
        (kept / name).write_bytes(b"kept")
    (kept / FIGURES).write_text(json.dumps({"outcome": "succeeded"}))
    assert make_map(MapPlan("apartment"), str(tmp_path))[ARCHIVE] == b"kept"
    for other in (MapPlan("apartment", "orb"), MapPlan("apartment", profile="rules/orb.json")):
        with pytest.raises(AskedError):
            make_map(other, str(tmp_path))
