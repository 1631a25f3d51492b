"""Which matches agree with one motion of the camera, and which motion that is. Pure."""

from dataclasses import dataclass

import numpy as np

from services.features.pipeline.interfaces import FeatureSet, IndexArray
from shared.geometry.two_view import TwoViewResult, TwoViewSettings, two_view
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
    pairs: IndexArray,
    seq: int,
    settings: TwoViewSettings,
    with_matches: bool,
) -> NodeMatch:
    """Verify the matches of one candidate.

    Args:
        query: features of the current frame.
        candidate: features of the other.
        pairs: (M, 2) indices into both.
        seq: number of the current frame; with node_id it seeds the draws: one question, one answer.
        settings: limits of the two-view estimation.
        with_matches: put the matched bearings into the answer.
    """
    current, target = query.lonlat_rad[pairs[:, 0]], candidate.features.lonlat_rad[pairs[:, 1]]
    rng = np.random.default_rng([seq, candidate.node_id & 0xFFFF_FFFF])
    result = two_view(current, target, rng, settings)
    return NodeMatch(
        node_id=candidate.node_id,
        raw_matches=len(pairs),
        inliers=result.inliers,
        status=result.status,
        heading_rad=result.heading_rad,
        heading_std_rad=result.heading_std_rad,
        yaw_rad=result.yaw_rad,
        disparity_rad=result.disparity_rad,
        confidence=result.confidence,
        matches_rad=np.concatenate([current, target], axis=1) if with_matches else None,
        inlier_mask=_mask(result) if with_matches else None,
    )


def two_view_settings(verification_deg: float, *, uneven_ground: bool = False) -> TwoViewSettings:
    """Defaults of the estimation with the pipeline's own threshold, degrees.

    On a flat floor the essential-matrix fallback added 0.2 % inliers and took two thirds more time, as much
    on wrong nodes as on right ones; it is for a camera that tilts.
    """
    return TwoViewSettings(threshold_rad=float(np.deg2rad(verification_deg)), fallback=uneven_ground)


def feature_set(features: Features) -> FeatureSet:
    """Features of a message."""
    return FeatureSet(features.lonlat_rad, features.scores, features.descriptors)


def _mask(result: TwoViewResult) -> np.ndarray:
    return result.inlier_mask.astype(np.uint8)
