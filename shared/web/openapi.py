"""What REST descriptions say of errors: all of them are RFC 9457 problems. Pure, on the plain document."""

import copy
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

from fastapi import FastAPI

MEDIA_TYPE = "application/problem+json"
METHODS = frozenset({"get", "put", "post", "delete", "patch", "head", "options"})
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
    error = problem_described("A problem: what was expected, what came, what to do next.")
    for _, _, operation in operations(result):
        answers = operation.setdefault("responses", {})
        answers.pop("422", None)
        answers |= {"4XX": error, "5XX": error}
    return result


def operations(document: dict[str, Any]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Method, path and description of every operation."""
    for path, described in document.get("paths", {}).items():
        for method in METHODS & described.keys():
            yield method.upper(), path, described[method]


def problem_described(why: str) -> dict[str, Any]:
    """An answer that is a problem document, as OpenAPI describes it."""
    content = {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}}
    return {"description": why, "content": content}


def describe(app: FastAPI, change: Callable[[dict[str, Any]], dict[str, Any]]) -> None:
    """Have `change` complete the REST description of `app`, once."""
    plain = app.openapi
    app.openapi = cache(lambda: change(plain()))  # type: ignore[method-assign]
