"""Keypoints and descriptors of one panorama. Features -> planner, map store."""

from typing import Annotated, ClassVar

from pydantic import Field, model_validator

from shared.messages.arrays import Array, ArraySpec
from shared.messages.base import Message, Name, Part
from shared.messages.sensors import Frame

MAX_KEYPOINTS = 4096
MAX_THUMBNAIL_BYTES = 200_000
"""Chosen: four times what one of 800 columns takes."""


MAX_PHOTO_PX = 1600
"""Side of a photo; chosen: three pixels for each that the pipelines look at, at 110 degrees."""


class PhotoView(Part):
    """What is known of the camera of an ordinary photo, which shows a part of the sphere.

    Attributes:
        fov_rad: field of view over the longer side; with `fov_known` false what was taken for it.
        aspect: width over height, upright.
    """

    fov_rad: float = Field(ge=0.1, le=3.0)
    fov_known: bool = False
    aspect: float = Field(default=1.0, ge=0.1, le=10.0)


class Features(Message):
    """Keypoints and descriptors of one frame; what a map node keeps of it.

    Attributes:
        pipeline: extractor, representation and count that made them; only equals can be matched.
        lonlat_rad: (N, 2) longitude and latitude of each keypoint, camera frame.
        scores: (N,) detector response, larger is better.
        descriptors: (N, D).
        sizes_rad: (N,) diameter of each keypoint, above 0: what is nearer is larger; None where unknown.
        thumbnail: small JPEG of the frame: for people, to tell look-alikes apart, for photos; may be empty.
        photo: of an ordinary photo, its camera: it looks to longitude and latitude 0; None for a panorama.
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
    photo: PhotoView | None = None
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


class Photo(Part):
    """An ordinary photo, upright: rows of blue, green and red bytes."""

    view: PhotoView
    width_px: int = Field(ge=64, le=MAX_PHOTO_PX)
    height_px: int = Field(ge=64, le=MAX_PHOTO_PX)
    data: bytes = Field(max_length=3 * MAX_PHOTO_PX**2)

    @model_validator(mode="after")
    def _size_fits(self) -> "Photo":
        expected = 3 * self.width_px * self.height_px
        if len(self.data) != expected:
            raise ValueError(
                f"a photo of {self.width_px} x {self.height_px} needs {expected} bytes, got {len(self.data)}"
            )
        return self


class ExtractRequest(Message):
    """Ask for the features of any equirectangular picture, for example a goal."""

    SCHEMA: ClassVar[str] = "extract_request.v1"

    frame: Frame


class ExtractPhotoRequest(Message):
    """Ask for the features of an ordinary photo, which compare with those of panoramas."""

    SCHEMA: ClassVar[str] = "extract_photo_request.v1"

    photo: Photo
