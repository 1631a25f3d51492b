"""A frame of the bus as JPEG, for people. Pure."""

import io

from PIL import Image

from services.gateway.uploads.picture import check_header, decode_bgr
from shared.messages.sensors import Frame
from shared.web.problems import ProblemError

QUALITY = 80
"""Chosen: of JPEG, for the eye."""


def jpeg_of(frame: Frame, width_px: int | None) -> bytes:
    """Encode a frame, no wider than `width_px`; frames that are JPEG already pass unchanged when they fit.

    Raises:
        ProblemError: a JPEG frame that is damaged or not of the size it claims.
    """
    wanted_px = min(frame.width_px, width_px or frame.width_px) // 2 * 2
    if frame.encoding == "jpeg":
        header = check_header(frame.data, "image/jpeg")
        if (header.width_px, header.height_px) != (frame.width_px, frame.height_px):
            expected, got = f"{frame.width_px} px width", f"{header.width_px} px"
            raise ProblemError(502, "bad_frame", expected, got, "see the camera")
        if wanted_px == frame.width_px:
            return frame.data
        bgr = decode_bgr(frame.data, header)
        image = Image.fromarray(bgr[:, :, ::-1].copy())
    else:
        image = Image.frombuffer("RGB", (frame.width_px, frame.height_px), frame.data, "raw", "BGR", 0, 1)
    if image.width > wanted_px:
        image = image.resize((wanted_px, wanted_px // 2), Image.Resampling.BOX)
    out = io.BytesIO()
    image.save(out, "JPEG", quality=QUALITY)
    return out.getvalue()
