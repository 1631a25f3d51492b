"""What a picture claims of a node: where it lies and how its camera is turned. Pure."""

from dataclasses import dataclass

from shared.messages.matching import NodeMatch

CONFIDENCE_MIN = 0.5
"""Below it a match claims no edge and no place: its two directions explain it equally well."""


@dataclass(frozen=True)
class Claim:
    """One sight of a node.

    Attributes:
        similarity: S of the two.
        heading_rad: bearing of the node, camera frame of the picture; None where both are one spot.
        heading_std_rad: its error.
        yaw_rad: rotation from the picture's camera to the node's.
        disparity_rad: that says how far it is.
    """

    similarity: int
    heading_rad: float | None
    heading_std_rad: float
    yaw_rad: float
    disparity_rad: float


def claim_of(
    match: NodeMatch, disparity_rad: float | None = None, confidence_min: float = CONFIDENCE_MIN
) -> Claim | None:
    """What a match claims; None where two-view geometry is not sure of anything.

    Args:
        match: picture against node.
        confidence_min: below it a match claims nothing.
        disparity_rad: takes the place of the match's, where something else says more.
    """
    if match.yaw_rad is None or match.status not in ("ok", "no_baseline"):
        return None
    if match.status == "no_baseline" or match.heading_rad is None or match.disparity_rad is None:
        return Claim(match.inliers, None, 0.0, match.yaw_rad, 0.0)
    if match.confidence < confidence_min:
        return None
    apart_rad = match.disparity_rad if disparity_rad is None else disparity_rad
    return Claim(match.inliers, match.heading_rad, match.heading_std_rad or 0.0, match.yaw_rad, apart_rad)
