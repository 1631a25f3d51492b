"""Problems of the gateway: counted, and what errors of the framework become."""

from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException

from services.gateway.http.metrics import Metrics
from shared.web import problems
from shared.web.problems import ProblemError

NAMED = {404: "not_found", 405: "method_not_allowed", 413: "body_too_large"}
"""Problems that carry another name than their status."""
BUG = ProblemError(500, "internal_error", "an answer", "an error in the gateway", "see its log")


def install(app: FastAPI, metrics: Metrics) -> None:
    """Make every error of `app` a problem document."""
    translations: dict[type[Exception], problems.Translation] = {
        HTTPException: _from_http,
        RequestValidationError: lambda _request, error: invalid(error.errors()),
    }
    problems.install(app, translations, BUG, lambda request, p: counted(p, request.url.path, metrics))


def counted(problem: ProblemError, path: str, metrics: Metrics) -> JSONResponse:
    """The response to a request of `path`, counted."""
    metrics.problems.labels(problem.code, str(problem.status_code)).inc()
    return problems.response(problem, instance=path)


def invalid(errors: Any) -> ProblemError:
    """Problem 422 from pydantic's list; what was sent is not echoed, it may be huge or not JSON."""
    faults = [
        {"where": ".".join(str(part) for part in error["loc"])[:200], "what": str(error["msg"])[:300]}
        for error in list(errors)[:10]
    ]
    first = faults[0] if faults else {"where": "request", "what": "not valid"}
    got, next_step = f"{first['where']}: {first['what']}", "correct the fields named in `errors`"
    return ProblemError(422, "invalid_request", "fields as in /openapi.json", got, next_step, errors=faults)


def _from_http(request: Request, error: HTTPException) -> ProblemError:
    status, headers = error.status_code, error.headers or {}
    code = NAMED.get(status, HTTPStatus(status).phrase.lower().replace(" ", "_"))
    expected = {
        404: "a path listed in /openapi.json",
        405: f"one of {headers.get('Allow', 'the listed methods')}",
    }.get(status, "a well-formed request")
    got, next_step = f"{request.method} {request.url.path[:200]}", f"see /openapi.json ({error.detail})"
    return ProblemError(status, code, expected, got, next_step, headers=headers)
