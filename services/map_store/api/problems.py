"""Every error of REST as application/problem+json (RFC 9457)."""

import logging
from http import HTTPStatus

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException

from services.map_store import errors
from shared.web.openapi import MEDIA_TYPE

log = logging.getLogger(__name__)

STATUS: dict[str, HTTPStatus] = {
    errors.MissingError.code: HTTPStatus.NOT_FOUND,
    errors.ConflictError.code: HTTPStatus.CONFLICT,
    errors.InvalidError.code: HTTPStatus.UNPROCESSABLE_ENTITY,
    errors.CorruptError.code: HTTPStatus.INTERNAL_SERVER_ERROR,
    errors.StorageFullError.code: HTTPStatus.INSUFFICIENT_STORAGE,
    errors.UnavailableError.code: HTTPStatus.SERVICE_UNAVAILABLE,
}
MAX_DETAIL = 1000


def problem(kind: str, status: int, detail: str, headers: dict[str, str] | None = None) -> JSONResponse:
    """One error answer."""
    body = {
        "type": f"urn:topnav:problem:{kind}",
        "title": HTTPStatus(status).phrase,
        "status": status,
        "detail": detail[:MAX_DETAIL],
    }
    return JSONResponse(body, status, headers, media_type=MEDIA_TYPE)


def install(app: FastAPI) -> None:
    """Answer every error of `app` as a problem."""

    @app.exception_handler(errors.MapError)
    def _map_error(_request: Request, error: errors.MapError) -> JSONResponse:
        status = STATUS.get(error.code, HTTPStatus.INTERNAL_SERVER_ERROR)
        return problem(error.code or "internal", status, str(error))

    @app.exception_handler(HTTPException)
    def _http_error(_request: Request, error: HTTPException) -> JSONResponse:
        kind = HTTPStatus(error.status_code).phrase.lower().replace(" ", "-")
        return problem(kind, error.status_code, str(error.detail), dict(error.headers or {}))

    @app.exception_handler(RequestValidationError)
    def _bad_request(_request: Request, error: RequestValidationError) -> JSONResponse:
        told = [f"{'.'.join(str(part) for part in e['loc'])}: {e['msg']}" for e in error.errors()[:8]]
        return problem("invalid", HTTPStatus.UNPROCESSABLE_ENTITY, "; ".join(told))

    @app.exception_handler(Exception)
    def _unexpected(request: Request, error: Exception) -> JSONResponse:
        log.error("%s %s failed", request.method, request.url.path, exc_info=error)
        detail = "the map store failed; its log says why"
        return problem("internal", HTTPStatus.INTERNAL_SERVER_ERROR, detail)
