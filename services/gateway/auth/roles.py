"""Which role a request needs. Pure. Unless listed here, reading is for viewers and writing for admins."""

import copy
from typing import Any

from shared.access.tokens import Role
from shared.web.openapi import operations, problem_described

READS = frozenset({"GET", "HEAD", "OPTIONS"})

ANYBODY = frozenset({("POST", "/api/robots/{robot}/estop")})
"""A stop that asks for a secret is none: a false one costs minutes, a refused one may cost a person."""

VIEWER = frozenset({("POST", "/api/session"), ("DELETE", "/api/session")})
AGENT = frozenset(
    {
        ("PUT", "/api/maps/{map_name}/places"),
        ("POST", "/api/robots/{robot}/goal-check"),
        ("POST", "/api/robots/{robot}/missions"),
        ("POST", "/api/robots/{robot}/missions/goto"),
        ("POST", "/api/robots/{robot}/missions/{action}"),
        ("POST", "/api/robots/{robot}/tasks"),
        ("DELETE", "/api/robots/{robot}/tasks/{task_id}"),  # one that waits; more is asked for one that runs
    }
)
"""A program that decides by itself sends robots somewhere: never how fast, and it clears no stop."""
OPERATOR = frozenset(
    {
        ("DELETE", "/api/robots/{robot}/estop"),
        ("POST", "/api/maps"),
        ("DELETE", "/api/maps/{map_name}/places"),
        ("PUT", "/api/maps/{map_name}/routes"),
        ("DELETE", "/api/maps/{map_name}/routes"),
        ("DELETE", "/api/maps/{map_name}/signs"),
        ("POST", "/api/robots/{robot}/drive"),
        ("PATCH", "/api/robots/{robot}/tasks/{task_id}"),
        ("PUT", "/api/robots/{robot}/schedules/{name}"),
        ("DELETE", "/api/robots/{robot}/schedules/{name}"),
    }
)
DRIVING = frozenset({("POST", "/api/robots/{robot}/drive")})
"""Said again as long as a person drives: limited by itself, less tightly than other writes."""
UPLOADS = frozenset(
    {
        ("POST", "/api/maps/import"),
        ("POST", "/api/robots/{robot}/goal-check"),
        ("POST", "/api/robots/{robot}/missions/goto"),
    }
)
"""What takes long bodies and costs computing time: limited more tightly than other writes."""

REFUSALS = {
    "401": "No token that this gateway takes.",
    "403": "The token's role is too low, or the request comes from another site's page.",
    "429": "Too often: `Retry-After` says when to come again.",
}


def role_for(method: str, path: str) -> Role | None:
    """The least role that may send this.

    Args:
        method: of the request.
        path: of its route, with names in braces; a final slash changes nothing.

    Returns:
        None: nobody is asked for a token.
    """
    path = path.removesuffix("/")
    if (method, path) in ANYBODY:
        return None
    if method in READS or (method, path) in VIEWER:
        return "viewer"
    if (method, path) in AGENT:
        return "agent"
    return "operator" if (method, path) in OPERATOR else "admin"


def with_roles(document: dict[str, Any]) -> dict[str, Any]:
    """The OpenAPI document with role and refusals at every operation that asks for a token."""
    result = copy.deepcopy(document)
    for method, path, operation in operations(result):
        if "security" in operation:
            operation["x-topnav-role"] = role_for(method, path) or "anybody"
            operation["responses"] |= {status: problem_described(why) for status, why in REFUSALS.items()}
    return result
