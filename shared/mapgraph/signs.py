"""Signs that are read from several nodes: which node is best, and two readings of one sign as one. Pure."""

import unicodedata
from collections.abc import Iterable

from shared.messages.places import NAME_MAX, SIGHTINGS_MAX, Sighting, Sign


def clean(text: str) -> str:
    """Text as it may become a sign: no characters that control or hide, single spaces, bounded; maybe ""."""
    seen = (character for character in text if not unicodedata.category(character).startswith("C"))
    return " ".join(unicodedata.normalize("NFKC", "".join(seen)).split())[:NAME_MAX].strip()


def joined(known: Sign | None, new: Sign) -> Sign:
    """One sign of two that say the same: of each node the better sighting, the best ones of all.

    Args:
        known: what the map has; None where it has none. Its spelling stays.
        new: what came to it.
    """
    if known is None:
        return new.model_copy(update={"sightings": _best(new.sightings)})
    return known.model_copy(update={"sightings": _best((*known.sightings, *new.sightings))})


def _best(sightings: Iterable[Sighting]) -> tuple[Sighting, ...]:
    """Of each node the one that shows the sign largest: it is read best from near by, squarely before it."""
    by_node: dict[int, Sighting] = {}
    for sighting in sightings:
        known = by_node.get(sighting.node)
        if known is None or _quality(sighting) > _quality(known):
            by_node[sighting.node] = sighting
    ranked = sorted(by_node.values(), key=lambda one: (*_quality(one), -one.node), reverse=True)
    return tuple(ranked[:SIGHTINGS_MAX])


def _quality(sighting: Sighting) -> tuple[float, float]:
    return sighting.height_rad * sighting.confidence, sighting.confidence
