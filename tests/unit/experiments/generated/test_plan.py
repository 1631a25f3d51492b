"""Which generated worlds a suite plays in."""

import pytest

from experiments.generated.plan import plan_worlds
from experiments.hide_and_seek.plan import folder_of
from simulator.generation.kinds import KINDS
from simulator.generation.splits import split_of


def planned(split="validation", worlds=40, kinds=(), sizes=()):
    return plan_worlds(split, worlds, 10, 1500, list(kinds), list(sizes))


def test_forty_worlds_to_judge_are_of_every_kind_and_none_to_build_with():
    plans = planned()
    assert len({plan.name for plan in plans}) == 40
    assert {plan.kind for plan in plans} == set(KINDS)
    assert {split_of(plan.kind, plan.seed) for plan in plans} == {"validation"}


def test_more_worlds_begin_with_the_same_ones():
    assert planned(worlds=12)[:5] == planned(worlds=5)


def test_kinds_and_sizes_can_be_chosen():
    assert {(plan.kind, plan.size) for plan in planned("development", 3, ["flat"], ["small"])} == {
        ("flat", "small")
    }


@pytest.mark.parametrize(
    ("chosen", "words"),
    [({"split": "training"}, "training"), ({"kinds": ["castle"]}, "castle"), ({"sizes": ["vast"]}, "vast")],
)
def test_what_there_is_not_is_named(chosen, words):
    with pytest.raises(ValueError, match=words):
        planned(**chosen)


def test_what_one_pipeline_has_played_is_kept_apart_from_what_another_has():
    mine = plan_worlds("validation", 2, 10, 1500, [], [], "sift/equirectangular/topnav-attention", "own.json")
    assert {(plan.pipeline, plan.profile) for plan in mine} == {
        ("sift/equirectangular/topnav-attention", "own.json")
    }
    asked = [(None, None), ("orb", None), (None, "own.json"), (mine[0].pipeline, mine[0].profile)]
    folders = [folder_of("validation", *one) for one in asked]
    assert folders == [
        "validation",
        "validation-orb",
        "validation-own",
        "validation-sift-equirectangular-topnav-attention-own",
    ]
