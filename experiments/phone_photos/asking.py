"""Where the core says that a photo was taken, by a map on disk, without a stack."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from services.features.map_features.map_features import MapFeatures
from services.features.map_features.pictured import PicturedNodes
from services.features.matching.requests import match_candidates, verify_candidates
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.launcher.client.failure import ExperimentError
from services.map_store.errors import MapError
from services.map_store.storage.database import Database
from services.map_store.store import MapStore
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.photographs.photo_matches import PHOTO_NODES, photo_matches
from shared.mapgraph.photographs.verdict import PhotoAnswer, located
from shared.messages.features import Photo
from shared.messages.matching import MatchRequest

DATABASE = "maps/maps.sqlite3"
"""Of a data folder."""
SEED = 0
"""Of the draws of an answer, as the gateway's."""


@dataclass(frozen=True)
class KnownMap:
    """A map with the features of its nodes, and the pipeline that made them.

    Attributes:
        pictured: the same nodes as photos are compared with them.
    """

    graph: MapGraph
    features: MapFeatures
    pictured: PicturedNodes
    pipeline: Pipeline


def read_map(data_dir: Path, name: str, profile: str = "sift") -> KnownMap:
    """Read a map of a data folder.

    Raises:
        ExperimentError: there is none.
    """
    path = data_dir / DATABASE
    if not path.exists():
        raise ExperimentError(f"no maps in {data_dir}: run 'topnav explore' there first")
    database = Database(f"sqlite:///{path}")
    try:
        store = MapStore(database, lambda: 0, lambda _: None)
        _, stored = store.recorded_graph(name)
        _, nodes = store.contents.features(name, ())
        _, pictures = store.contents.pictures(name, ())
    except MapError as error:
        raise ExperimentError(f"map {name!r} of {data_dir}: {error}") from None
    finally:
        database.close()
    pipeline = Pipeline(find_profile(profile))
    features = MapFeatures.of(pipeline)
    for node in nodes:
        features.put(node.node_id, node.features)
    pictured = PicturedNodes(pipeline)
    for shown in pictures:
        pictured.put(shown.node_id, shown.picture)
    graph = MapGraph([each.node for each in stored.nodes.values()], stored.edges.values())
    return KnownMap(graph, features, pictured, pipeline)


def ask(known: KnownMap, name: str, photo: Photo) -> PhotoAnswer:
    """Locate a photo, as the gateway does: once more where its field of view had to be found."""
    answer = _ask(known, name, photo)
    again = answer.looked_again(photo.view)
    if again is None:
        return answer
    second = _ask(known, name, photo.model_copy(update={"view": again}))
    return max(answer, second, key=lambda each: each.score)


def _ask(known: KnownMap, name: str, photo: Photo) -> PhotoAnswer:
    features = known.pipeline.features_of_photo(photo)
    request = MatchRequest(map=name, features=features, best_k=PHOTO_NODES)
    raw = match_candidates(known.pipeline, request, features, known.features, lambda _: known.pictured.nodes)
    matches = photo_matches(photo.view, verify_candidates(known.pipeline, request, raw))
    return located(known.graph, matches, np.random.default_rng(SEED))
