"""Features of a node in half the room: four bits per number of a descriptor. Pure.

    d ~ base + step * code, code in 0..15, base and step for each descriptor

The frame that is looked for stays exact, only the nodes are packed. Root SIFT loses 0.2 % of its verified
matches by this, TFeat 0.1, MKD 0.8, ALIKED 0.4 (`topnav study scale`), for 73 instead of 137 bytes a keypoint
of root SIFT. Bits are kept as they are.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from services.features.pipeline.interfaces import Distance, FeatureSet

LEVELS = 15
"""Largest code of four bits."""
TURN = 2.0**15 / np.pi
"""Steps of 16 bits per radian: 0.0055 degrees each."""
TINY = 1e-6
"""Least step, so that equal numbers do not divide by zero: below what 16 bits resolve."""

LEAST_SIZE_RAD, SIZE_STEP = 5e-4, 0.03
"""Sizes take a byte: from 0.03 degrees in steps of 3 %, a seventh of what they err by; 0 is unknown."""

Record = npt.NDArray[np.void]


@dataclass(frozen=True)
class Packing:
    """How the nodes of one pipeline are kept.

    Attributes:
        keypoints: most keypoints of a node.
        width: numbers per descriptor, bytes where they are bits.
        dtype: of the descriptors as they come.
        distance: of the descriptors.
    """

    keypoints: int
    width: int
    dtype: str
    distance: Distance

    @classmethod
    def of(cls, features: FeatureSet, keypoints: int, distance: Distance) -> Self:
        """For nodes with features like these, at most `keypoints` of them."""
        return cls(keypoints, features.descriptors.shape[1], features.descriptors.dtype.name, distance)

    @cached_property
    def record(self) -> np.dtype[np.void]:
        """Layout of one node."""
        scale, bits = ("u1" if self.dtype == "uint8" else "<f2"), self.distance == "hamming"
        fields: list[Any] = [
            ("count", "<u2"),
            ("lonlat", "<i2", (self.keypoints, 2)),
            ("scores", "<f2", (self.keypoints,)),
            ("sizes", "u1", (self.keypoints,)),
            ("codes", "u1", (self.keypoints, self.width if bits else (self.width + 1) // 2)),
        ]
        if not bits:
            fields += [("base", scale, (self.keypoints,)), ("step", scale, (self.keypoints,))]
        return np.dtype(fields)

    def pack(self, features: FeatureSet) -> Record:
        """One record, zero beyond the keypoints.

        Raises:
            ValueError: more keypoints than a record holds, or descriptors of another kind.
        """
        kind = (features.descriptors.shape[1], features.descriptors.dtype.name)
        if kind != (self.width, self.dtype) or len(features) > self.keypoints:
            raise ValueError(
                f"at most {self.keypoints} descriptors of {self.width} x {self.dtype} expected, "
                f"got {len(features)} of {kind[0]} x {kind[1]}"
            )
        record = np.zeros((), self.record)
        here = slice(0, len(features))
        record["count"] = len(features)
        # A full turn wraps around to where it began, as 16 bits do.
        record["lonlat"][here] = np.rint(features.lonlat_rad.astype(np.float64) * TURN).astype(np.int32)
        record["scores"][here] = features.scores
        if features.sizes_rad is not None:
            finest = np.log(features.sizes_rad / LEAST_SIZE_RAD) / SIZE_STEP
            record["sizes"][here] = np.clip(np.rint(finest), 0, 254).astype(np.uint8) + 1
        if self.distance == "hamming":
            record["codes"][here] = features.descriptors
        elif len(features):
            self._pack_numbers(record, features.descriptors, here)
        return record

    def _pack_numbers(self, record: Record, descriptors: npt.NDArray[Any], here: slice) -> None:
        numbers = descriptors.astype(np.float32)
        low, high = numbers.min(axis=1), numbers.max(axis=1)
        steps = np.maximum((high - low) / LEVELS, np.float32(TINY))
        record["base"][here] = low
        record["step"][here] = np.ceil(steps) if self.dtype == "uint8" else steps
        base, step = (record[name][here].astype(np.float32)[:, None] for name in ("base", "step"))
        codes = np.clip(np.rint((numbers - base) / np.maximum(step, TINY)), 0, LEVELS).astype(np.uint8)
        even, odd = codes[:, 0::2], codes[:, 1::2]
        record["codes"][here] = even << 4
        record["codes"][here, : odd.shape[1]] |= odd

    def unpack(self, record: Record) -> FeatureSet:
        """Features of a record; numbers come as float32."""
        count = int(record["count"])
        lonlat = record["lonlat"][:count].astype(np.float32) / np.float32(TURN)
        codes = record["codes"][:count]
        scores = record["scores"][:count].astype(np.float32)
        sizes = _sizes_rad(record["sizes"][:count])
        if self.distance == "hamming":
            return FeatureSet(lonlat, scores, np.array(codes), sizes)
        numbers = np.empty((count, 2 * codes.shape[1]), np.float32)
        numbers[:, 0::2] = codes >> 4
        numbers[:, 1::2] = codes & LEVELS
        numbers *= record["step"][:count].astype(np.float32)[:, None]
        numbers += record["base"][:count].astype(np.float32)[:, None]
        return FeatureSet(lonlat, scores, numbers[:, : self.width], sizes)


def _sizes_rad(codes: npt.NDArray[np.uint8]) -> npt.NDArray[np.float32] | None:
    """Diameters of keypoints; None where they are unknown."""
    if not codes.all():
        return None
    return np.asarray(LEAST_SIZE_RAD * np.exp(SIZE_STEP * (codes.astype(np.float32) - 1.0)), dtype=np.float32)
