"""Every error of REST as a problem: its text, under the name of its kind or its status."""

from collections.abc import Mapping
from http import HTTPStatus

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException

from services.map_store import errors
from shared.web import problems
from shared.web.problems import ProblemError

STATUS: dict[str, HTTPStatus] = {
    errors.MissingError.code: HTTPStatus.NOT_FOUND,
    errors.ConflictError.code: HTTPStatus.CONFLICT,
    errors.InvalidError.code: HTTPStatus.UNPROCESSABLE_ENTITY,
    errors.CorruptError.code: HTTPStatus.INTERNAL_SERVER_ERROR,
    errors.StorageFullError.code: HTTPStatus.INSUFFICIENT_STORAGE,
    errors.UnavailableError.code: HTTPStatus.SERVICE_UNAVAILABLE,
}
MAX_DETAIL = 1000
"""Characters; chosen: a list of faults may be as long as the request."""


class MergeProblemError(ProblemError):
    """Of merging: the document says what was expected, what came and what to do, as those of the gateway."""


def install(app: FastAPI) -> None:
    """Answer every error of `app` as a problem."""
    translations: dict[type[Exception], problems.Translation] = {
        errors.MapError: _map_error,
        HTTPException: _http_error,
        ProblemError: _http_error,
        MergeProblemError: lambda _request, error: error,
        RequestValidationError: _bad_request,
    }
    bug = _problem("internal", 500, "the map store failed; its log says why")
    problems.install(app, translations, bug, lambda _request, problem: problems.response(problem))


def _problem(code: str, status: int, detail: str, headers: Mapping[str, str] | None = None) -> ProblemError:
    title = HTTPStatus(status).phrase
    return ProblemError(status, code, detail=detail[:MAX_DETAIL], headers=headers, title=title)


def _map_error(_request: Request, error: errors.MapError) -> ProblemError:
    return _problem(
        error.code or "internal", STATUS.get(error.code, HTTPStatus.INTERNAL_SERVER_ERROR), str(error)
    )


def _http_error(_request: Request, error: HTTPException) -> ProblemError:
    code = HTTPStatus(error.status_code).phrase.lower().replace(" ", "-")
    return _problem(code, error.status_code, str(error.detail), error.headers)


def _bad_request(_request: Request, error: RequestValidationError) -> ProblemError:
    told = [f"{'.'.join(str(part) for part in e['loc'])}: {e['msg']}" for e in error.errors()[:8]]
    return _problem("invalid", HTTPStatus.UNPROCESSABLE_ENTITY, "; ".join(told))
