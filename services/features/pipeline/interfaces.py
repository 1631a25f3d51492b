"""What plugins take and return."""

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


@dataclass(frozen=True, eq=False)
class View:
    """One flat picture of (a part of) the sphere.

    Attributes:
        gray: (H, W) picture.
        lonlat_from_pixels: maps (N, 2) continuous pixels (first centre 0.5) to longitude, latitude, rad.
        owns: says for (N, 2) pixels whether this view reports them: overlaps belong to one view only.
    """

    gray: Image
    lonlat_from_pixels: Callable[[FloatArray], FloatArray]
    owns: Callable[[FloatArray], BoolArray]


@dataclass(frozen=True, eq=False)
class Detections:
    """Keypoints of one view.

    Attributes:
        pixels: (N, 2) continuous pixels.
        scores: (N,) response, larger is better.
        handle: what the extractor needs to describe them.
    """

    pixels: FloatArray
    scores: Float32Array
    handle: Any


@dataclass(frozen=True, eq=False)
class FeatureSet:
    """Visual words of one panorama.

    Attributes:
        lonlat_rad: (N, 2) longitude, latitude, camera frame.
        scores: (N,) response, descending.
        descriptors: (N, D).
    """

    lonlat_rad: Float32Array
    scores: Float32Array
    descriptors: npt.NDArray[Any]

    def __len__(self) -> int:
        return len(self.scores)


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
    """Pairs the words of one frame with those of many others."""

    def match(self, query: FeatureSet, others: Sequence[FeatureSet]) -> list[IndexArray]:
        """(M, 2) index pairs per other: index in the query, index in the other."""
        ...
