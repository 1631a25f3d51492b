"""Ordinary photos from files, and where in a map they were taken, asked over the bus."""

import math
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

from services.launcher.client.failure import ExperimentError
from shared.bus import Bus
from shared.geometry.photo.exif import read_facts, upright
from shared.geometry.photo.plane import USUAL_RAD
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.photographs.photo_matches import LOOKING_S, PHOTO_NODES, photo_matches
from shared.mapgraph.photographs.verdict import PhotoAnswer, located
from shared.messages.features import MAX_PHOTO_PX, ExtractPhotoRequest, Features, Photo, PhotoView
from shared.messages.maps import MapReply
from shared.messages.matching import MatchReply, MatchRequest
from shared.queries import RefusedError
from shared.topics import EXTRACT_PHOTO, MATCH

TIMEOUT_S = 60.0
"""A learned extractor takes seconds for its first picture, a busy machine as many to match sixty nodes."""
MIN_SHORT_PX = 200
"""Of the shorter side: as the gateway's."""
SEED = 0
"""Of the draws of an answer: one question, one answer."""


@dataclass(frozen=True)
class LocatedPhoto:
    """Where a photo was taken, and its features as a mission wants them."""

    answer: PhotoAnswer
    features: Features


def photo_from_file(path: Path, field_of_view_deg: float | None) -> Photo:
    """Read a photo, turned as its EXIF says.

    Raises:
        ExperimentError: not a picture, or too small.
    """
    try:
        with Image.open(path) as image:
            facts = read_facts(image)
            image.draft("RGB", (MAX_PHOTO_PX, MAX_PHOTO_PX))
            image.thumbnail((MAX_PHOTO_PX, MAX_PHOTO_PX), Image.Resampling.BOX)
            pixels = upright(np.asarray(image.convert("RGB"), np.uint8)[:, :, ::-1], facts.orientation)
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise ExperimentError(f"{path} is not a picture that can be read: {error}") from error
    height_px, width_px, _ = pixels.shape
    if min(width_px, height_px) < MIN_SHORT_PX:
        needed = f"a photo needs {MIN_SHORT_PX} on each side: take a larger one"
        raise ExperimentError(f"{path} has {width_px} x {height_px} px, {needed}")
    fov_rad = facts.fov_rad if field_of_view_deg is None else math.radians(field_of_view_deg)
    view = PhotoView(fov_rad=fov_rad or USUAL_RAD, fov_known=fov_rad is not None, aspect=width_px / height_px)
    return Photo(view=view, width_px=width_px, height_px=height_px, data=pixels.tobytes())


def locate_photo(bus: Bus, robot: str, known: MapReply, photo: Photo) -> LocatedPhoto:
    """Where in a map a photo was taken; asked once more where its field of view had to be found first."""
    first = _asked(bus, robot, known, photo)
    again = first.answer.looked_again(photo.view)
    if again is None:
        return first
    second = _asked(bus, robot, known, photo.model_copy(update={"view": again}))
    return max(first, second, key=lambda looked: looked.answer.score)


def _asked(bus: Bus, robot: str, known: MapReply, photo: Photo) -> LocatedPhoto:
    features = bus.ask(EXTRACT_PHOTO, ExtractPhotoRequest(photo=photo), TIMEOUT_S)
    question = MatchRequest(map=known.map, features=features, best_k=PHOTO_NODES)
    reply = _matched(bus, robot, question)
    graph, matches = MapGraph(known.nodes, known.edges), photo_matches(photo.view, reply.results)
    return LocatedPhoto(located(graph, matches, np.random.default_rng(SEED)), features)


def _matched(bus: Bus, robot: str, question: MatchRequest) -> MatchReply:
    """The photo's matches; the first photo of a map waits until its nodes' pictures were looked at."""
    until_s = time.monotonic() + LOOKING_S
    while True:
        try:
            return bus.ask(MATCH, question, TIMEOUT_S, robot=robot)
        except RefusedError as error:
            if error.code != "busy" or time.monotonic() > until_s:
                raise
