"""A detector learns from points whose places in both pictures are known, however the pictures are turned."""

import math

import numpy as np
import pytest
import torch

from experiments.training.detector.losses import (
    CELL_PX,
    Drawn,
    _Looking,
    _score_losses,
    draw_keypoints,
    pair_losses,
)
from experiments.training.detector.recipe import KeypointsRecipe, beginning
from experiments.training.panoramas.strips import grid_of
from experiments.training.sights import projected
from services.features.networks.spherical_keypoints import KeypointNet
from services.features.representations.equirectangular import PAD_COLUMNS
from services.features.representations.strip import cropped_strip
from shared.geometry.sphere import bearings_from_lonlat

SHIFTS = torch.tensor([37, 700])
PAIR = torch.tensor([[0, 1]])
HEIGHT, WIDTH = 288, 800


def drawn_by(number=1):
    return torch.Generator().manual_seed(number)


class Planted(KeypointNet):
    """Says the scores and maps that it was given."""

    dimension, strides = 64, (4,)

    def __init__(self, map_):
        super().__init__()
        scores = torch.rand(len(map_), HEIGHT, WIDTH + 2 * PAD_COLUMNS, generator=drawn_by())
        self.scores, self.map = torch.nn.Parameter(scores), torch.nn.Parameter(map_)

    def forward(self, _):
        return self.scores, (self.map,)


def losses(places, network, shifts=SHIFTS, points=64, keypoints=64):
    turned = [
        torch.roll(places.panoramas.strips[number], int(shift), -1)
        for number, shift in zip(PAIR[0], shifts, strict=True)
    ]
    grays = torch.stack(turned)[:, None].float() / 255.0
    temperature = torch.tensor(40.0)
    return pair_losses(
        network, grays, shifts, PAIR, places.panoramas, temperature, points, keypoints, drawn_by()
    )


def test_of_each_cell_the_peak_is_drawn_and_half_are_the_best():
    scores = torch.zeros(2, 4 * CELL_PX, 6 * CELL_PX)
    rng = np.random.default_rng(2)
    inside = rng.integers(CELL_PX, size=(2, 24, 2))
    corners = np.stack(np.divmod(np.arange(24), 6), axis=-1) * CELL_PX
    rows, columns = np.moveaxis(corners + inside, -1, 0)
    values = torch.from_numpy(30.0 + rng.permuted(np.tile(np.arange(24), (2, 1)), axis=1)).float()
    scores[torch.arange(2)[:, None], rows, columns] = values
    drawn = draw_keypoints(scores, 8, drawn_by())
    assert drawn.pixels.shape == (2, 8, 2)
    for picture, pixels in enumerate(drawn.pixels):
        x, y = (pixels - 0.5).long().T.numpy()
        cells = y // CELL_PX * 6 + x // CELL_PX
        assert len(set(cells.tolist())) == 8
        assert np.array_equal(y, rows[picture, cells])
        assert np.array_equal(x, columns[picture, cells])
        assert torch.equal(drawn.scores[picture], values[picture, cells])
        assert set(values[picture].topk(4).indices.tolist()) <= set(cells.tolist())
        assert set(values[picture].topk(8).indices.tolist()) != set(cells.tolist())
    assert float(drawn.log_chosen.abs().max()) < 1e-6


def test_where_all_pixels_score_alike_each_is_as_likely():
    drawn = draw_keypoints(torch.zeros(1, 20 * CELL_PX, 20 * CELL_PX), 400, drawn_by())
    np.testing.assert_allclose(drawn.log_chosen.numpy(), -math.log(64), rtol=1e-5)
    inside = (drawn.pixels[0] - 0.5) % CELL_PX
    np.testing.assert_allclose(inside.mean(0).numpy(), 3.5, atol=0.4)


def test_a_strips_pixels_are_those_of_the_pipelines():
    _, grid = cropped_strip(np.zeros((256, 512), np.uint8), 25.0, (400, 800))
    assert grid_of(256) == grid


def test_a_keypoint_of_a_turned_strip_is_expected_where_the_sights_say(places):
    pixels = torch.rand(1, 300, 2, generator=drawn_by()) * torch.tensor([WIDTH, HEIGHT])
    looking = _Looking(Planted(torch.zeros(2, 64, 72, 232)), (), SHIFTS, places.panoramas, PAIR)
    for back, (here, there) in ((False, (0, 1)), (True, (1, 0))):
        unturned = pixels[0].double().numpy() - [float(SHIFTS[int(back)]), 0.0]
        expected, shown = projected(
            grid_of(256).lonlat_from_pixels(unturned), places.sights[here], places.sights[there]
        )
        bearings, visible, _ = looking.expected(pixels, back=back)
        cosines = (bearings[0].numpy() * bearings_from_lonlat(expected)).sum(axis=-1)
        assert (cosines > math.cos(1e-3)).mean() > 0.98
        assert (visible[0].numpy() == shown).mean() > 0.98
    directions, *_ = looking.expected(pixels)
    there = looking.pixels_there(directions)
    assert float(there[..., 0].min()) >= 0.0
    assert float(there[..., 0].max()) < WIDTH
    again = looking.bearings(torch.cat([pixels, there]), slice(1, None))
    np.testing.assert_allclose(again.numpy(), directions.numpy(), atol=1e-4)


def world_map(places, shifts):
    """Descriptors (2, 64, 72, 232) that tell the point of the room that the strip shows at a place."""
    rng = np.random.default_rng(4)
    waves, phases = rng.normal(0.0, 4.0, (3, 64)), rng.uniform(0.0, 2.0 * np.pi, 64)
    x, y = np.meshgrid(4.0 * (np.arange(232) + 0.5) - PAD_COLUMNS, 4.0 * (np.arange(72) + 0.5))
    maps = []
    for number, shift in zip(PAIR[0].tolist(), shifts.tolist(), strict=True):
        sight = places.sights[number]
        lonlat = grid_of(256).lonlat_from_pixels(np.stack([x - shift, y], axis=-1).reshape(-1, 2))
        rays = bearings_from_lonlat(lonlat) @ sight.pose.rotation.T
        points = sight.pose.position_m + rays * sight.ranges_at(lonlat)[:, None]
        maps.append(np.cos(points @ waves + phases).T.reshape(64, 72, 232))
    return torch.from_numpy(np.stack(maps)).float()


def test_who_knows_the_place_of_every_pixel_has_next_to_no_loss(places):
    knowing = Planted(world_map(places, SHIFTS))
    known = losses(places, knowing)
    mistaken = losses(places, Planted(world_map(places, SHIFTS + torch.tensor([0, 60]))))
    ignorant = losses(places, Planted(torch.zeros(2, 64, 72, 232)))
    assert float(known["points"].detach()) < 0.5
    assert float(mistaken["points"].detach()) > 4.0
    assert float(known["keypoints"].detach()) < 1.0
    # Nobody who knows nothing does better than 1 of 64, from both sides; there are fewer that both see.
    assert 6.0 < float(ignorant["points"].detach()) < 2.0 * math.log(64)


def test_geometry_is_exact_whatever_precision_the_network_runs_in(places):
    network = Planted(world_map(places, SHIFTS))
    exact = losses(places, network, keypoints=1024)
    with torch.autocast("cpu", torch.bfloat16):
        halved = losses(places, network, keypoints=1024)
    assert {name: value.item() for name, value in halved.items()} == {
        name: value.item() for name, value in exact.items()
    }


def test_losses_are_finite_reach_every_parameter_and_fall(places):
    trained = beginning(KeypointsRecipe())
    optimiser = torch.optim.Adam(trained.parameters(), lr=2e-3)
    seen = []
    for step in range(5):
        optimiser.zero_grad()
        found = losses(places, trained.network, points=96)
        assert all(torch.isfinite(value) for value in found.values())
        seen.append(float(found["points"].detach()))
        sum(found.values()).backward()
        if step == 0:
            untouched = [
                name
                for name, value in trained.network.named_parameters()
                if value.grad is None or not value.grad.any() or not torch.isfinite(value.grad).all()
            ]
            assert untouched == []
        optimiser.step()
    assert seen[-1] < 0.9 * seen[0]


def test_scores_learn_who_is_matched_right_and_choices_what_led_there():
    """Two keypoints here and there: the first are matched right, of the second nobody sees those there."""
    scores = torch.zeros(2, 2, requires_grad=True)
    log_chosen = torch.full((2, 2), -2.0, requires_grad=True)
    matched = torch.tensor([[[0.9, 0.0], [0.0, 0.1]]])
    visible, visible_back = torch.tensor([[True, True]]), torch.tensor([[True, False]])
    found = _score_losses(Drawn(torch.zeros(2, 2, 2), scores, log_chosen), matched, visible, visible_back)
    found["score"].backward()
    up = -scores.grad
    assert up[0, 0] > 0.0
    assert up[1, 0] > 0.0
    assert up[0, 1] < 0.0
    assert up[1, 1] == 0.0
    assert float(up[0, 0]) == pytest.approx((0.9 - 0.5) / 3)
    found["choice"].backward()
    np.testing.assert_allclose(-log_chosen.grad.numpy(), [[0.4 / 3, -0.4 / 3], [0.4 / 3, 0.0]], atol=1e-6)
    assert torch.equal(up, -scores.grad)  # the choice is rewarded by what is, not by what the score says
