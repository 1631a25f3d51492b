"""Feature service: the Zenoh loop around `pipeline` and `matching`. One thread does everything."""

import logging
import time
from collections.abc import Sequence
from functools import partial
from threading import Event

import cv2

from services.features.changes.visits import compare_with
from services.features.frame_cache import FrameKey
from services.features.freed_memory import keep_freed_memory
from services.features.map_features.map_cache import CachedMap, MapCache
from services.features.map_features.map_features import MapFeatures
from services.features.map_features.map_reader import MapReader
from services.features.map_features.pictured import PicturedNodes
from services.features.matching.requests import (
    FrameNotKeptError,
    NotReadyError,
    RequestError,
    look_at_nodes,
    match_candidates,
    verify_candidates,
)
from services.features.pipeline.pipeline import Pipeline
from services.features.robot_streams import RobotStreams
from services.features.settings import FeaturesSettings
from shared.bus import Bus, Request
from shared.jpeg import BadPictureError
from shared.messages.features import ExtractPhotoRequest, ExtractRequest, Features
from shared.messages.inspections import CompareReply, CompareRequest
from shared.messages.matching import MatchReply, MatchRequest
from shared.messages.sensors import Frame
from shared.topics import EXTRACT, EXTRACT_PHOTO

log = logging.getLogger(__name__)

LOOKING_S, LOOKED_AT = 1.0, 4
"""For how long pictures are looked at for one question, and how many are read at once; chosen: each takes a
tenth of a second, once."""
IDLE_S = 0.5
"""How soon it notices that it is to end; whatever arrives wakes it before."""


class FeatureService:
    """Extracts the newest frame of each robot and answers questions, in turn."""

    def __init__(self, settings: FeaturesSettings, bus: Bus) -> None:
        cv2.setNumThreads(settings.threads)
        self._bus = bus
        thumbnail = settings.thumbnail_width_px, settings.thumbnail_quality
        self._pipeline = Pipeline(settings.profile(), *thumbnail, settings.runtime())
        self._maps = MapReader(bus, MapCache(self._no_nodes), settings.map_timeout_s)
        self._robots = tuple(RobotStreams.open(bus, name, settings.frames_kept) for name in settings.served)
        self._extracts = bus.requests(EXTRACT)
        self._photos = bus.requests(EXTRACT_PHOTO)

    def work(self) -> None:
        """Handle everything that has arrived."""
        while any([self._step(robot) for robot in self._robots]):  # a list: every robot has its turn
            pass

    def _step(self, robot: RobotStreams) -> bool:
        """One of each kind: on a machine too slow for all frames, questions must have their turn too."""
        self._maps.follow()
        if (frame := robot.frames.take()) is not None:
            self._on_frame(robot, frame)
        for early in robot.early.due(robot.kept):
            self._on_match(robot, early)
        if (match := robot.matches.take()) is not None and not robot.early.keep(match, robot.kept):
            self._on_match(robot, match)
        if (comparison := robot.comparisons.take()) is not None:
            self._on_compare(robot, comparison)
        if (picture := self._extracts.take()) is not None:
            self._on_extract(picture)
        if (photo := self._photos.take()) is not None:
            self._on_photo(photo)
        return any(each is not None for each in (frame, match, comparison, picture, photo))

    def _on_frame(self, robot: RobotStreams, frame: Frame) -> None:
        key = FrameKey.of(frame)
        verdict = robot.kept.judge(key, frame.lockstep)
        if verdict == "stale":
            self._bus.counters.count("stale", f"frame {frame.seq} came after a newer one")
            return
        features = robot.kept.same(key)
        if features is None:
            try:
                features = self._extract(frame)
            except BadPictureError as error:
                self._bus.counters.count("malformed", f"frame {frame.seq}: {error}")
                return
            robot.kept.put(key, features, frame)
        robot.features.put(features)

    def _extract(self, frame: Frame) -> Features:
        start_s = time.perf_counter()
        features = self._pipeline.features_of(frame)
        return features.model_copy(update={"extract_ms": (time.perf_counter() - start_s) * 1e3})

    def _on_photo(self, request: Request[ExtractPhotoRequest, Features]) -> None:
        start_s = time.perf_counter()
        features = self._pipeline.features_of_photo(request.message.photo)
        request.reply(features.model_copy(update={"extract_ms": (time.perf_counter() - start_s) * 1e3}))

    def _on_match(self, robot: RobotStreams, request: Request[MatchRequest, MatchReply]) -> None:
        try:
            reply = self._match(robot, request.message)
        except RequestError as error:
            request.refuse(str(error), error.code)
            return
        request.reply(reply)

    def _on_compare(self, robot: RobotStreams, request: Request[CompareRequest, CompareReply]) -> None:
        seq = request.message.seq
        features, frame = robot.kept.get(seq), robot.kept.frame(seq)
        if features is None or frame is None:
            request.refuse(_not_kept(robot, seq), FrameNotKeptError.code)
            return
        try:
            reply = compare_with(self._pipeline, frame, features, request.message.reference)
        except BadPictureError as error:
            self._bus.counters.count("bad_picture", str(error))
            request.refuse(str(error))
            return
        request.reply(reply)

    def _match(self, robot: RobotStreams, request: MatchRequest) -> MatchReply:
        current = _current(robot, request)
        if request.node_ids or request.best_k:
            known = self._maps.read(request.map, request.node_ids, request.map_revision)
        else:
            known = CachedMap(0, self._no_nodes())
        start_s = time.perf_counter()
        detailed = partial(self._looked_at, request.map, known)
        raw = match_candidates(self._pipeline, request, current, known.nodes, detailed)
        matched_s = time.perf_counter()
        answered = robot.answered.of(current, known, request.with_matches)
        results = verify_candidates(self._pipeline, request, raw, answered)
        if request.with_differences:
            pictures = partial(self._pictures, request.map)
            results = look_at_nodes(results, request.node_ids, current.thumbnail, pictures)
        return MatchReply(
            seq=current.seq,
            stamp_ns=current.stamp_ns,
            map=request.map,
            map_revision=known.revision,
            pipeline=self._pipeline.identity,
            max_similarity=self._pipeline.profile.keypoints,
            results=results,
            match_ms=(matched_s - start_s) * 1e3,
            verify_ms=(time.perf_counter() - matched_s) * 1e3,
        )

    def _pictures(self, name: str, node_ids: Sequence[int]) -> dict[int, bytes]:
        """Pictures of nodes; none where the store does not answer: matches are of use without them."""
        try:
            return self._maps.pictures(name, node_ids)
        except RequestError as error:
            log.info("nodes %s are not compared as pictures: %s", list(node_ids), error)
            return {}

    def _looked_at(self, name: str, known: CachedMap, node_ids: Sequence[int]) -> MapFeatures:
        """Nodes as photos are compared with them; frames have their turn while that takes long."""
        pictured = known.pictured = known.pictured or PicturedNodes(self._pipeline)
        missing, until_s = pictured.missing(node_ids), time.monotonic() + LOOKING_S
        while missing and time.monotonic() < until_s:
            piece, missing = missing[:LOOKED_AT], missing[LOOKED_AT:]
            for node_id, picture in self._maps.pictures(name, piece).items():
                pictured.put(node_id, picture)
        if missing:
            raise NotReadyError(f"{len(missing)} pictures of map {name!r} have to be looked at: ask again")
        return pictured.nodes

    def _no_nodes(self) -> MapFeatures:
        return MapFeatures.of(self._pipeline)

    def _on_extract(self, request: Request[ExtractRequest, Features]) -> None:
        try:
            features = self._extract(request.message.frame)
        except BadPictureError as error:
            self._bus.counters.count("bad_picture", str(error))
            request.refuse(str(error))
            return
        request.reply(features)


def _current(robot: RobotStreams, request: MatchRequest) -> Features:
    if request.features is not None:
        return request.features
    features = robot.kept.get(request.seq)
    if features is None:
        raise FrameNotKeptError(_not_kept(robot, request.seq))
    return features


def _not_kept(robot: RobotStreams, seq: int) -> str:
    what = "has not come" if robot.kept.is_ahead(seq) else "is not kept"
    return f"frame {seq} {what} (kept: {robot.kept.span()}): ask about the newest one"


def run(settings: FeaturesSettings, bus: Bus, stop: Event) -> None:
    """Serve until `stop` is set."""
    keep_freed_memory()
    service = FeatureService(settings, bus)
    bus.announce("features")
    log.info("ready, pipeline %s, robots %s", settings.profile().identity, ", ".join(settings.served))
    while not stop.is_set():
        service.work()
        bus.wait(IDLE_S)
