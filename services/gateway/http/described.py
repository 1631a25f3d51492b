"""What the REST description says of access: the role each operation needs, and the refusals. Pure."""

import copy
from collections.abc import Callable
from functools import cache
from typing import Any

from services.gateway.auth.rules import role_for
from shared.web.openapi import MEDIA_TYPE, METHODS

REFUSALS = {
    "401": "No token that this gateway takes.",
    "403": "The token's role is too low, or the request comes from another site's page.",
    "429": "Too often: `Retry-After` says when to come again.",
}


def with_roles(document: dict[str, Any]) -> dict[str, Any]:
    """The OpenAPI document with role and refusals at every operation that asks for a token."""
    result = copy.deepcopy(document)
    content = {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}}
    for path, operations in result.get("paths", {}).items():
        for method in set(METHODS) & operations.keys():
            operation = operations[method]
            if "security" not in operation:
                continue
            role = role_for(method.upper(), path)
            operation["x-topnav-role"] = role or "anybody"
            for status, why in REFUSALS.items():
                operation["responses"][status] = {"description": why, "content": content}
    return result


def describing_roles(plain: Callable[[], dict[str, Any]]) -> Callable[[], dict[str, Any]]:
    """What an application's `openapi` is to be replaced by: `plain` with roles, made once."""
    return cache(lambda: with_roles(plain()))
