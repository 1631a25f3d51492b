"""What plugins take and return. Pure data."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal, Protocol

import numpy as np
import numpy.typing as npt

Image = npt.NDArray[np.uint8]
FloatArray = npt.NDArray[np.float64]
Float32Array = npt.NDArray[np.float32]
BoolArray = npt.NDArray[np.bool_]
IndexArray = npt.NDArray[np.intp]
Distance = Literal["euclidean", "hamming"]


@dataclass(frozen=True)
class Profile:
    """One pipeline: three plugins and their figures.

    Attributes:
        extractor: plugin of `extractors`.
        representation: plugin of `representations`.
        matcher: plugin of `matchers`.
        keypoints: most keypoints kept per frame, which is S_max (thesis: 150; decision 0011: 300).
        ratio: largest distance of the best candidate relative to the second best (decision 0011).
        crop_deg: angle cut away above and below (thesis, section 6.1.1: 25), degrees.
        resize: rows and columns the whole picture is resized to (thesis: 400, 800); None = as it comes.
        upright: describe keypoints without turning them; the robot's camera stands about upright.
        surroundings: side of what SIFT describes, in its own sizes: more tells more, and changes more.
        verification_deg: largest angle off the epipolar plane of a verified match, degrees (decision 0011).
        tilting: the camera may lean: where level ones explain too little, any motion is tried.
        promising: so many matches must likely be right before cameras that lean are tried: of 400 pairs of
            the apartment none with fewer than 14 had S above 22, and most pairs of other spots have fewer.
        detector: of the patch networks: gftt, harris or keynet (kornia's).
        affnet: fit the shape of patches with AffNet; `upright` false turns them with OriNet (appendix A).
    """

    extractor: str
    representation: str = "equirectangular"
    matcher: str = "mutual_ratio"
    keypoints: int = 300
    ratio: float = 0.85
    crop_deg: float = 25.0
    resize: tuple[int, int] | None = (400, 800)
    upright: bool = True
    surroundings: float = 1.0
    verification_deg: float = 0.7
    tilting: bool = True
    promising: float = 12.0
    detector: str = "gftt"
    affnet: bool = False

    @property
    def identity(self) -> str:
        """What must be equal for two frames to be compared; travels as `Features.pipeline`."""
        unusual = "" if self.surroundings == 1.0 else f"-{self.surroundings:g}"
        return f"{self.extractor}-{self.representation}-{self.keypoints}{unusual}"


@dataclass(frozen=True)
class Runtime:
    """Where and how learned plugins run.

    Attributes:
        device: cpu or cuda.
        trained: load trained weights; False leaves what torch's generator draws, to test shapes.
    """

    device: str = "cpu"
    trained: bool = True


@dataclass(frozen=True, eq=False)
class View:
    """One flat picture of (a part of) the sphere.

    Attributes:
        gray: (H, W) picture.
        rad_per_pixel: angle that a pixel covers, from top to bottom; only ratios of sizes matter.
        lonlat_from_pixels: maps (N, 2) continuous pixels (first centre 0.5) to longitude, latitude, rad.
        owns: says for (N, 2) pixels whether this view reports them: overlaps belong to one view only.
    """

    gray: Image
    rad_per_pixel: float
    lonlat_from_pixels: Callable[[FloatArray], FloatArray]
    owns: Callable[[FloatArray], BoolArray]


@dataclass(frozen=True, eq=False)
class Detections:
    """Keypoints of one view.

    Attributes:
        pixels: (N, 2) continuous pixels.
        scores: (N,) response, larger is better.
        handle: what the extractor needs to describe them.
        sizes: (N,) diameter, pixels; None where the detector does not measure it.
    """

    pixels: FloatArray
    scores: Float32Array
    handle: Any
    sizes: Float32Array | None = None


@dataclass(frozen=True, eq=False)
class FeatureSet:
    """Keypoints and descriptors of one panorama.

    Attributes:
        lonlat_rad: (N, 2) longitude, latitude, camera frame.
        scores: (N,) response, descending.
        descriptors: (N, D).
        sizes_rad: (N,) diameter of each keypoint; None where the detector does not measure it.
    """

    lonlat_rad: Float32Array
    scores: Float32Array
    descriptors: npt.NDArray[Any]
    sizes_rad: Float32Array | None = None

    def __len__(self) -> int:
        return len(self.scores)


@dataclass(frozen=True, eq=False)
class Matched:
    """Matches of one frame with another.

    Attributes:
        pairs: (M, 2) index in the query, index in the other, in the order of the query.
        right: (M,) probability that each is right, by the descriptors alone.
        doubtful: (M,) those that help to find the motion, but too rarely right to count as similarity; None:
            none is.
    """

    pairs: IndexArray
    right: FloatArray
    doubtful: npt.NDArray[np.bool_] | None = None

    def __len__(self) -> int:
        return len(self.pairs)

    def count(self, chosen: npt.NDArray[np.bool_] | None = None) -> int:
        """How many of the chosen ones (M,) count as similarity, or of all."""
        counted = np.ones(len(self), np.bool_) if self.doubtful is None else ~self.doubtful
        return int(np.count_nonzero(counted if chosen is None else counted & chosen))

    @classmethod
    def alike(cls, pairs: IndexArray) -> "Matched":
        """Pairs of which nothing tells the right ones: every other one, as at 1 to 3 m (decision 0003)."""
        return cls(pairs, np.full(len(pairs), 0.5))


class Extractor(Protocol):
    """Finds keypoints first and describes only the chosen ones."""

    distance: Distance

    def detect(self, grays: Sequence[Image]) -> list[Detections]:
        """Find keypoint candidates in views of one size, many more than are kept."""
        ...

    def describe(
        self, gray: Image, detections: Detections, chosen: IndexArray
    ) -> tuple[IndexArray, npt.NDArray[Any]]:
        """Describe the chosen ones; returns those that could be described, and (M, D) descriptors."""
        ...


class Representation(Protocol):
    """Cuts a panorama into views."""

    def views(self, gray: Image) -> list[View]:
        """Views of a whole 2:1 panorama."""
        ...


class Matcher(Protocol):
    """Pairs the features of one frame with those of many others."""

    def match(self, query: FeatureSet, others: Sequence[FeatureSet]) -> list[Matched]:
        """Matches with each other frame."""
        ...
