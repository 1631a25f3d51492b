"""From an uploaded picture to its features: what goal check and goto have in common."""

from dataclasses import dataclass

from fastapi import Request

from services.gateway.auth.guard import person_of
from services.gateway.http.bodies import read_picture
from services.gateway.state import Gateway
from services.gateway.uploads.photo import decode_photo, is_photo
from services.gateway.uploads.photo_places import LocatedPhoto, locate_photo
from services.gateway.uploads.picture import check_file, check_panorama, decode_bgr
from services.gateway.uploads.picture_header import PictureHeader
from shared.messages.features import ExtractRequest, Features, Photo
from shared.messages.sensors import Frame
from shared.topics import EXTRACT
from shared.web.problems import ProblemError


@dataclass(frozen=True)
class Goal:
    """An uploaded picture as the other services know it."""

    header: PictureHeader
    features: Features
    photo: LocatedPhoto | None = None


async def goal_of(
    request: Request, gateway: Gateway, robot: str, map_name: str, field_of_view_deg: float | None
) -> Goal:
    """Read, check and decode the request's picture and have its features extracted.

    A photo is located as well: of which field of view its features are depends on that.

    Args:
        request: holds the picture.
        gateway: the application.
        robot: whose goal it is.
        map_name: where it shall lie.
        field_of_view_deg: over the longer side of a photo, as the sender says.

    Raises:
        ProblemError: 4xx the picture cannot be a goal, 503/504 nobody extracts its features.
    """
    header, picture = await _picture(request, gateway, robot, field_of_view_deg)
    if isinstance(picture, Photo):
        found = await locate_photo(gateway, robot, map_name, picture)
        return Goal(header, found.features, found)
    question = ExtractRequest(frame=picture)
    timeout_s = gateway.settings.compute_timeout_s
    return Goal(header, await gateway.asker.ask("features", EXTRACT, question, timeout_s))


async def _picture(
    request: Request, gateway: Gateway, robot: str, field_of_view_deg: float | None
) -> tuple[PictureHeader, Frame | Photo]:
    settings = gateway.settings
    try:
        with gateway.uploads.hold(person_of(request).client):
            limit_bytes, timeout_s = settings.max_upload_bytes, settings.upload_timeout_s
            data, declared_type = await read_picture(request, limit_bytes, timeout_s)
            header = check_file(data, declared_type)
            if is_photo(header, fov_told=field_of_view_deg is not None):
                picture: Frame | Photo = await gateway.work(
                    lambda: decode_photo(data, header, field_of_view_deg)
                )
            else:
                check_panorama(header)
                picture = await gateway.work(lambda: _frame(data, header, robot))
    except ProblemError as error:
        gateway.metrics.refused.labels(error.code).inc()
        raise
    gateway.metrics.uploads.labels(header.format).inc()
    return header, picture


def _frame(data: bytes, header: PictureHeader, robot: str) -> Frame:
    bgr = decode_bgr(data, header)
    height_px, width_px, _ = bgr.shape
    return Frame(robot=robot, encoding="bgr8", width_px=width_px, height_px=height_px, data=bgr.tobytes())
