"""The feature service's answers, worked out in this process."""

from collections.abc import Sequence

from experiments.topological_navigation.memory_map import MemoryMap
from services.features.map_features.map_features import MapFeatures
from services.features.matching.requests import match_candidates, verify_candidates
from services.features.pipeline.pipeline import Pipeline
from shared.messages.features import Features
from shared.messages.matching import MatchRequest, NodeMatch

NAME = "library"


class LocalMatcher:
    """Compares the current frame, set before each step, with the places of a map."""

    def __init__(self, pipeline: Pipeline, maps: MemoryMap) -> None:
        self._pipeline, self._maps = pipeline, maps
        self._places = MapFeatures.of(pipeline)
        self.current: Features | None = None

    def match(
        self, node_ids: Sequence[int], best_k: int = 0, targets: Sequence[Features] = ()
    ) -> dict[int, NodeMatch]:
        """Matches of the current frame by node id, most similar first."""
        if self.current is None:
            raise ValueError("set current_frame first: there is nothing to compare")
        ids = tuple(n for n in node_ids if n >= 0)
        return self._ask(
            self.current, MatchRequest(map=NAME, node_ids=ids, best_k=best_k, targets=tuple(targets))
        )

    def locate(
        self,
        features: Features,
        best_k: int,
        node_ids: Sequence[int] = (),
        *,
        with_differences: bool = False,  # noqa: ARG002 - the thesis's rules look at no pictures
    ) -> dict[int, NodeMatch]:
        """Matches of any picture with given nodes, and with the most similar ones of the map."""
        return self._ask(features, MatchRequest(map=NAME, best_k=best_k, node_ids=tuple(node_ids)))

    def _ask(self, features: Features, request: MatchRequest) -> dict[int, NodeMatch]:
        for node_id, found in self._maps.features.items():
            if node_id not in self._places:
                self._places.put(node_id, found)
        raw = match_candidates(self._pipeline, request, features, self._places)
        return {m.node_id: m for m in verify_candidates(self._pipeline, request, raw)}
