"""Maps read whole for a merge: graphs and features over the bus, thumbnails over REST."""

from collections.abc import Sequence
from dataclasses import dataclass

from services.gateway.http.map_store_proxy import fetch
from services.gateway.merging.core.candidates import MergeRefusedError
from services.gateway.merging.core.places import Places
from services.gateway.state import Gateway
from shared.messages.features import Features
from shared.messages.maps import MapReply, MapRequest
from shared.topics import MAP
from shared.web.problems import ProblemError


@dataclass(frozen=True)
class ReadMap:
    """One revision of a map without what its places look like."""

    name: str
    revision: int
    places: Places


async def read_map(gateway: Gateway, name: str) -> ReadMap:
    """Places and connections of a map.

    Raises:
        ProblemError: 404 no such map, or the map store did not answer.
    """
    if await fetch(gateway.store, f"/maps/{name}") is None:
        raise ProblemError(
            404, "unknown_map", expected="the name of a map", got=name, next_step="see /api/maps"
        )
    reply = await ask_store(gateway, name, MapRequest(action="read"))
    return ReadMap(name, reply.revision, Places(reply.nodes, reply.edges))


async def read_features(gateway: Gateway, source: ReadMap, node_ids: Sequence[int]) -> dict[int, Features]:
    """What places look like, thumbnails not included, by place.

    Raises:
        MergeRefusedError: the map changed since `source` was read, or features are damaged.
        ProblemError: the map store did not answer.
    """
    wish = MapRequest(action="read_features", node_ids=tuple(node_ids))
    reply = await ask_store(gateway, source.name, wish)
    if reply.revision != source.revision:
        raise MergeRefusedError(f"map {source.name!r} was changed while it was read: try again")
    found = {part.node_id: part.features for part in reply.features}
    if missing := sorted(set(node_ids) - found.keys()):
        raise MergeRefusedError(
            f"map {source.name!r}: the features of node {missing[0]} are damaged: "
            "delete it or import a backup"
        )
    return found


async def with_thumbnail(gateway: Gateway, source: ReadMap, node_id: int, features: Features) -> Features:
    """The features together with the place's thumbnail, which the store keeps apart.

    Raises:
        ProblemError: the map store did not answer.
    """
    picture = await fetch(gateway.store, f"/maps/{source.name}/nodes/{node_id}/thumbnail")
    return features.model_copy(update={"thumbnail": picture}) if picture else features


async def ask_store(gateway: Gateway, name: str, wish: MapRequest) -> MapReply:
    """Ask about map `name`; whole maps may take longer than a question usually does."""
    timeout_s = gateway.settings.compute_timeout_s
    return await gateway.asker.ask("map_store", MAP, wish, timeout_s, map=name)
