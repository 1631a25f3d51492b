"""From the table of `shared.access.rules` to the `access_control` section of a Zenoh router. Pure."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from shared.access.rules import BODIES, QUESTIONS, STREAMS, Role
from shared.topics import Delivery, Query, Topic
from shared.transport.keys import alive_key, robot_key

IN, OUT = "ingress", "egress"
"""Seen from the router: from a client, to a client."""

ALIVE = (alive_key("*", "*"), robot_key("*", "*"))
ADVANCED = "@adv/**"
"""Where recovered topics keep their cache, their heartbeat and who publishes, below their own key."""


@dataclass(frozen=True)
class Permission:
    """Kinds of Zenoh message that may pass in one direction on these keys."""

    flow: str
    kinds: tuple[str, ...]
    keys: tuple[str, ...]


def access_control(robots: Sequence[str]) -> dict[str, Any]:
    """The section of a router's configuration: nothing passes but what the table allows.

    Raises:
        ValueError: not a robot's name, or none at all.
    """
    if not robots:
        raise ValueError("access rules need the name of at least one robot, got none")
    rules: list[dict[str, Any]] = []
    subjects, policies = [], []
    for name, role, robot in _subjects(robots):
        own = [_rule(f"{name}-{n}", p) for n, p in enumerate(permissions(role, robot))]
        rules += own
        subjects.append({"id": name, "cert_common_names": [name]})
        policies.append({"rules": [rule["id"] for rule in own], "subjects": [name]})
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": rules,
        "subjects": subjects,
        "policies": policies,
    }


def permissions(role: Role, robot: str) -> tuple[Permission, ...]:
    """Everything that a holder of this role may do; one robot's services only on that robot's keys."""
    speaks = tuple(_keys(role, robot, STREAMS, "speakers"))
    hears = tuple(_keys(role, robot, STREAMS, "hearers"))
    answers = tuple(_keys(role, robot, QUESTIONS, "speakers"))
    asks = tuple(_keys(role, robot, QUESTIONS, "hearers"))
    wanted = tuple(_keys(role, "*", STREAMS, "speakers"))  # watchers subscribe to all robots at once
    offered = tuple(_keys(role, "*", QUESTIONS, "hearers"))  # and the map store answers for all
    kept, missed = _recovered(speaks), _recovered(hears)
    cached = tuple(f"{key}/{ADVANCED}" for key in kept)
    recovers = tuple(f"{key}/{ADVANCED}" for key in missed)
    found = [
        # A client sends only what it knows that somebody wants: it must hear of subscribers and answerers.
        Permission(IN, ("put", "delete"), speaks + cached),
        Permission(OUT, ("declare_subscriber",), wanted + cached),
        Permission(IN, ("declare_subscriber",), hears + recovers),
        Permission(OUT, ("put", "delete"), hears + recovers),
        Permission(IN, ("declare_queryable",), answers + cached),
        Permission(IN, ("reply",), answers + kept + cached),  # a cached sample comes back under its own key
        Permission(OUT, ("query",), answers + cached),
        Permission(IN, ("query",), asks + recovers),
        Permission(OUT, ("declare_queryable",), offered + recovers),
        Permission(OUT, ("reply",), asks + missed + recovers),
        Permission(IN, ("liveliness_token",), (*_tokens(role, robot), *cached)),
        Permission(IN, ("declare_liveliness_subscriber", "liveliness_query"), (*ALIVE, *recovers)),
        Permission(OUT, ("liveliness_token",), (*ALIVE, *recovers)),
    ]
    return tuple(permission for permission in found if permission.keys)


def _subjects(robots: Iterable[str]) -> Iterator[tuple[str, Role, str]]:
    for role in Role:
        for robot in robots if role.of_one_robot else ("*",):
            name = role.common_name(robot) if role.of_one_robot else role.value
            yield name, role, robot


def _keys(role: Role, robot: str, table: Any, side: str) -> Iterator[str]:
    stream: Topic[Any] | Query[Any, Any]
    for stream, grant in table.items():
        if role in getattr(grant, side):
            own = robot if role.of_one_robot else "*"
            yield stream.template.format(robot=own, queue=own, map="*")


def _tokens(role: Role, robot: str) -> tuple[str, ...]:
    """A robot's body says beside its service which robot it is. People and watchers are no service."""
    own = (alive_key("ros" if role is Role.ROBOT else role.value, "*"),)
    return (*own, robot_key(robot, "*")) if role in BODIES else own


def _recovered(keys: tuple[str, ...]) -> tuple[str, ...]:
    recovered = {t.template.format(robot="*", map="*") for t in STREAMS if t.delivery is Delivery.RECOVERED}
    return tuple(key for key in keys if key in recovered)


def _rule(name: str, permission: Permission) -> dict[str, Any]:
    return {
        "id": name,
        "permission": "allow",
        "flows": [permission.flow],
        "messages": list(permission.kinds),
        "key_exprs": list(permission.keys),
    }
