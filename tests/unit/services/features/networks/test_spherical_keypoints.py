"""Our detector's parts: peaks, descriptors between pixels, and a score for each pixel of any picture."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

torch = pytest.importorskip("torch")

from services.features.networks.spherical_keypoints import (  # noqa: E402
    PHASE,
    described,
    network_of,
    strongest,
)


def bump(x: float, y: float, height: int = 40, width: int = 60, strength: float = 5.0):
    """(H, W) a hill whose top is at continuous pixels (x, y); logits, so a parabola."""
    rows, columns = torch.meshgrid(torch.arange(height) + 0.5, torch.arange(width) + 0.5, indexing="ij")
    return strength - 0.5 * ((columns - x) ** 2 + (rows - y) ** 2)


def test_peaks_are_found_to_a_fraction_of_a_pixel_and_the_strongest_comes_first():
    scores = torch.maximum(bump(20.3, 11.8), bump(44.6, 30.1, strength=8.0))[None]
    pixels, values = strongest(scores, 2)
    assert_allclose(pixels[0].numpy(), [[44.6, 30.1], [20.3, 11.8]], atol=1e-3)
    assert values[0, 0] > values[0, 1]


def test_near_a_stronger_keypoint_there_is_none():
    scores = torch.full((1, 20, 20), -9.0)
    scores[0, 10, 10], scores[0, 10, 12], scores[0, 10, 13] = 3.0, 2.0, 1.0
    pixels, _ = strongest(scores, 2)
    assert pixels[0, 0].tolist() == pytest.approx([10.5, 10.5], abs=0.5)
    assert not ((pixels[0, 1] - pixels[0, 0]).abs() <= 2.0).all()


def test_columns_that_repeat_the_other_side_have_no_keypoints():
    scores = torch.maximum(bump(5.5, 20.5, strength=9.0), bump(30.5, 20.5))[None]
    pixels, _ = strongest(scores, 1, margin_px=10)
    assert_allclose(pixels[0, 0].numpy(), [30.5, 20.5], atol=1e-3)


def test_a_descriptor_between_cells_is_the_mean_of_both_and_maps_add_up():
    fine, coarse = torch.zeros(1, 2, 4, 8), torch.zeros(1, 2, 2, 4)
    fine[0, 0, 1, 2], fine[0, 1, 1, 3] = 1.0, 1.0
    coarse[0, 1] = 2.0
    centre, between = [2.5 * 4, 1.5 * 4], [3.0 * 4, 1.5 * 4]
    found = described((fine, coarse), (4, 8), torch.tensor([[centre, between]]))
    wanted = np.array([[1.0, 2.0], [0.5, 2.5]])
    assert_allclose(found[0].numpy(), wanted / np.linalg.norm(wanted, axis=1, keepdims=True), atol=1e-6)


@pytest.mark.parametrize("shape", ["slim", "superpoint"])
def test_every_pixel_of_any_size_has_a_score_and_a_descriptor(shape):
    network = network_of(shape).eval()
    with torch.inference_mode():
        scores, maps = network(torch.rand(2, 1, 50, 70))
        vectors = described(
            maps, network.strides, torch.tensor([[[0.5, 0.5], [69.5, 49.5]]]).expand(2, -1, -1)
        )
    assert scores.shape == (2, 50, 70)
    assert vectors.shape == (2, 2, network.dimension)
    assert_allclose(vectors.norm(dim=-1).numpy(), 1.0, atol=1e-5)


def test_what_moves_in_the_picture_by_whole_cells_moves_in_the_scores():
    torch.manual_seed(1)
    network, picture = network_of("slim").eval(), torch.rand(1, 1, 96, 512)
    with torch.inference_mode():
        here, _ = network(picture)
        moved, _ = network(torch.roll(picture, PHASE, dims=3))
    inside = slice(224, 288)  # as far from both edges as the network looks
    assert_allclose(moved[0, :, inside].numpy(), here[0, :, 224 - PHASE : 288 - PHASE].numpy(), atol=1e-4)


@pytest.mark.parametrize(("factor", "offset"), [(0.5, 0.0), (0.7, 0.2)])
def test_brightness_and_contrast_change_nothing(factor, offset):
    torch.manual_seed(1)
    network, picture = network_of("slim").eval(), torch.rand(1, 1, 64, 96)
    with torch.inference_mode():
        plain, _ = network(picture)
        lit, _ = network(factor * picture + offset)
    assert_allclose(lit.numpy(), plain.numpy(), atol=2e-2)
