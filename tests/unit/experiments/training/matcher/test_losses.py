"""A matcher is taught what the ranges say: who is whose partner, who is alone, and what nobody knows."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from experiments.training.correspondences import RIGHT_RAD, correspondences
from experiments.training.matcher.losses import Truth, loss_of, truth_of
from experiments.training.sights import projected
from services.features.networks.attention import CONTEXT, Assignment, Attention, Keypoints
from tests.unit.experiments.training.places import HALF_UNKNOWN, HIDDEN

RNG = np.random.default_rng(6)
APART = np.stack(np.meshgrid(np.arange(-3.0, 3.1, 0.5), np.arange(-0.8, 0.9, 0.4)), axis=-1).reshape(-1, 2)
"""65 directions, far from one another."""


def keypoints(lonlat_rad, present=None):
    count = len(lonlat_rad)
    there = torch.ones(1, count, dtype=torch.bool) if present is None else torch.tensor([present])
    look = torch.nn.functional.normalize(torch.randn(1, count, 8, generator=torch.Generator()), dim=-1)
    at = torch.from_numpy(np.asarray(lonlat_rad)).float()[None]
    return Keypoints(at, look, torch.zeros(1, count, CONTEXT), there)


def truth(places, numbers, first, second, present=None, present_there=None):
    one, other = keypoints(first, present), keypoints(second, present_there)
    return truth_of(places.panoramas, torch.tensor([numbers]), one, other)


def found_again(places, numbers, asked=APART):
    """Where those that are asked for are in the other panorama."""
    return projected(asked, *(places.sights[number] for number in numbers))[0]


def as_set(pairs):
    return {tuple(row) for row in np.asarray(pairs).tolist()}


@pytest.mark.parametrize("numbers", [(0, 1), (1, 0), (1, HALF_UNKNOWN)])
def test_partners_are_those_of_the_correspondences_from_both_sides(places, numbers):
    here, there = (places.sights[number] for number in numbers)
    moved = found_again(places, numbers) + 0.4 * RIGHT_RAD * RNG.standard_normal((len(APART), 2))
    second = RNG.permutation(moved)[: len(APART) - 10]
    forth = as_set(correspondences(APART, second, here, there).pairs)
    back = as_set(correspondences(second, APART, there, here).pairs[:, ::-1])
    found = truth(places, numbers, APART, second)
    assert as_set(found.partners[0].nonzero()) == forth & back
    assert len(forth & back) > 15
    assert not (found.partners.any(2) & found.alone[0]).any()
    assert not (found.partners.any(1) & found.alone[1]).any()


def test_of_keypoints_in_one_place_only_one_has_a_partner(places):
    second = np.repeat(found_again(places, (0, 1)), 3, axis=0)
    found = truth(places, (0, 1), np.repeat(APART, 2, axis=0), second).partners
    assert found.sum(1).max() == found.sum(2).max() == 1
    assert found.sum() > 40


def test_keypoints_of_another_place_are_all_alone_though_it_looks_the_same(places):
    present = [True] * 60 + [False] * 5
    found = truth(places, (0, 4), APART, APART, present)
    assert not found.partners.any()
    assert found.alone[0][0].tolist() == present
    assert found.alone[1].all()
    assert float(found.overlap) == 0.0
    same = truth(places, (0, 1), APART, APART)
    assert float(same.overlap) > 0.9
    assert float(same.log_distance.exp()) == pytest.approx(np.hypot(0.9, np.hypot(0.2, 0.05)), rel=1e-4)


def test_what_stands_before_everything_leaves_all_alone(places):
    found = truth(places, (0, HIDDEN), APART, found_again(places, (0, HIDDEN)))
    assert not found.partners.any()
    assert found.alone[0].all()
    assert found.alone[1].all()


def test_between_a_partner_and_none_nobody_knows(places):
    sure = truth(places, (0, 1), APART, found_again(places, (0, 1))).partners[0].diagonal()
    off = found_again(places, (0, 1))
    off[:, 1] += 1.5 * RIGHT_RAD
    between = truth(places, (0, 1), APART, off)
    assert not between.partners.any()
    assert not between.alone[0][0, sure].any()
    off[:, 1] += 1.5 * RIGHT_RAD
    assert truth(places, (0, 1), APART, off).alone[0][0, sure].all()


def test_of_a_point_without_a_surface_nobody_knows_whether_it_is_alone(places):
    unknown = ~np.isfinite(places.sights[HALF_UNKNOWN].ranges_at(APART))
    assert 20 < unknown.sum() < 45
    found = truth(places, (HALF_UNKNOWN, 0), APART, np.zeros((1, 2)))
    assert not found.partners[0, unknown].any()
    assert not found.alone[0][0, unknown].any()
    assert found.alone[0][0, ~unknown].sum() > 15


def test_those_that_only_fill_up_are_neither_partners_nor_alone(places):
    present = [number % 2 == 0 for number in range(len(APART))]
    found = truth(places, (0, 1), APART, found_again(places, (0, 1)), present, present)
    assert found.partners.sum() > 10
    rest = ~np.array(present)
    assert not found.partners[0, rest].any()
    assert not found.partners[0][:, rest].any()
    assert not found.alone[0][0, rest].any()
    assert not found.alone[1][0, rest].any()


PARTNERS = torch.tensor([[[True, False], [False, False]]])
ALONE = torch.tensor([[False, True]])
TRUTH = Truth(PARTNERS, (ALONE, ALONE), torch.tensor([0.5]), torch.tensor([0.7]))
PERFECT = Assignment(
    torch.tensor([[[-0.01, -9.0], [-9.0, -9.0]]]),
    (torch.tensor([[8.0, -8.0]]),) * 2,
    torch.tensor([[8.0, 0.0, 0.7]]),
)
WRONG = {
    "partners": {"log_right": torch.tensor([[[-9.0, -0.01], [-9.0, -9.0]]])},
    "alone here": {"matchable": (torch.tensor([[8.0, 8.0]]), PERFECT.matchable[1])},
    "alone there": {"matchable": (PERFECT.matchable[0], torch.tensor([[8.0, 8.0]]))},
    "place": {"pair": torch.tensor([[-8.0, 0.0, 0.7]])},
    "overlap": {"pair": torch.tensor([[8.0, 3.0, 0.7]])},
    "distance": {"pair": torch.tensor([[8.0, 0.0, 2.7]])},
}


@pytest.mark.parametrize("what", WRONG)
def test_whoever_is_right_loses_less_than_who_errs_at_anything(what):
    perfect = float(loss_of([PERFECT], TRUTH, 0.3))
    assert perfect < 0.02
    assert float(loss_of([replace(PERFECT, **WRONG[what])], TRUTH, 0.3)) > perfect + 0.1
    assert float(loss_of([PERFECT, PERFECT], TRUTH, 0.3)) == pytest.approx(perfect)


def test_metres_between_different_places_are_nobodys_business():
    elsewhere = replace(TRUTH, overlap=torch.tensor([0.0]))
    said = [replace(PERFECT, pair=torch.tensor([[-8.0, -8.0, metres]])) for metres in (0.0, 5.0)]
    assert loss_of(said[:1], elsewhere, 0.3) == loss_of(said[1:], elsewhere, 0.3)


@pytest.mark.parametrize("there", [0, 2])
def test_pictures_without_keypoints_leave_loss_and_gradients_finite(places, there):
    network = Attention(8, 16, 2, 2)
    one, other = keypoints(APART[:3], [False] * 3), keypoints(APART[:3], [k < there for k in range(3)])
    found = truth_of(places.panoramas, torch.tensor([[0, 1]]), one, other)
    assert not found.partners.any()
    loss = loss_of(network(one, other), found, 0.3)
    loss.backward()
    assert torch.isfinite(loss)
    assert all(torch.isfinite(value.grad).all() for value in network.parameters() if value.grad is not None)
