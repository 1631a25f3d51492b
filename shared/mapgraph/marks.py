"""Marks of a map as they change: found by name, checked, and freed of nodes that go. Pure."""

import unicodedata
from collections.abc import Callable, Collection, Container, Iterable, Mapping
from difflib import get_close_matches
from itertools import groupby, pairwise
from typing import TypeVar

from shared.messages.places import NAME_MAX, EdgeRule, KeepOut, Mark, Marks, Place, Route, Rule, Sign, key_of

M = TypeVar("M", bound=Mark)
T = TypeVar("T")

NEAREST = 3
"""Names that an error offers; chosen: what one reads at a glance."""
ALIKE = 0.5
"""Least likeness of a name that is offered; chosen: of "kithen" and "kitchen" it is 0.92, of "hall" and
"hall 2" 0.8."""
MENTIONS_MAX = 100_000
"""Nodes that all marks of a map may list together: 1 MB, written anew with each change of one."""


def by_key(marks: Iterable[M]) -> dict[str, M]:
    """Marks of one kind by what their names mean."""
    return {key_of(mark.name): mark for mark in marks}


def search(text: str, marks: Iterable[M]) -> list[M]:
    """Those whose names hold a text, those that begin with it first, then those whose names are like it.

    Accents tell no two letters apart here.
    """
    known = sorted(by_key(marks).items())
    plain = [_plain(key) for key, _ in known]
    wanted = _plain(" ".join(text.split()).casefold())
    holding = [number for number, key in enumerate(plain) if wanted in key]
    holding.sort(key=lambda number: not plain[number].startswith(wanted))
    others = sorted({key for key in plain if wanted not in key})
    alike = get_close_matches(wanted, others, NEAREST, ALIKE)
    found = [*holding, *(number for key in alike for number, other in enumerate(plain) if other == key)]
    return [known[number][1] for number in found]


def _plain(key: str) -> str:
    letters = unicodedata.normalize("NFKD", key)
    return "".join(letter for letter in letters if not unicodedata.combining(letter))


def nothing_called(name: str, marks: Collection[M], what: str = "place") -> str:
    """The text of an error about a name that nothing has: it tells the nearest ones.

    Args:
        name: as it was asked for.
        marks: those there are.
        what: "place", "rule", "route" or "sign".
    """
    if not marks:
        return f"the map has no {what} {name!r}, and no {what}s at all"
    near = [mark.name for mark in search(name, marks)][:NEAREST]
    told = "nearest" if near else "among others"
    names = near or sorted(mark.name for mark in marks)[:NEAREST]
    return f"the map has no {what} {name!r}; {told}: {', '.join(map(repr, names))}"


def place_called(name: str, places: Mapping[str, Place]) -> Place | str:
    """The place of that name, or a text that says that there is none and which are nearest."""
    return _called(name, places, "place")


def route_called(name: str, routes: Mapping[str, Route]) -> Route | str:
    """The route of that name, or a text that says that there is none and which are nearest."""
    return _called(name, routes, "route")


def sign_called(text: str, signs: Mapping[str, Sign]) -> Sign | str:
    """The sign that says this or one word of it ("room 214"), or a text with those that say nearly this."""
    found = _called(text, signs, "sign")
    if isinstance(found, Sign):
        return found
    words = {word for word in text.casefold().split() if word in signs}
    return signs[words.pop()] if len(words) == 1 else found


def _called(name: str, marks: Mapping[str, M], what: str) -> M | str:
    try:
        key = key_of(name)
    except ValueError as error:
        return str(error)
    return marks.get(key) or nothing_called(name, list(marks.values()), what)


def gaps(route: Route, joined: Container[tuple[int, int]]) -> list[tuple[int, int]]:
    """Where one node of a route and the next are not joined.

    Args:
        route: any.
        joined: the edges of the map, each as its two nodes, the lower one first.
    """
    return [(a, b) for a, b in pairwise(route.nodes) if (min(a, b), max(a, b)) not in joined]


def nodes_of(mark: Mark) -> set[int]:
    """All nodes that it lists, those of areas apart."""
    if isinstance(mark, EdgeRule):
        return {node for way in mark.edges for node in way}
    if isinstance(mark, Sign):
        return {sighting.node for sighting in mark.sightings}
    assert isinstance(mark, Place | KeepOut | Route)
    return set(mark.nodes)


def mentions(mark: Mark) -> int:
    """How many nodes it lists: a route lists one as often as it comes to it."""
    return len(mark.nodes) if isinstance(mark, Route) else len(nodes_of(mark))


def only_nodes(mark: M, kept: Container[int]) -> M:
    """The same without the nodes that are gone, and without the edges that ended there."""
    return mark.model_copy(update=_listing(mark, lambda n: n if n in kept else None))


def renumbered(mark: M, ids: Mapping[int, int], name: str, areas: Mapping[str, str]) -> M:
    """The same in another map.

    Args:
        mark: a place, a rule, a route or a sign.
        ids: number there by number here; nodes without one are left out.
        name: what it is called there.
        areas: names of places there by key here.
    """
    update = {"name": name, **_listing(mark, ids.get)}
    if isinstance(mark, KeepOut):
        update["areas"] = tuple(areas.get(key_of(area), area) for area in mark.areas)
    return mark.model_copy(update=update)


def free_names(new: Mapping[str, Mark], taken: Collection[str], map_name: str) -> dict[str, str]:
    """Names for marks of another map, by their keys: their own, or with that map's name behind it.

    Args:
        new: marks of the other map by key.
        taken: keys that are names already.
        map_name: of the other map.
    """
    used, names = {*taken, *new}, {}
    for key, mark in new.items():
        name, number = mark.name, 1
        while key in taken and (name == mark.name or key_of(name) in used):
            behind = f" ({map_name[: NAME_MAX // 2]}{f' {number}' if number > 1 else ''})"
            name, number = mark.name[: NAME_MAX - len(behind)].rstrip() + behind, number + 1
        used.add(key_of(name))
        names[key] = name
    return names


def _listing(mark: Mark, number: Callable[[int], int | None]) -> dict[str, object]:
    """What a mark lists, with other numbers; None takes a node away, and edges with it."""
    if isinstance(mark, EdgeRule):
        ways = [(number(a), number(b)) for a, b in mark.edges]
        return {"edges": tuple(way for way in ways if None not in way)}
    if isinstance(mark, Sign):
        seen = [(sighting, number(sighting.node)) for sighting in mark.sightings]
        kept = [one.model_copy(update={"node": node}) for one, node in seen if node is not None]
        return {"sightings": tuple(kept)}
    assert isinstance(mark, Place | KeepOut | Route)
    nodes = [new for n in mark.nodes if (new := number(n)) is not None]
    if isinstance(mark, Route):  # there and back without the far end: the same node twice is one visit
        nodes = [node for node, _ in groupby(nodes)]
    return {"nodes": tuple(nodes)}


def users_of(place: str, rules: Iterable[Rule]) -> list[str]:
    """Names of the rules about an area, by its key."""
    return [rule.name for rule in rules if isinstance(rule, KeepOut) and place in map(key_of, rule.areas)]


def marks_of(
    places: Mapping[str, Place],
    rules: Mapping[str, Rule],
    routes: Mapping[str, Route] | None = None,
    signs: Mapping[str, Sign] | None = None,
) -> Marks:
    """All of them, in the order of their keys."""
    return Marks(
        places=_in_order(places),
        rules=_in_order(rules),
        routes=_in_order(routes or {}),
        signs=_in_order(signs or {}),
    )


def _in_order(marks: Mapping[str, T]) -> tuple[T, ...]:
    return tuple(marks[key] for key in sorted(marks))
