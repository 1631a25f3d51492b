"""A camera's picture to a frame of the bus: passed on as it is, or made level, turned, joined and scaled."""

from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np

from services.camera.mount.calibration_file import FisheyeCalibration
from services.camera.mount.orientation import Orientation
from services.camera.mount.table import PanoramaTable, from_fisheyes, from_panorama
from services.camera.source import MAX_PIXELS, Image, Picture
from shared.jpeg import BadPictureError, jpeg_size, require_whole
from shared.messages.sensors import Frame

NARROWEST_PX = 64
"""Of a panorama; chosen, as the simulated camera's."""
REDUCED = {2: cv2.IMREAD_REDUCED_COLOR_2, 4: cv2.IMREAD_REDUCED_COLOR_4, 8: cv2.IMREAD_REDUCED_COLOR_8}


@dataclass(frozen=True)
class FrameSettings:
    """What frames are to be.

    Attributes:
        robot: whose they are.
        width_px: most columns of a frame.
        encoding: "jpeg" or "bgr8".
        jpeg_quality: of pictures that are encoded here.
        delay_s: from exposure to arrival.
        lockstep: the next frame waits for this one's features.
        mask_rad: see `from_fisheyes`.
    """

    robot: str
    width_px: int
    encoding: str
    jpeg_quality: int
    delay_s: float
    lockstep: bool
    mask_rad: float = 0.0


class FrameMaker:
    """Makes frames of one camera."""

    def __init__(
        self, settings: FrameSettings, orientation: Orientation, fisheye: FisheyeCalibration | None
    ) -> None:
        self._settings, self._orientation, self._fisheye = settings, orientation, fisheye
        self._table = lru_cache(maxsize=2)(self._make_table)  # a camera may change its size, once or twice

    def frame(self, picture: Picture, seq: int) -> Frame:
        """The frame of one picture.

        Raises:
            BadPictureError: it is not twice as wide as high, too large, or damaged.
        """
        width, height = size_of(picture)
        self._require_fitting(width, height)
        data, width = self._data(picture, width)
        settings = self._settings
        return Frame(
            seq=seq,
            stamp_ns=max(0, picture.arrived_ns - round(settings.delay_s * 1e9)),
            robot=settings.robot,
            lockstep=settings.lockstep,
            encoding="jpeg" if settings.encoding == "jpeg" else "bgr8",
            width_px=width,
            height_px=width // 2,
            data=data,
        )

    def panorama(self, picture: Picture) -> Image:
        """The same as a picture, (H, 2H, 3) BGR.

        Raises:
            BadPictureError: as for `frame`.
        """
        width, height = size_of(picture)
        self._require_fitting(width, height)
        return self._panorama(picture, width)

    def _data(self, picture: Picture, width: int) -> tuple[bytes, int]:
        as_it_is = self._fisheye is None and self._orientation.is_none and width <= self._settings.width_px
        if as_it_is and isinstance(picture.data, bytes) and self._settings.encoding == "jpeg":
            return picture.data, width
        panorama = self._panorama(picture, width)
        if self._settings.encoding == "bgr8":
            return panorama.tobytes(), panorama.shape[1]
        quality = [cv2.IMWRITE_JPEG_QUALITY, self._settings.jpeg_quality]
        return cv2.imencode(".jpg", panorama, quality)[1].tobytes(), panorama.shape[1]

    def _panorama(self, picture: Picture, width: int) -> Image:
        result_px = self._result_width(width)
        turned = self._fisheye is not None or not self._orientation.is_none
        decoded = decoded_picture(picture, result_px)
        if turned:
            return self._table(result_px, decoded.shape[1]).applied(decoded)
        if decoded.shape[1] == result_px:
            return decoded
        size = result_px, result_px // 2
        return np.asarray(cv2.resize(decoded, size, interpolation=cv2.INTER_AREA), dtype=np.uint8)

    def _result_width(self, width: int) -> int:
        return min(width, self._settings.width_px) // 4 * 4  # rows are even, as JPEG's colours like them

    def _require_fitting(self, width: int, height: int) -> None:
        if self._fisheye is None:
            if width != 2 * height or width < NARROWEST_PX:
                raise BadPictureError(
                    f"an equirectangular picture, twice as wide as high, expected, got {width} x {height}: "
                    "choose the camera's 360-degree output, or calibrate two fisheyes (?fisheye=FILE)"
                )
        elif abs(width * self._fisheye.height_px - height * self._fisheye.width_px) > width + height:
            known = f"{self._fisheye.width_px} x {self._fisheye.height_px}"
            raise BadPictureError(
                f"two fisheyes in a picture shaped as the calibrated {known} expected, got {width} x {height}"
            )

    def _make_table(self, width_px: int, source_width_px: int) -> PanoramaTable:
        if self._fisheye is None:
            return from_panorama(width_px, source_width_px, self._orientation)
        calibration = self._fisheye.scaled(source_width_px)
        return from_fisheyes(width_px, calibration, self._orientation, self._settings.mask_rad)


def size_of(picture: Picture) -> tuple[int, int]:
    """Width and height of a picture, a JPEG's by its header.

    Raises:
        BadPictureError: no JPEG, not a whole one, or too large.
    """
    if isinstance(picture.data, bytes):
        width, height = jpeg_size(picture.data)
        require_whole(picture.data)
    else:
        height, width = picture.data.shape[:2]
    if width * height > MAX_PIXELS:
        raise BadPictureError(f"at most {MAX_PIXELS} pixels expected, got {width} x {height}")
    return width, height


def decoded_picture(picture: Picture, enough_px: int) -> Image:
    """(H, W, 3) BGR; a JPEG that is much wider than `enough_px` at a half, quarter or eighth of its size.

    Raises:
        BadPictureError: damaged.
    """
    if not isinstance(picture.data, bytes):
        return picture.data
    width, _ = jpeg_size(picture.data)
    divisor = max((d for d in REDUCED if width % d == 0 and width // d >= enough_px), default=1)
    flags = REDUCED.get(divisor, cv2.IMREAD_COLOR) | cv2.IMREAD_IGNORE_ORIENTATION
    try:
        decoded = cv2.imdecode(np.frombuffer(picture.data, np.uint8), flags)
    except cv2.error as error:
        raise BadPictureError(f"JPEG cannot be decoded: {str(error)[:120]}") from error
    if decoded is None or decoded.shape[1] != width // divisor:
        raise BadPictureError("JPEG cannot be decoded: its data are damaged")
    return np.asarray(decoded, dtype=np.uint8)
