"""Errors of an HTTP server as RFC 9457 problem documents: what was expected, what came, what to do next."""

import json
import logging
from collections.abc import Awaitable, Callable, Mapping
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException

from shared.web.openapi import MEDIA_TYPE, describe, with_problems

log = logging.getLogger(__name__)


class ProblemError(HTTPException):
    """An answer other than success; FastAPI lets it pass from wherever a request is read.

    Args:
        status: HTTP status.
        code: short stable name of the problem, for programs and for metrics.
        expected, got, next_step: the three things a reader needs.
        detail: a text that says them, in place of the three.
        headers: of the response, beside those that the status asks for.
        extra: further members of the document.
    """

    def __init__(
        self,
        status: int,
        code: str,
        expected: str = "",
        got: str = "",
        next_step: str = "",
        *,
        detail: str = "",
        headers: Mapping[str, str] | None = None,
        **extra: Any,
    ) -> None:
        super().__init__(status, detail or f"expected {expected}, got {got}; {next_step}", headers)
        told = {} if detail else {"expected": expected, "got": got, "next": next_step}
        self.code, self.members = code, {**told, **extra}


class ProblemResponse(JSONResponse):
    """Problems repeat what came, and half a surrogate pair, which JSON may bring, has no encoding."""

    def render(self, content: Any) -> bytes:
        """JSON of any text."""
        return json.dumps(content, ensure_ascii=False, separators=(",", ":")).encode(errors="replace")


Translation = Callable[[Request, Any], ProblemError]
Respond = Callable[[Request, ProblemError], JSONResponse]


def response(problem: ProblemError, **members: Any) -> JSONResponse:
    """The problem document, with further `members`, and what its status asks for in headers."""
    headers = {"Cache-Control": "no-store"}
    if problem.status_code in (HTTPStatus.SERVICE_UNAVAILABLE, HTTPStatus.TOO_MANY_REQUESTS):
        headers["Retry-After"] = str(problem.members.get("retry_after_s", 1))
    if problem.status_code == HTTPStatus.UNAUTHORIZED:
        headers["WWW-Authenticate"] = "Bearer"
    document = {
        "type": f"urn:topnav:problem:{problem.code}",
        "title": problem.code.replace("_", " "),
        "status": problem.status_code,
        "detail": problem.detail,
        **members,
        **problem.members,
    }
    return ProblemResponse(
        document, problem.status_code, {**headers, **(problem.headers or {})}, media_type=MEDIA_TYPE
    )


def install(
    app: FastAPI, translations: Mapping[type[Exception], Translation], bug: ProblemError, respond: Respond
) -> None:
    """Make every error of `app` a problem document.

    Args:
        app: the application.
        translations: what errors are, by their type; `ProblemError` is itself unless it stands here.
        bug: the answer to an error that nobody expected.
        respond: makes the response.
    """

    def handler(translate: Translation) -> Callable[[Request, Exception], Awaitable[JSONResponse]]:
        async def handle(request: Request, error: Exception) -> JSONResponse:
            return respond(request, translate(request, error))

        return handle

    def on_bug(request: Request, error: Exception) -> ProblemError:
        log.error("%s %s failed", request.method, request.url.path, exc_info=error)
        return bug

    app.add_exception_handler(ProblemError, handler(lambda _request, error: error))
    for kind, translate in translations.items():
        app.add_exception_handler(kind, handler(translate))
    app.add_exception_handler(Exception, handler(on_bug))
    describe(app, with_problems)
