"""REST: add the nodes of another map to one, with edges where both saw the same."""

from collections.abc import Sequence

from fastapi import APIRouter, Response
from fastapi.params import Depends
from pydantic import BaseModel, ConfigDict

from services.map_store.api.names import Author, MapName
from services.map_store.api.problems import MergeProblemError
from services.map_store.errors import MissingError
from services.map_store.merging.merge import Merge, ReadMap
from services.map_store.merging.merges import Merges
from services.map_store.merging.progress import MergeAnswer
from services.map_store.store import MapStore
from shared.transport.keys import NAME

UNSIGNED = "gateway"
"""Who stands in the history where a request does not say: merges are asked for through the gateway."""


class StartMerge(BaseModel):
    """What to merge into a map: the name of another."""

    model_config = ConfigDict(extra="forbid")

    other: str


def build(store: MapStore, merges: Merges, write: Sequence[Depends]) -> APIRouter:
    """Routes /maps/{map}/merge; `write` guards those that change something."""
    router = APIRouter(prefix="/maps/{map}/merge", tags=["merging"])

    @router.post("", status_code=202, dependencies=write)
    def start_merge(
        name: MapName, wish: StartMerge, response: Response, author: Author = UNSIGNED
    ) -> MergeAnswer:
        """Start adding another map to this one; it takes about as long as matching all of its nodes."""
        if not NAME.match(wish.other):
            expected, got = "a name as /openapi.json describes it", wish.other[:80]
            raise MergeProblemError(422, "invalid_request", expected, got, "name a map")
        if wish.other == name:
            raise MergeProblemError(422, "same_map", "two maps", f"{name} twice", "name another map")
        base, other = _read(store, name), _read(store, wish.other)
        _check_pipelines(base, other)
        merge = merges.start(base, other, author)
        if merge is None:
            raise _busy(merges)
        response.headers["Location"] = f"/maps/{name}/merge"
        return merge.progress.answer

    @router.get("")
    def show_merge(name: MapName) -> MergeAnswer:
        """The running or last merge into a map."""
        return _last(merges, name).progress.answer

    @router.delete("", dependencies=write)
    def cancel_merge(name: MapName) -> MergeAnswer:
        """Cancel the running merge into a map; nothing is written then."""
        progress = _last(merges, name).progress
        if not progress.cancel():
            expected, got = "a merge that is still matching", "one that is being written"
            raise MergeProblemError(409, "merge_writing", expected, got, "undo it when it is done")
        return progress.answer

    return router


def _read(store: MapStore, name: str) -> ReadMap:
    try:
        return ReadMap.newest(store, name)
    except MissingError:
        raise MergeProblemError(
            404, "unknown_map", "the name of a map", name, "see the list of maps"
        ) from None


def _check_pipelines(base: ReadMap, other: ReadMap) -> None:
    used = sorted({node.pipeline for read in (base, other) for node in read.graph.nodes.values()})
    if len(used) > 1:
        next_step = "map one of the places again with the other's pipeline"
        raise MergeProblemError(
            409, "pipelines_differ", "maps made by one pipeline", ", ".join(used), next_step
        )


def _busy(merges: Merges) -> MergeProblemError:
    running = merges.running
    got = (
        "another"
        if running is None
        else "{other} is being merged into {map}".format(**vars(running.progress.answer))
    )
    return MergeProblemError(
        409, "merge_running", "no other merge at the same time", got, "wait for it or cancel it"
    )


def _last(merges: Merges, name: str) -> Merge:
    merge = merges.last(name)
    if merge is None:
        expected = "a map that another was merged into"
        got = f"no merge into {name} since the map store started"
        raise MergeProblemError(404, "no_merge", expected, got, "start one with POST")
    return merge
