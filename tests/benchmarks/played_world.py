"""A world that a suite played in: its map as the feature service has it, and true poses of its nodes."""

from services.features.map_features.map_features import MapFeatures
from services.features.matching.requests import look_at_nodes, match_candidates, verify_candidates
from services.launcher.evaluation.truth_file import load_truth
from services.map_store.storage.archive import Archive
from services.map_store.storage.blobs import unpack_features
from shared.mapgraph.graph import MapGraph
from shared.messages.matching import MatchRequest

MOST_BYTES = 10**9


class PlayedWorld:
    """Pictures against its map, as the planner has them from the feature service."""

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

    def found(self, goal, node_ids=(), best_k=0, targets=()):
        request = MatchRequest(map="map", node_ids=tuple(node_ids), best_k=best_k, targets=tuple(targets))
        raw = match_candidates(self._pipeline, request, goal, self._nodes)
        results = verify_candidates(self._pipeline, request, raw)
        looked = look_at_nodes(
            results, node_ids, goal.thumbnail, lambda some: {n: self._pictures[n] for n in some}
        )
        return {match.node_id: match for match in looked}
