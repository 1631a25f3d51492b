"""Which of the places that look alike is the likeliest, by matches and by pictures of nodes; gates nothing.

SUITE=runs/dev WORLDS=hotel-1-small,hostel-0-small pytest -q -s tests/benchmarks/test_likeliest_places.py

SUITE is what `topnav suite generated --data-dir SUITE` keeps of its worlds: their files, maps and true poses.
Goal pictures are rendered up to half a metre from nodes (decision 0033).
"""

import math
import os
from pathlib import Path

import numpy as np
import pytest

from experiments.rendered.frames import tilting_camera
from services.features.map_features.map_features import MapFeatures
from services.features.matching.requests import look_at_nodes, match_candidates, verify_candidates
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.launcher.evaluation.truth_file import load_truth
from services.map_store.storage.archive import Archive
from services.map_store.storage.blobs import unpack_features
from services.planner.goals.candidates import Candidates
from services.planner.profiles import DEFAULT
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.hypotheses import COMPARED_NODES
from shared.messages.matching import MatchRequest
from shared.messages.simulation import Pose
from simulator.sensors.attitude import LEVEL
from simulator.world.world_file import load_world
from tests.unit.services.planner.travel.seen import Maps

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3600)]

WORLDS = [name for name in os.environ.get("WORLDS", "").split(",") if name]
GOALS, BESIDE_M, ITS_OWN_M, MOST_BYTES = 60, (0.1, 0.5), 1.0, 10**9


class Located:
    """Goal pictures against the map of a world, as the planner has them from the feature service."""

    def __init__(self, folder, name, pipeline):
        with (folder / name / "map.zip").open("rb") as file:
            archive = Archive(file, MOST_BYTES)
            stored = {each.node.node_id: each for each in archive.index.places}
            features = {n: unpack_features(archive.blob(each.features)) for n, each in stored.items()}
            self._pictures = {n: archive.blob(each.thumbnail) for n, each in stored.items()}
            self.graph = MapGraph([each.node for each in stored.values()], archive.index.edges)
        self.poses = load_truth(folder / name / "truth.json").poses
        self._pipeline, self._nodes = pipeline, MapFeatures.of(pipeline)
        for node, each in features.items():
            self._nodes.put(node, each)

    def found(self, goal, node_ids=(), best_k=0):
        request = MatchRequest(map="map", node_ids=tuple(node_ids), best_k=best_k)
        raw = match_candidates(self._pipeline, request, goal, self._nodes)
        results = verify_candidates(self._pipeline, request, raw)
        looked = look_at_nodes(
            results, node_ids, goal.thumbnail, lambda some: {n: self._pictures[n] for n in some}
        )
        return {match.node_id: match for match in looked}

    def is_right(self, place, goal):
        return any(math.dist(goal, (self.poses[n].x_m, self.poses[n].y_m)) < ITS_OWN_M for n in place.nodes)


@pytest.mark.parametrize("name", WORLDS)
def test_how_often_the_likeliest_place_is_the_goals(name, keep):
    folder, pipeline = Path(os.environ["SUITE"]) / name, Pipeline(find_profile("sift"))
    located, rng = Located(folder, name, pipeline), np.random.default_rng(1)
    camera = tilting_camera(load_world(str(folder / f"{name}.yaml")))
    figures = {"goals": 0, "places": 0, "by_matches": 0, "by_pictures": 0, "unlikely": 0, "unlikely_right": 0}
    for _ in range(int(os.environ.get("GOALS", GOALS))):
        node = located.poses[int(rng.choice(sorted(located.poses)))]
        angle, far_m = rng.uniform(0.0, math.tau), rng.uniform(*BESIDE_M)
        at = node.x_m + far_m * math.cos(angle), node.y_m + far_m * math.sin(angle)
        goal = pipeline.features_of(camera(Pose(x_m=at[0], y_m=at[1], yaw_rad=rng.uniform(-3.0, 3.0)), LEVEL))
        candidates = Candidates(Maps(located.graph), located.found(goal, best_k=COMPARED_NODES), DEFAULT)
        if candidates.plain or len(candidates.places) < 2:
            continue
        figures["goals"] += 1
        figures["places"] += len(candidates.places)
        figures["by_matches"] += located.is_right(candidates.places[0], at)
        candidates.look(located.found(goal, candidates.to_look_at()))
        figures["by_pictures"] += located.is_right(candidates.places[0], at)
        figures["unlikely"] += len(candidates.unlikely)
        figures["unlikely_right"] += sum(located.is_right(place, at) for place in candidates.unlikely)
    keep(figures)
