"""A detector's training goes on after an interruption to the same bits, and its weights say how they came."""

import json

import pytest
from safetensors import safe_open

from experiments.training.detector.recipe import KeypointsRecipe
from experiments.training.detector.training import train
from experiments.training.learning.running import Schedule
from experiments.training.sealed import sealed_files
from services.features.networks.spherical_keypoints import network_of
from services.launcher.client.failure import ExperimentError

RECIPE = KeypointsRecipe(batch=1, points=32, keypoints=32, schedule=Schedule(steps=3, kept_every=3))


def trained(places, into, recipe=RECIPE, until=None, export=None):
    return train(places.files[0].parent, into, recipe, "cpu", until, export, 1)


def test_interrupted_training_goes_on_to_the_same_bits_and_gives_away_what_it_learned(places, tmp_path):
    weights = tmp_path / "weights.safetensors"
    whole = trained(places, tmp_path / "whole", export=weights)
    assert trained(places, tmp_path / "pieces", until=1)["steps"] == 1
    assert trained(places, tmp_path / "pieces")["steps"] == 3
    assert (whole["panoramas"], whole["pairs"], whole["steps"]) == (6, 8, 3)
    assert whole["bytes"] == weights.stat().st_size
    ends = [sealed_files(tmp_path / name, "step-00000003", ".safetensors") for name in ("whole", "pieces")]
    assert [file.name for file in ends[0]] == [file.name for file in ends[1]] != []  # with their checksums
    with safe_open(weights, "pt") as file:
        assert json.loads(file.metadata()["recipe"]) == json.loads(RECIPE.model_dump_json())
        assert file.metadata()["steps"] == "3"
        assert set(file.keys()) == set(network_of("slim").state_dict())


def test_panoramas_of_which_no_two_fit_are_refused_before_the_first_step(places, tmp_path):
    with pytest.raises(ExperimentError, match="draw more pairs"):
        trained(places, tmp_path / "into", RECIPE.model_copy(update={"apart_m": 0.1}))
    assert not (tmp_path / "into" / "log.jsonl").exists()
