"""Keypoints and descriptors of one panorama. Features -> planner, map store."""

from typing import Annotated, ClassVar

from pydantic import Field, model_validator

from shared.messages.arrays import Array, ArraySpec
from shared.messages.base import Message, Name
from shared.messages.sensors import Frame

MAX_KEYPOINTS = 4096
MAX_THUMBNAIL_BYTES = 200_000
"""Chosen: ten times what the widest that settings allow takes."""


class Features(Message):
    """Keypoints and descriptors of one frame; what a map node keeps instead of the picture.

    Attributes:
        pipeline: extractor, representation and count that made them; only equals can be matched.
        lonlat_rad: (N, 2) longitude and latitude of each keypoint, camera frame.
        scores: (N,) detector response, larger is better.
        descriptors: (N, D).
        sizes_rad: (N,) diameter of each keypoint, above 0: what is nearer is larger; None where unknown.
        thumbnail: small JPEG of the frame for people, and to compare look-alikes by; may be empty.
        extract_ms: time the feature service took for this picture, decoding and thumbnail included.
    """

    SCHEMA: ClassVar[str] = "features.v1"

    robot: Name = "none"
    lockstep: bool = False
    pipeline: str = Field(max_length=128)
    lonlat_rad: Annotated[Array, ArraySpec(("float32",), (None, 2), MAX_KEYPOINTS)]
    scores: Annotated[Array, ArraySpec(("float32",), (None,), MAX_KEYPOINTS)]
    descriptors: Annotated[Array, ArraySpec(("float32", "float16", "uint8"), (None, None), MAX_KEYPOINTS)]
    sizes_rad: Annotated[Array, ArraySpec(("float32",), (None,), MAX_KEYPOINTS)] | None = None
    thumbnail: bytes = Field(default=b"", max_length=MAX_THUMBNAIL_BYTES)
    extract_ms: float = Field(default=0.0, ge=0.0)

    @model_validator(mode="after")
    def _counts_agree(self) -> "Features":
        counts = (len(self.lonlat_rad), len(self.scores), len(self.descriptors))
        if len(set(counts)) != 1:
            raise ValueError(f"lonlat_rad, scores and descriptors must have one length, got {counts}")
        if self.sizes_rad is None:
            return self
        count = len(self.sizes_rad)
        if count != counts[0]:
            raise ValueError(f"sizes_rad must have {counts[0]} numbers, as scores have, got {count}")
        if count and not float(self.sizes_rad.min()) > 0.0:
            raise ValueError(f"sizes_rad must be above 0, got {self.sizes_rad.min()}")
        return self


class ExtractRequest(Message):
    """Ask for the features of any equirectangular picture, for example a goal."""

    SCHEMA: ClassVar[str] = "extract_request.v1"

    frame: Frame
