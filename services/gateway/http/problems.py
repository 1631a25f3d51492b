"""Errors as RFC 9457 problem details: what was expected, what came, what to do next."""

import logging
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException

from services.gateway.http.metrics import Metrics
from services.gateway.uploads.picture import PictureError
from shared.web.openapi import MEDIA_TYPE, describing_problems

log = logging.getLogger(__name__)


class ProblemError(Exception):
    """An answer other than success.

    Args:
        status: HTTP status.
        code: short stable name of the problem, for programs and for the metrics.
        expected, got, next_step: the three things a reader needs.
        extra: further members of the body.
    """

    def __init__(
        self, status: int, code: str, *, expected: str, got: str, next_step: str, **extra: Any
    ) -> None:
        super().__init__(f"{code}: expected {expected}, got {got}")
        self.status, self.code = status, code
        self.members = {"expected": expected, "got": got, "next": next_step, **extra}

    def body(self, path: str) -> dict[str, Any]:
        """The problem document for a request of `path`."""
        return {
            "type": f"urn:topnav:problem:{self.code}",
            "title": self.code.replace("_", " "),
            "status": self.status,
            "detail": "expected {expected}, got {got}; {next}".format(**self.members),
            "instance": path,
            **self.members,
        }


def problem_response(problem: ProblemError, path: str, metrics: Metrics) -> JSONResponse:
    """The response, counted."""
    metrics.problems.labels(problem.code, str(problem.status)).inc()
    headers = {"Cache-Control": "no-store"}
    if problem.status in (HTTPStatus.SERVICE_UNAVAILABLE, HTTPStatus.TOO_MANY_REQUESTS):
        headers["Retry-After"] = str(problem.members.get("retry_after_s", 1))
    if problem.status == HTTPStatus.UNAUTHORIZED:
        headers["WWW-Authenticate"] = "Bearer"
    return JSONResponse(problem.body(path), problem.status, headers, media_type=MEDIA_TYPE)


def install(app: FastAPI, metrics: Metrics) -> None:
    """Make every error of `app` a problem document."""

    async def on_problem(request: Request, error: Exception) -> JSONResponse:
        assert isinstance(error, ProblemError)
        return problem_response(error, request.url.path, metrics)

    async def on_picture(request: Request, error: Exception) -> JSONResponse:
        assert isinstance(error, PictureError)
        problem = ProblemError(
            error.status, error.reason, expected=error.expected, got=error.got, next_step=error.next_step
        )
        return problem_response(problem, request.url.path, metrics)

    async def on_http(request: Request, error: Exception) -> JSONResponse:
        assert isinstance(error, HTTPException)
        response = problem_response(_from_http(error, request), request.url.path, metrics)
        response.headers.update(error.headers or {})
        return response

    async def on_invalid(request: Request, error: Exception) -> JSONResponse:
        assert isinstance(error, RequestValidationError)
        return problem_response(invalid(list(error.errors())), request.url.path, metrics)

    async def on_bug(request: Request, error: Exception) -> JSONResponse:
        log.error("unexpected %s on %s", type(error).__name__, request.url.path)
        problem = ProblemError(
            500,
            "internal_error",
            expected="an answer",
            got="an error in the gateway",
            next_step="see its log",
        )
        return problem_response(problem, request.url.path, metrics)

    app.add_exception_handler(ProblemError, on_problem)
    app.add_exception_handler(PictureError, on_picture)
    app.add_exception_handler(HTTPException, on_http)
    app.add_exception_handler(RequestValidationError, on_invalid)
    app.add_exception_handler(Exception, on_bug)
    app.openapi = describing_problems(app.openapi)  # type: ignore[method-assign]


def invalid(errors: list[Any]) -> ProblemError:
    """Problem 422 from pydantic's list; what was sent is not echoed, it may be huge or not JSON."""
    places = [
        {"where": ".".join(str(part) for part in error["loc"])[:200], "what": str(error["msg"])[:300]}
        for error in errors[:10]
    ]
    first = places[0] if places else {"where": "request", "what": "not valid"}
    return ProblemError(
        422,
        "invalid_request",
        expected="fields as in /openapi.json",
        got=f"{first['where']}: {first['what']}",
        next_step="correct the fields named in `errors`",
        errors=places,
    )


def _from_http(error: HTTPException, request: Request) -> ProblemError:
    named = {404: "not_found", 405: "method_not_allowed", 413: "body_too_large"}
    code = named.get(error.status_code, HTTPStatus(error.status_code).phrase.lower().replace(" ", "_"))
    expected = {
        404: "a path listed in /openapi.json",
        405: f"one of {(error.headers or {}).get('Allow', 'the listed methods')}",
    }.get(error.status_code, "a well-formed request")
    got = f"{request.method} {request.url.path[:200]}"
    return ProblemError(
        error.status_code, code, expected=expected, got=got, next_step=f"see /openapi.json ({error.detail})"
    )
