"""Corners and patches are those that kornia finds and cuts for the feature service."""

import cv2
import kornia.feature as kf
import numpy as np
import torch

from experiments.training.patch.cutting import Frames, corners, patches


def scene() -> np.ndarray:
    """Noise of two sizes, large enough for three octaves."""
    rng = np.random.default_rng(2)
    coarse = cv2.resize(rng.integers(0, 256, (16, 32), np.uint8), (512, 256), interpolation=cv2.INTER_CUBIC)
    fine = cv2.GaussianBlur(rng.integers(0, 256, (256, 512), np.uint8), (0, 0), 2.0)
    return cv2.addWeighted(coarse, 0.5, fine, 0.5, 0.0)


def as_batch(gray: np.ndarray) -> torch.Tensor:
    return torch.from_numpy(gray)[None, None].float() / 255.0


def as_frames(lafs: torch.Tensor) -> Frames:
    pixels = lafs[0, :, :, 2].double().numpy() + 0.5
    return Frames(pixels, np.sqrt(torch.linalg.det(lafs[0, :, :, :2]).abs().double().numpy()))


def test_corners_are_where_and_as_large_as_those_of_kornia():
    theirs, _ = kf.MultiResolutionDetector(kf.CornerGFTT(), num_features=150)(as_batch(scene()))
    expected, found = as_frames(theirs), corners(scene(), 150)
    assert len(np.unique(expected.halves_px.round())) >= 4
    np.testing.assert_allclose(found.halves_px, expected.halves_px, rtol=1e-5)
    np.testing.assert_allclose(found.pixels, expected.pixels, atol=1e-3)


def test_patches_are_those_of_kornia_turned_large_or_beyond_the_side():
    rng = np.random.default_rng(4)
    turns = rng.uniform(-0.5, 0.5, 60)
    frames = Frames(rng.uniform([0, 0], [512, 256], (60, 2)), 12.0 * 2.0 ** rng.uniform(0.0, 3.5, 60))
    lafs = np.zeros((1, 60, 2, 3), np.float32)
    lafs[0, :, 0, 0] = lafs[0, :, 1, 1] = frames.halves_px * np.cos(turns)
    lafs[0, :, 1, 0] = frames.halves_px * np.sin(turns)
    lafs[0, :, 0, 1] = -lafs[0, :, 1, 0]
    lafs[0, :, :, 2] = frames.pixels - 0.5
    theirs = kf.extract_patches_from_pyramid(as_batch(scene()), torch.from_numpy(lafs), 32)[0, :, 0]
    off = np.abs(patches(scene(), frames, turns) - 255.0 * theirs.numpy())
    assert off.max() < 1.0


def test_a_picture_without_corners_has_none():
    assert len(corners(np.full((128, 256), 90, np.uint8), 10)) == 0
    assert patches(scene(), corners(np.full((128, 256), 90, np.uint8), 10)).shape == (0, 32, 32)
