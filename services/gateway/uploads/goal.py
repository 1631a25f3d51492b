"""From an uploaded picture to its features: what goal check and goto have in common."""

from dataclasses import dataclass

from fastapi import Request

from services.gateway.auth.guard import person_of
from services.gateway.http.bodies import read_picture
from services.gateway.state import Gateway
from services.gateway.uploads.picture import check_header, decode_bgr
from services.gateway.uploads.picture_header import PictureHeader
from shared.messages.features import ExtractRequest, Features
from shared.messages.sensors import Frame
from shared.topics import EXTRACT
from shared.web.problems import ProblemError


@dataclass(frozen=True)
class Goal:
    """An uploaded picture as the other services know it."""

    header: PictureHeader
    features: Features


async def goal_of(request: Request, gateway: Gateway, robot: str) -> Goal:
    """Read, check and decode the request's picture and have its features extracted.

    Raises:
        ProblemError: 4xx the picture cannot be a goal, 503/504 nobody extracts its features.
    """
    settings = gateway.settings
    try:
        with gateway.uploads.hold(person_of(request).client):
            limit_bytes, timeout_s = settings.max_upload_bytes, settings.upload_timeout_s
            data, declared_type = await read_picture(request, limit_bytes, timeout_s)
            header = check_header(data, declared_type)
            frame = await gateway.work(lambda: _frame(data, header, robot))
    except ProblemError as error:
        gateway.metrics.refused.labels(error.code).inc()
        raise
    gateway.metrics.uploads.labels(header.format).inc()
    question = ExtractRequest(frame=frame)
    features = await gateway.asker.ask("features", EXTRACT, question, settings.compute_timeout_s)
    return Goal(header, features)


def _frame(data: bytes, header: PictureHeader, robot: str) -> Frame:
    bgr = decode_bgr(data, header)
    height_px, width_px, _ = bgr.shape
    return Frame(robot=robot, encoding="bgr8", width_px=width_px, height_px=height_px, data=bgr.tobytes())
