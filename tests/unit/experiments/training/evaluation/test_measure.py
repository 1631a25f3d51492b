"""Figures of judged pairs: other places count as false answers and as nothing else."""

import pytest

from experiments.training.evaluation.measure import summary
from experiments.training.evaluation.models import available, trained_residual
from experiments.training.keypoints.tables import answer_table, recurrence_table
from services.features.networks.catalogue import MODELS
from services.launcher.client.failure import ExperimentError

ANSWER = {"matches": 40, "right": 30, "verified": 20, "verified_right": 18, "possible": 60, "answered": True}


def row(distance_m: float, same: bool = True, off_deg: float | None = 1.0) -> dict:
    return {**ANSWER, "heading_off_deg": off_deg, "distance_m": distance_m, "same": same}


def test_only_pairs_2_to_3_m_apart_count_as_wide_and_other_places_are_apart():
    figures = summary(
        [row(1.0), row(2.5) | {"verified_right": 6}, row(9.0, same=False, off_deg=170.0) | {"right": 0}]
    )
    assert figures["pairs"] == 2
    assert figures["precision"] == 0.75
    assert figures["recall"] == 0.5
    assert figures["verified_2_3_m"] == 6
    assert figures["heading_median_deg"] == 1.0
    assert (figures["other_places"], figures["other_places_answered"]) == (1, 1)


def test_no_pairs_are_no_figures_and_no_error():
    assert summary([])["verified_2_3_m"] is None


def test_a_detector_without_weights_is_listed_and_measures_nothing():
    measured = {"detector": "sift", "distance_m": 1.0, "keypoints": 300, "visible": 200, "recurring": 50}
    measured |= {"by_chance": 4, "matcher": row(1.0), "oracle": row(1.0)}
    first, second = recurrence_table([measured], ["sift", "aliked-t16"])
    assert first["recurring_share"] == 0.25
    assert second == {"detector": "aliked-t16", "status": "no weights"}
    assert [one["matcher"] for one in answer_table([measured])] == ["mutual ratio", "oracle"]


def test_a_pipeline_without_weights_is_named_and_an_unknown_one_refused(monkeypatch, tmp_path):
    monkeypatch.setenv("TORCH_HOME", str(tmp_path))
    models, absent = available(["sift", "aliked-n16"])
    assert [model.name for model in models] == ["sift"]
    assert list(absent) == ["aliked-n16"]
    assert models[0].size_bytes == 0
    with pytest.raises(ValueError, match="got 'soft'"):
        available(["soft"])


def test_of_a_matcher_the_weights_for_its_keypoints_count_and_no_others():
    models, absent = available(
        [f"{whose}/equirectangular/topnav-attention" for whose in ("sift", "topnav-keypoints")]
    )
    assert not absent
    bytes_of = {model.name: model.size_bytes for model in MODELS}
    assert [model.size_bytes for model in models] == [
        bytes_of["topnav-attention-sift"],
        bytes_of["topnav-attention-keypoints"] + bytes_of["topnav-keypoints"],
    ]


def test_a_folder_without_a_checkpoint_says_what_to_do(tmp_path):
    with pytest.raises(ExperimentError, match="topnav train residual"):
        trained_residual(tmp_path)
