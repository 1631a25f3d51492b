"""Where in the map a photo was taken: asked twice where its field of view has to be found first."""

import time
from dataclasses import dataclass

import numpy as np

from services.gateway.state import Gateway
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.photographs.photo_matches import LOOKING_S, PHOTO_NODES, photo_matches
from shared.mapgraph.photographs.verdict import PhotoAnswer, located
from shared.messages.features import ExtractPhotoRequest, Features, Photo
from shared.messages.maps import MapReply, MapRequest
from shared.messages.matching import MatchReply, MatchRequest
from shared.topics import EXTRACT_PHOTO, MAP, MATCH
from shared.web.problems import ProblemError

SEED = 0
"""Of the draws of an answer: one question, one answer."""


@dataclass(frozen=True)
class LocatedPhoto:
    """A photo's answer, with the features and matches that it rests on."""

    answer: PhotoAnswer
    features: Features
    reply: MatchReply


async def locate_photo(gateway: Gateway, robot: str, map_name: str, photo: Photo) -> LocatedPhoto:
    """Locate a photo in a map.

    Raises:
        ProblemError: no such map, or a service is away.
    """
    timeout_s = gateway.settings.compute_timeout_s
    found = await gateway.asker.ask("map_store", MAP, MapRequest(action="read"), timeout_s, map=map_name)
    first = await _asked(gateway, robot, found, photo)
    again = first.answer.looked_again(photo.view)
    if again is None:
        return first
    second = await _asked(gateway, robot, found, photo.model_copy(update={"view": again}))
    return max(first, second, key=lambda looked: looked.answer.score)


async def _asked(gateway: Gateway, robot: str, found: MapReply, photo: Photo) -> LocatedPhoto:
    timeout_s = gateway.settings.compute_timeout_s
    wish = ExtractPhotoRequest(photo=photo)
    features = await gateway.asker.ask("features", EXTRACT_PHOTO, wish, timeout_s)
    question = MatchRequest(map=found.map, features=features, best_k=PHOTO_NODES)
    reply = await _matched(gateway, robot, question)
    graph = MapGraph(found.nodes, found.edges)
    matches = photo_matches(photo.view, reply.results)
    answer = await gateway.work(lambda: located(graph, matches, np.random.default_rng(SEED)))
    return LocatedPhoto(answer, features, reply)


async def _matched(gateway: Gateway, robot: str, question: MatchRequest) -> MatchReply:
    """The photo's matches; the first photo of a map waits until its nodes' pictures were looked at."""
    timeout_s, until_s = gateway.settings.compute_timeout_s, time.monotonic() + LOOKING_S
    while True:
        try:
            return await gateway.asker_for(robot).ask("features", MATCH, question, timeout_s, robot=robot)
        except ProblemError as problem:
            if problem.members.get("reason") != "busy" or time.monotonic() > until_s:
                raise
