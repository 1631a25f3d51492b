"""One pipeline put together from its plugins: frame -> features message, and matches of two. Pure."""

from dataclasses import replace

import numpy as np

from services.features.matching.verification import two_view_settings
from services.features.pipeline.extraction import extract
from services.features.pipeline.interfaces import FeatureSet, Image, Profile, Runtime
from services.features.pipeline.photograph import NATIVE_COLUMNS, extract_photo
from services.features.pipeline.plugins import create_extractor, create_matcher, create_representation
from services.features.pipeline.thumbnail import thumbnail
from shared.frames.decoding import decode_picture
from shared.messages.features import Features, Photo
from shared.messages.sensors import Frame


class Pipeline:
    """The plugins of one profile, ready to use."""

    def __init__(
        self,
        profile: Profile,
        thumbnail_width_px: int = 800,
        thumbnail_quality: int = 75,
        runtime: Runtime | None = None,
    ) -> None:
        runtime = runtime or Runtime()
        self.profile = profile
        self.identity = profile.identity
        self.extractor = create_extractor(profile, runtime)
        self.representation = create_representation(profile)
        self.matcher = create_matcher(profile, self.extractor.distance, runtime)
        self.verification = two_view_settings(profile)
        self._enough_px = profile.resize[1] if profile.resize is not None else None
        self._thumbnail = (thumbnail_width_px, thumbnail_quality)

    @property
    def columns(self) -> int:
        """Of a panorama as extractors see it."""
        return self._enough_px or NATIVE_COLUMNS

    def features_of(self, frame: Frame) -> Features:
        """Extract a frame's features; the number, time and robot of the frame go with them.

        Raises:
            BadPictureError: the frame holds no usable picture.
        """
        picture = decode_picture(frame, self._enough_px)
        found = extract(picture, self.extractor, self.representation, self.profile)
        return self._told(found).model_copy(
            update={
                "seq": frame.seq,
                "stamp_ns": frame.stamp_ns,
                "robot": frame.robot,
                "lockstep": frame.lockstep,
                "thumbnail": thumbnail(picture, *self._thumbnail),
            }
        )

    def features_of_picture(self, picture: Image, keypoints: int) -> Features:
        """Extract another number of keypoints from (H, 2H, 3) BGR."""
        profile = replace(self.profile, keypoints=keypoints)
        return self._told(extract(picture, self.extractor, self.representation, profile))

    def features_of_photo(self, photo: Photo) -> Features:
        """Extract an ordinary photo's features; they compare with those of frames."""
        flat = np.frombuffer(photo.data, dtype=np.uint8)
        picture = flat.reshape(photo.height_px, photo.width_px, 3)
        found = extract_photo(picture, photo.view, self.extractor, self.profile)
        return self._told(found).model_copy(update={"photo": photo.view})

    def _told(self, found: FeatureSet) -> Features:
        return Features(
            pipeline=self.identity,
            lonlat_rad=found.lonlat_rad,
            scores=found.scores,
            descriptors=found.descriptors,
            sizes_rad=found.sizes_rad,
        )
