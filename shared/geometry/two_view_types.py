"""What every two-view estimator takes and returns."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from shared.geometry.sphere import BoolArray, FloatArray

Status = Literal["ok", "no_baseline", "too_few", "inconsistent"]
Model = Literal["planar", "tilted", "rotation", "none"]

MOVED_RAD = float(np.deg2rad(2.0))
"""Change of bearing that only a way explains: four times what noise and a turn that is a little off leave."""


@dataclass(frozen=True)
class TwoViewSettings:
    """Limits of the two-view estimation.

    What half and twice of each changes is measured by `pytest -s tests/benchmarks/test_two_view_effort.py`.

    Attributes:
        pairs: hypotheses drawn, each from two matches (all pairs where there are fewer): where a quarter of
            the matches is right, 20 of 320 are two right ones.
        threshold_rad: largest angular (Sampson) distance of an inlier from the epipolar plane, radians; 0.7
            degrees of decision 0011: half of it loses 10 % of the answers, twice of it 3 %.
        min_matches: fewer matches than this are not tried; chosen: three times what fixes a hypothesis.
        min_inliers: fewer inliers than this are never a usable answer: with 4, unrelated pairs are answered;
            16 lose 11 % of the answers.
        no_baseline_rad: a median change of bearings below this means that the camera has only turned,
            radians; chosen: the noise of a keypoint, two thirds of a pixel at 800 columns.
        no_baseline_noise: the same bound in units of the measured noise, whichever is larger; pure noise
            gives 1.7 (evidence.NOISE_DISPARITY).
        min_parallax_z: displacements away from the heading must be this many standard deviations from zero on
            average, where a turn alone would explain the matches; the best direction of pure noise reaches
            about 3: with half of it, turned cameras are answered six times as often.
        max_log_nfa: largest natural logarithm of the number of false alarms: above it, chance explains the
            inliers; chosen: one in seven such pairs of wrong frames, before the other limits.
        max_heading_std_rad: above this spread a direction is not worth following, radians; chosen:
            20 degrees, two thirds of a node's twelve directions.
        tilting: the camera may lean: where a level one explains too little, rotation and travel are free.
        tilting_min_right: matches of which fewer than this are likely right, by their descriptors, are not
            worth the price of it, three times that of level cameras.
        settled_noise: an answer of level cameras whose residuals spread over more than this share of the
            threshold is too noisy: those of a wrong model fill the band evenly: 1 / sqrt(3) = 0.58.
        settled_blur: ... or over more than this share of the disparity: a camera that also went up or down
            leaves as much as a tenth of a short way; chosen.
        settled_near: ... or which leaves more than this share of the matches, plus two, just out of reach;
            chosen.
        settled_share: ... or which explains less than this share of the matches; chosen: below
            the half that is right at 1 to 3 m (decision 0003).
        min_nats: evidence below which a motion is chance, nats: of 1091 unrelated pictures one is answered.
        min_parallax_nats: ... or below which its rotation explains as much; chosen.
    """

    pairs: int = 320
    threshold_rad: float = float(np.deg2rad(0.7))
    min_matches: int = 6
    min_inliers: int = 8
    no_baseline_rad: float = float(np.deg2rad(0.3))
    no_baseline_noise: float = 2.0
    min_parallax_z: float = 4.5
    max_log_nfa: float = -2.0
    max_heading_std_rad: float = float(np.deg2rad(20.0))
    tilting: bool = True
    tilting_min_right: float = 8.0
    settled_noise: float = 0.45
    settled_blur: float = 0.08
    settled_near: float = 0.15
    settled_share: float = 0.5
    min_nats: float = 8.0
    min_parallax_nats: float = 11.0


@dataclass(frozen=True, eq=False)
class TwoViewResult:
    """Relative pose of two upright spherical views.

    Attributes:
        status: 'ok'; 'no_baseline', the camera has only turned; 'too_few' matches to try;
            'inconsistent', no motion explains enough of them.
        heading_rad: direction from the current to the target position, current frame, [-pi, pi); None unless
            'ok'.
        yaw_rad: rotation of the target frame seen from the current one, [-pi, pi); None for 'too_few' and
            'inconsistent'.
        inlier_mask: (N,) matches the model explains; all False for 'too_few'.
        inliers: their number.
        confidence: [0, 1], how far `heading_rad` can be trusted; 0 unless 'ok'.
        disparity_rad: by how much the bearings of the inliers differ once the target ones are turned, the
            arrival measure, see `evidence.disparity_rad`; None where `yaw_rad` is None.
        heading_std_rad: standard deviation of the heading from the normal matrix; None unless 'ok'.
        yaw_std_rad: the same for the yaw.
        sign_margin: [0, 1], how clearly the parallax tells forwards from backwards.
        noise_rad: standard deviation of the inliers' residuals, radians; None unless a model with travel was
            fitted.
        model: which model gave the answer.
        moved: inliers whose bearing changed by more than MOVED_RAD beside the rotation: what is far away, out
            of a window or down a corridor, agrees with many places and proves none; None where `yaw_rad` is.
        near_misses: matches just beyond the threshold that chance does not explain; many of them mean that
            the model, not the matches, is wrong. Planar model only.
    """

    status: Status
    heading_rad: float | None
    yaw_rad: float | None
    inlier_mask: BoolArray
    inliers: int
    confidence: float
    disparity_rad: float | None
    heading_std_rad: float | None
    yaw_std_rad: float | None
    sign_margin: float
    noise_rad: float | None
    model: Model
    moved: int | None = None
    near_misses: float = 0.0

    @property
    def usable(self) -> bool:
        """Whether there is a heading to follow."""
        return self.status == "ok"


def refused(status: Status, mask: BoolArray) -> TwoViewResult:
    """Result without a pose; `mask` still tells which matches agreed best."""
    return TwoViewResult(status, None, None, mask, int(mask.sum()), 0.0, None, None, None, 0.0, None, "none")


def moved(apart_rad: FloatArray) -> int:
    """How many of the inliers, this far apart beside the rotation, have moved."""
    return int((apart_rad > MOVED_RAD).sum())


def checked_matches(current: npt.ArrayLike, target: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return both inputs as float64 arrays of equal shape (N, 2), or say what is wrong with them."""
    c, t = np.asarray(current, dtype=np.float64), np.asarray(target, dtype=np.float64)
    if c.ndim != 2 or c.shape[1] != 2 or c.shape != t.shape:
        raise ValueError(f"current and target must both have shape (N, 2), got {c.shape} and {t.shape}")
    if not (np.isfinite(c).all() and np.isfinite(t).all()):
        raise ValueError("current and target must be finite longitudes and latitudes, got NaN or infinity")
    return c, t
