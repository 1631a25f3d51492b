"""What a suite plays."""

import pytest

from experiments.hide_and_seek.plan import plan_suite
from services.launcher.client.run_record import world_label


def test_the_thesis_suite_has_fourteen_rounds_in_four_worlds():
    plans = plan_suite("thesis", 1, rounds=25, max_steps=100)
    assert {plan.world: plan.rounds for plan in plans} == {
        "village": 5,
        "apartment": 3,
        "break_room": 3,
        "factory": 3,
    }


def test_a_compared_profile_plays_the_same_rounds():
    plans = plan_suite("thesis", 2, rounds=25, profiles=["default", "thesis"], max_steps=100)
    by_profile = {
        name: [(p.world, p.rounds, p.seed) for p in plans if p.profile == name]
        for name in ("default", "thesis")
    }
    assert by_profile["default"] == by_profile["thesis"]
    assert len({plan.name for plan in plans}) == 8


def test_a_random_suite_takes_any_world():
    (plan,) = plan_suite("random", 3, rounds=25, worlds=["some/where/attic.yaml"], max_steps=100)
    assert (plan.rounds, plan.name) == (25, "attic-default-3")
    assert world_label("a/b/attic.yml") == "attic"


def test_runs_and_maps_of_a_pipeline_or_of_other_rules_have_folders_of_their_own():
    (plain,) = plan_suite("thesis", 1, rounds=25, worlds=["factory"], max_steps=100)
    (other,) = plan_suite("thesis", 1, rounds=25, worlds=["factory"], max_steps=100, pipeline="orb/tangent")
    (ruled,) = plan_suite(
        "thesis",
        1,
        rounds=25,
        worlds=["factory"],
        max_steps=100,
        profiles=["a/b.json"],
        map_profile="a/c.json",
    )
    assert (other.pipeline, other.name) == ("orb/tangent", "factory-orb-tangent-default-1")
    assert (ruled.map.label, ruled.name) == ("factory-c", "factory-c-b-1")
    assert (plain.pipeline, plain.name) == (None, "factory-default-1")


@pytest.mark.parametrize(
    ("suite", "worlds", "words"),
    [("all", [], "must be one of"), ("thesis", ["attic.yaml"], "--suite random")],
)
def test_what_cannot_be_played_is_refused(suite, worlds, words):
    with pytest.raises(ValueError, match=words):
        plan_suite(suite, 1, rounds=5, worlds=worlds, max_steps=100)
