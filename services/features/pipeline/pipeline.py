"""One pipeline put together from its plugins: frame -> features message, and matches of two. Pure."""

from services.features.matching.verification import two_view_settings
from services.features.pipeline.decoding import decode_picture
from services.features.pipeline.extraction import extract
from services.features.pipeline.named_pipelines import Profile
from services.features.pipeline.registry import (
    Runtime,
    create_extractor,
    create_matcher,
    create_representation,
)
from services.features.pipeline.thumbnail import make_thumbnail
from shared.messages.features import Features
from shared.messages.sensors import Frame


class Pipeline:
    """The plugins of one profile, ready to use."""

    def __init__(
        self,
        profile: Profile,
        thumbnail_width_px: int = 320,
        thumbnail_quality: int = 70,
        runtime: Runtime | None = None,
    ) -> None:
        runtime = runtime or Runtime()
        self.profile = profile
        self.identity = profile.identity
        self.extractor = create_extractor(profile, runtime)
        self.representation = create_representation(profile)
        self.matcher = create_matcher(profile, self.extractor.distance, runtime)
        self.verification = two_view_settings(profile.verification_deg, uneven_ground=profile.uneven_ground)
        self._enough_px = profile.resize[1] if profile.resize is not None else None
        self._thumbnail = (thumbnail_width_px, thumbnail_quality)

    def features_of(self, frame: Frame) -> Features:
        """Extract a frame's visual words; the number, time and robot of the frame go with them.

        Raises:
            BadPictureError: the frame holds no usable picture.
        """
        picture = decode_picture(frame, self._enough_px)
        words = extract(picture, self.extractor, self.representation, self.profile)
        return Features(
            seq=frame.seq,
            stamp_ns=frame.stamp_ns,
            robot=frame.robot,
            lockstep=frame.lockstep,
            pipeline=self.identity,
            lonlat_rad=words.lonlat_rad,
            scores=words.scores,
            descriptors=words.descriptors,
            thumbnail=make_thumbnail(picture, *self._thumbnail),
        )
