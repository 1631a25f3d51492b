"""How a photo relates to a node: what a turn of its camera explains, and all matches. Pure."""

import numpy as np

from services.features.matching.verification import Candidate, cues_of
from services.features.pipeline.interfaces import FeatureSet, Matched
from shared.geometry.photo.plane import FOVS_RAD, focal_of, plane_from_lonlat, rays
from shared.geometry.photo.votes import vote
from shared.geometry.sphere import bearings_from_lonlat
from shared.messages.features import PhotoView
from shared.messages.matching import NodeMatch


def verify_photo(
    query: FeatureSet,
    view: PhotoView,
    candidate: Candidate,
    matched: Matched,
    seq: int,
    with_matches: bool,
) -> NodeMatch:
    """Match a photo with one node.

    With matches the answer holds all of them: where the photo was taken several nodes tell together
    (shared/mapgraph/photographs). Inliers are those that one turn of the camera explains, at the field of
    view at which it explains most.
    """
    other, pairs = candidate.features, matched.pairs
    photo, node = query.lonlat_rad[pairs[:, 0]], other.lonlat_rad[pairs[:, 1]]
    cues = cues_of(query, other, matched)
    rng = np.random.default_rng([seq, candidate.node_id & 0xFFFF_FFFF])
    plane = plane_from_lonlat(photo.astype(np.float64), focal_of(view.fov_rad))
    there = bearings_from_lonlat(node)
    fovs = (view.fov_rad,) if view.fov_known else FOVS_RAD
    votes = [vote(rays(plane, focal_of(fov))[0], there, matched.right, rng) for fov in fovs]
    best = max((v.count for v in votes if v is not None), default=0)
    return NodeMatch(
        node_id=candidate.node_id,
        raw_matches=len(pairs),
        inliers=best,
        status="too_few" if best < 2 else "inconsistent",
        matches_rad=np.concatenate([photo, node], axis=1) if with_matches else None,
        inlier_mask=np.zeros(len(pairs), np.uint8) if with_matches else None,
        right=matched.right.astype(np.float32) if with_matches else None,
        log_scale=cues.log_scale.astype(np.float32) if with_matches and cues.log_scale is not None else None,
    )
