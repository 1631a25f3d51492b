"""Which matches agree with one motion of the camera, and which motion that is. Pure."""

from dataclasses import dataclass

import numpy as np

from services.features.pipeline.interfaces import FeatureSet, Matched, Profile
from shared.geometry.two_view import Cues, TwoViewResult, TwoViewSettings, two_view
from shared.messages.features import Features
from shared.messages.matching import NodeMatch


@dataclass(frozen=True, eq=False)
class Candidate:
    """A frame to compare with: its number in the reply and its features."""

    node_id: int
    features: FeatureSet


def verify(
    query: FeatureSet,
    candidate: Candidate,
    matched: Matched,
    seq: int,
    settings: TwoViewSettings,
    with_matches: bool,
) -> NodeMatch:
    """Verify the matches of one candidate.

    Args:
        query: features of the current frame.
        candidate: features of the other.
        matched: pairs of both.
        seq: number of the current frame; with node_id it seeds the draws: one question, one answer.
        settings: limits of the two-view estimation.
        with_matches: put the matched bearings into the answer.
    """
    other, pairs = candidate.features, matched.pairs
    current, target = query.lonlat_rad[pairs[:, 0]], other.lonlat_rad[pairs[:, 1]]
    rng = np.random.default_rng([seq, candidate.node_id & 0xFFFF_FFFF])
    result = two_view(current, target, rng, settings, cues_of(query, other, matched))
    return NodeMatch(
        node_id=candidate.node_id,
        raw_matches=matched.count(),
        inliers=matched.count(result.inlier_mask),
        status=result.status,
        heading_rad=result.heading_rad,
        heading_std_rad=result.heading_std_rad,
        yaw_rad=result.yaw_rad,
        disparity_rad=result.disparity_rad,
        confidence=result.confidence,
        noise_rad=result.noise_rad,
        moved=result.moved,
        matches_rad=np.concatenate([current, target], axis=1) if with_matches else None,
        inlier_mask=_mask(result) if with_matches else None,
    )


def cues_of(query: FeatureSet, other: FeatureSet, matched: Matched) -> Cues:
    """What tells right matches beside their bearings."""
    if query.sizes_rad is None or other.sizes_rad is None:
        return Cues(matched.right)
    sizes = query.sizes_rad[matched.pairs[:, 0]] / other.sizes_rad[matched.pairs[:, 1]]
    return Cues(matched.right, np.log(sizes.astype(np.float64)))


def two_view_settings(profile: Profile) -> TwoViewSettings:
    """Limits of the estimation as a pipeline's profile sets them."""
    return TwoViewSettings(
        threshold_rad=float(np.deg2rad(profile.verification_deg)),
        tilting=profile.tilting,
        tilting_min_right=profile.promising,
    )


def feature_set(features: Features) -> FeatureSet:
    """Features of a message."""
    return FeatureSet(features.lonlat_rad, features.scores, features.descriptors, features.sizes_rad)


def _mask(result: TwoViewResult) -> np.ndarray:
    return result.inlier_mask.astype(np.uint8)
