"""What was read at a node becomes part of its map."""

import logging
from collections.abc import Sequence

from services.signs.reading import Reading
from shared.bus import Bus
from shared.mapgraph.marks import by_key
from shared.mapgraph.signs import joined
from shared.messages.maps import MapRequest
from shared.messages.places import PutSign, Sighting, Sign, key_of
from shared.queries import RefusedError
from shared.topics import MAP

log = logging.getLogger(__name__)

AUTHOR = "signs"
WRITE_TRIES = 10
"""While a robot explores it writes to the same map: it may come first a few times in a row."""


def sign_of(node_id: int, reading: Reading) -> Sign:
    """A reading at a node as a sign that is read from there."""
    sighting = Sighting(
        node=node_id,
        bearing_rad=reading.longitude_rad,
        height_rad=reading.height_rad,
        confidence=reading.confidence,
    )
    return Sign(name=reading.text, sightings=(sighting,))


def keep(bus: Bus, map_name: str, node_id: int, found: Sequence[Reading], timeout_s: float) -> bool:
    """Write what was read from a node into its map; whether the node is still there.

    Raises:
        QueryError: the map store is away, or refuses: no such map, no room for more signs.
    """
    for left in reversed(range(WRITE_TRIES)):
        known = bus.ask(MAP, MapRequest(action="read"), timeout_s, map=map_name)
        if not any(node.node_id == node_id for node in known.nodes):
            return False
        signs = by_key(known.signs)
        for reading in found:
            new = sign_of(node_id, reading)
            signs[key_of(new.name)] = joined(signs.get(key_of(new.name)), new)
        operations = tuple(PutSign(sign=signs[key]) for key in {key_of(one.text): None for one in found})
        request = MapRequest(
            action="transact", operations=operations, author=AUTHOR, base_revision=known.revision
        )
        try:
            bus.ask(MAP, request, timeout_s, map=map_name)
        except RefusedError as error:
            if error.code != "conflict" or not left:
                raise
        else:
            return True
    raise AssertionError("the last try returns or raises")
