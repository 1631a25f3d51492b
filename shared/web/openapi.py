"""What REST descriptions say of errors: all of them are RFC 9457 problems. Pure, on the plain document."""

import copy
from collections.abc import Callable
from functools import cache
from typing import Any

MEDIA_TYPE = "application/problem+json"
METHODS = ("get", "put", "post", "delete", "patch", "head", "options")
FRAMEWORK_SCHEMAS = ("HTTPValidationError", "ValidationError")
PROBLEM: dict[str, Any] = {
    "title": "Problem",
    "description": "An error as RFC 9457 has it; services may add members.",
    "type": "object",
    "required": ["type", "title", "status", "detail"],
    "properties": {
        "type": {"type": "string", "examples": ["urn:topnav:problem:missing"]},
        "title": {"type": "string"},
        "status": {"type": "integer"},
        "detail": {"type": "string"},
    },
}


def with_problems(document: dict[str, Any]) -> dict[str, Any]:
    """The OpenAPI document with every error of every operation as a problem.

    FastAPI describes 422 with a body of its own; here the handlers replace that body, too.

    Args:
        document: as FastAPI generates it; left as it is.
    """
    result = copy.deepcopy(document)
    schemas = result.setdefault("components", {}).setdefault("schemas", {})
    for name in FRAMEWORK_SCHEMAS:
        schemas.pop(name, None)
    schemas["Problem"] = PROBLEM
    error = {
        "description": "A problem: what was expected, what came, what to do next.",
        "content": {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}},
    }
    for path in result.get("paths", {}).values():
        for method in set(METHODS) & path.keys():
            answers = path[method].setdefault("responses", {})
            for status in [status for status in answers if status[0] in "45"]:
                del answers[status]
            answers |= {"4XX": error, "5XX": error}
    return result


def describing_problems(plain: Callable[[], dict[str, Any]]) -> Callable[[], dict[str, Any]]:
    """What an application's `openapi` is to be replaced by: `plain` with problems, made once."""
    return cache(lambda: with_problems(plain()))
