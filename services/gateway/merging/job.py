"""One merge: match every place of the other map, choose connections, write all of it in one transaction."""

import asyncio
import itertools
from typing import Literal

from pydantic import BaseModel

from services.gateway.merging.core.candidates import MergeRefusedError
from services.gateway.merging.core.choice import choose
from services.gateway.merging.core.operations import check_size, merged
from services.gateway.merging.reading import ReadMap, ask_store, read_features, with_thumbnail
from services.gateway.state import Gateway
from shared.messages.features import Features
from shared.messages.maps import MapRequest
from shared.messages.matching import MatchRequest, NodeMatch
from shared.topics import MAP, MATCH
from shared.web.problems import ProblemError

BEST_K = 5
CHUNK = 32
"""Places whose features are read at once."""

BYTES_MAX = MAP.max_bytes - 32_000_000
"""Features and thumbnails in one message to the map store; the rest is room for all else in it."""


class MergeAnswer(BaseModel):
    """Where a merge stands.

    Attributes:
        map: the map that grows.
        other: the map whose places it gets; it stays as it is.
        state: matching may be cancelled; done, refused (nothing was written) and failed are ends.
        matched: places of `other` compared so far.
        nodes: places of `other`.
        edges: connections of `other`.
        cross_edges: connections between the two maps, 0 until they are chosen.
        reason: why it was refused or failed.
    """

    map: str
    other: str
    state: Literal["matching", "writing", "done", "refused", "failed"]
    matched: int
    nodes: int
    edges: int
    cross_edges: int
    reason: str


class Merge:
    """Adds one map to another in the name of `author`; `answer` says where that stands."""

    def __init__(self, gateway: Gateway, base: ReadMap, other: ReadMap, author: str) -> None:
        self._gateway, self._base, self._other, self._author = gateway, base, other, author
        self.answer = MergeAnswer(
            map=base.name,
            other=other.name,
            state="matching",
            matched=0,
            nodes=len(other.places.nodes),
            edges=len(other.places.edges),
            cross_edges=0,
            reason="",
        )

    async def run(self) -> None:
        """Carry it out; what goes wrong is told in `answer`."""
        try:
            await self._merge()
        except MergeRefusedError as error:
            self._end("refused", str(error))
        except ProblemError as problem:
            self._end("refused" if problem.code == "refused" else "failed", self._told(problem))

    def fail(self) -> None:
        """Say that the gateway itself failed."""
        self._end("failed", f"an error in the gateway: see its log{self._doubt()}")

    def stop(self) -> None:
        """Say that it was cancelled, or that the gateway is stopping."""
        writing = self.answer.state == "writing"
        self._end(
            "failed" if writing else "refused",
            f"the gateway stopped{self._doubt()}" if writing else "cancelled: nothing was written",
        )

    async def _merge(self) -> None:
        base, other = self._base.places, self._other.places
        check_size(other)
        features, matches = await self._match_all()
        chosen = await asyncio.to_thread(choose, base, other, matches)
        operations = merged(base, other, features, chosen)
        self.answer = self.answer.model_copy(update={"state": "writing", "cross_edges": len(chosen)})
        wish = MapRequest(
            action="transact",
            author=self._author,
            base_revision=self._base.revision,
            operations=tuple(operations),
        )
        await ask_store(self._gateway, self._base.name, wish)
        self._end("done", "")

    async def _match_all(self) -> tuple[dict[int, Features], dict[int, tuple[NodeMatch, ...]]]:
        """Features with thumbnails and matches against the base map, by place of the other map."""
        features: dict[int, Features] = {}
        matches: dict[int, tuple[NodeMatch, ...]] = {}
        size = 0
        waiting = iter(sorted(self._other.places.nodes))
        while chunk := list(itertools.islice(waiting, CHUNK)):
            for node_id, bare in (await read_features(self._gateway, self._other, chunk)).items():
                matches[node_id] = await self._match(bare)
                features[node_id] = await with_thumbnail(self._gateway, self._other, node_id, bare)
                size += _bytes_of(features[node_id])
                self.answer = self.answer.model_copy(update={"matched": len(matches)})
            if size > BYTES_MAX:
                raise MergeRefusedError(
                    f"too large: at least {size} bytes of features, at most {BYTES_MAX} can be added "
                    "in one step"
                )
        return features, matches

    async def _match(self, features: Features) -> tuple[NodeMatch, ...]:
        """The best matches of one place with the base map as it was read."""
        gateway, base = self._gateway, self._base
        wish = MatchRequest(
            map=base.name, map_revision=base.revision, features=features, best_k=BEST_K, with_matches=False
        )
        timeout_s = gateway.settings.compute_timeout_s
        reply = await gateway.asker.ask("features", MATCH, wish, timeout_s, robot=gateway.settings.robot)
        if reply.map_revision > base.revision:
            raise MergeRefusedError(f"map {base.name!r} was changed while it was matched: try again")
        return reply.results

    def _told(self, problem: ProblemError) -> str:
        told = "expected {expected}, got {got}; {next}".format(**problem.members)
        return told if problem.code == "refused" else told + self._doubt()

    def _doubt(self) -> str:
        """What to add to a failure after which nobody here knows whether the map was changed."""
        writing = self.answer.state == "writing"
        return "; the map's history says whether it was written" if writing else ""

    def _end(self, state: Literal["done", "refused", "failed"], reason: str) -> None:
        self.answer = self.answer.model_copy(update={"state": state, "reason": reason})


def _bytes_of(features: Features) -> int:
    arrays = (features.lonlat_rad, features.scores, features.descriptors)
    return sum(array.nbytes for array in arrays) + len(features.thumbnail)
