"""One merge: match all nodes of the other map, choose the edges across, write it all in one transaction."""

import itertools
import logging
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Self

from services.map_store.errors import MapError
from services.map_store.merging.progress import CancelledError, MergeAnswer, Progress
from services.map_store.storage.catalogue import MapRecord
from services.map_store.storage.graph import AddStoredNode, Graph, Step
from services.map_store.store import MapStore
from shared.mapgraph.marks import free_names, renumbered
from shared.mapgraph.merging.candidates import Candidate, MergeRefusedError
from shared.mapgraph.merging.choice import choose
from shared.mapgraph.merging.joining import check_size, joined_edges, new_ids
from shared.mapgraph.merging.sight_graph import SightGraph
from shared.mapgraph.signs import joined
from shared.messages.features import Features
from shared.messages.maps import PutEdge
from shared.messages.matching import MatchReply, MatchRequest, NodeMatch
from shared.messages.places import PutPlace, PutRoute, PutRule, PutSign
from shared.queries import QueryError, RefusedError
from shared.wire import WireError

log = logging.getLogger(__name__)

BEST_K = 5
"""Nodes of the base map that are verified for each node of the other: a neighbour must support each edge, and
some of the five may only look alike."""
CHUNK = 32
"""Nodes whose features are read at once: 5 MB of 300 SIFT descriptors each."""

Matcher = Callable[[MatchRequest], MatchReply]
"""Asks the feature service; raises QueryError and WireError."""


@dataclass(frozen=True)
class ReadMap:
    """One revision of a map: its record, as it is stored, and as merging reads it."""

    record: MapRecord
    stored: Graph
    graph: SightGraph

    @classmethod
    def newest(cls, store: MapStore, name: str) -> Self:
        """The newest revision; raises MapError."""
        record, stored = store.recorded_graph(name)
        nodes = [node.node for node in stored.nodes.values()]
        return cls(record, stored, SightGraph(nodes, stored.edges.values()))

    @property
    def name(self) -> str:
        """What the map is called."""
        return self.record.name


class Merge:
    """Adds `other` to `base` in the name of `author`; `progress` says where that stands."""

    def __init__(self, store: MapStore, match: Matcher, base: ReadMap, other: ReadMap, author: str) -> None:
        self._store, self._match, self._author = store, match, author
        self._base, self._other = base, other
        graph = other.graph
        self.progress = Progress(
            MergeAnswer(map=base.name, other=other.name, nodes=len(graph.nodes), edges=len(graph.edges))
        )

    def run(self) -> None:
        """Carry it out, on a thread of its own; what goes wrong is told by `progress`."""
        end = self.progress.end
        try:
            self._run()
        except CancelledError:
            return
        except (MergeRefusedError, MapError) as error:
            end("refused", str(error))
        except RefusedError as error:
            end("refused", f"the feature service refused: {error}")
        except (QueryError, WireError) as error:
            end("failed", f"no answer of the feature service: {error}")
        except Exception:  # of whatever kind: nobody waits for this thread, so the answer must say it
            log.exception("merge into %s failed", self._base.name)
            end("failed", "an error in the map store: see its log; the map's history says what was written")

    def _run(self) -> None:
        check_size(self._other.graph)
        chosen = choose(self._base.graph, self._other.graph, self._match_all())
        steps = self._steps(chosen)
        self.progress.advance(state="writing", cross_edges=len(chosen))
        self._store.add_stored(self._base.record, steps, self._author)
        self.progress.end("done")

    def _match_all(self) -> dict[int, tuple[NodeMatch, ...]]:
        """Matches with the base map by node of the other map."""
        matches: dict[int, tuple[NodeMatch, ...]] = {}
        waiting = iter(sorted(self._other.graph.nodes))
        while chunk := list(itertools.islice(waiting, CHUNK)):
            for node_id, features in self._features(chunk).items():
                matches[node_id] = self._matches(features)
                self.progress.advance(matched=len(matches))
        return matches

    def _features(self, node_ids: list[int]) -> dict[int, Features]:
        name = self._other.name
        record, found = self._store.contents.features(name, node_ids)
        if record != self._other.record:
            raise MergeRefusedError(f"map {name!r} was changed while it was read: try again")
        features = {part.node_id: part.features for part in found}
        if missing := sorted(set(node_ids) - features.keys()):
            raise MergeRefusedError(
                f"map {name!r}: the features of node {missing[0]} are damaged: delete it or import a backup"
            )
        return features

    def _matches(self, features: Features) -> tuple[NodeMatch, ...]:
        """The best matches of one node with the base map as it was read."""
        name, revision = self._base.name, self._base.record.revision
        wish = MatchRequest(
            map=name, map_revision=revision, features=features, best_k=BEST_K, with_matches=False
        )
        reply = self._match(wish)
        if reply.map_revision > revision:
            raise MergeRefusedError(f"map {name!r} was changed while it was matched: try again")
        return reply.results

    def _steps(self, chosen: Sequence[Candidate]) -> tuple[Step, ...]:
        """The other map's nodes with the blobs they have, then all edges."""
        ids = new_ids(self._base.graph, self._other.graph)
        edges = joined_edges(self._other.graph, ids, chosen)
        steps: list[Step] = []
        for old, new in ids.items():
            stored = self._other.stored.nodes[old]
            node = stored.node.model_copy(update={"node_id": new})
            steps.append(AddStoredNode(place=stored.model_copy(update={"node": node})))
        steps += [PutEdge(edge=edge) for edge in edges]
        return (*steps, *self._marks(ids))

    def _marks(self, ids: Mapping[int, int]) -> Iterator[Step]:
        """The other map's marks; a name that is taken gets that map's behind it, but signs are joined."""
        base, other = self._base.stored, self._other.stored
        names = free_names(other.places, base.places, self._other.name)
        for key, place in other.places.items():
            yield PutPlace(place=renumbered(place, ids, names[key], names))
        called = free_names(other.rules, base.rules, self._other.name)
        for key, rule in other.rules.items():
            yield PutRule(rule=renumbered(rule, ids, called[key], names))
        known = free_names(other.routes, base.routes, self._other.name)
        for key, route in other.routes.items():
            yield PutRoute(route=renumbered(route, ids, known[key], names))
        for key, sign in other.signs.items():
            yield PutSign(sign=joined(base.signs.get(key), renumbered(sign, ids, sign.name, names)))
