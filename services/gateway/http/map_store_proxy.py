"""Requests passed on to the map store's REST interface, answers and problems passed back."""

import ssl
from http import HTTPStatus
from pathlib import Path

import httpx
from fastapi import Request
from fastapi.responses import Response, StreamingResponse
from starlette.background import BackgroundTask

from services.gateway.auth.guard import person_of
from services.gateway.http.asking import absent, bad_answer, slow
from services.gateway.http.bodies import body_of
from services.gateway.state import Gateway
from shared.access.credentials import MAP_STORE_HOST, credentials_in, secured_url
from shared.web.bodies import BodyLimit
from shared.web.openapi import MEDIA_TYPE
from shared.web.problems import ProblemError

AUTHOR = "x-topnav-author"
SENT_ON = ("accept", "content-type", "if-match", "if-none-match", AUTHOR)
SENT_BACK = ("content-type", "content-length", "content-disposition", "etag", "cache-control", "location")
MAX_PROBLEM_BYTES = 64_000
"""Of an error's body that may be passed back; the store's own have one."""
TIMEOUTS = httpx.Timeout(10.0, connect=5.0)
"""Seconds; chosen: twice what a question on the bus may take, GATEWAY_ASK_TIMEOUT_S; a machine that renders
and matches on all its cores was seen to stand still for two."""
STREAM_TIMEOUTS = httpx.Timeout(120.0, connect=5.0)
"""Seconds; chosen: the store answers an import once all of an archive is written."""
KEPT = httpx.Limits(max_connections=100, max_keepalive_connections=20, keepalive_expiry=2.0)
"""A connection is given up before the map store, which keeps one for five seconds, ends it: a request sent on
it at that moment would be lost."""
READING = ("GET", "HEAD")
LEAST_BYTES_PER_S = 50_000
"""Of an archive on its way in: the longest one, GATEWAY_MAX_IMPORT_BYTES, takes three hours at it."""


def open_client(url: str, token: str, certs: Path | None = None) -> httpx.AsyncClient:
    """A client of the map store at `url`; no proxy settings of the environment apply inside the system.

    With a certificate in the folder `certs` it is HTTPS, and each side shows the other who it is.

    Raises:
        CredentialsError: the folder cannot be used.
    """
    headers = {"Authorization": f"Bearer {token}"} if token else {}
    credentials = credentials_in(certs)
    if credentials is None:
        return httpx.AsyncClient(
            base_url=url, headers=headers, timeout=TIMEOUTS, limits=KEPT, trust_env=False
        )
    return httpx.AsyncClient(
        base_url=secured_url(url),
        headers=headers,
        timeout=TIMEOUTS,
        limits=KEPT,
        trust_env=False,
        verify=credentials.tls_context(ssl.Purpose.SERVER_AUTH),
        event_hooks={"request": [_expect_the_map_store]},
    )


async def _expect_the_map_store(request: httpx.Request) -> None:
    """Its certificate is compared with this name instead of the address."""
    request.extensions = {**request.extensions, "sni_hostname": MAP_STORE_HOST}


async def forward(gateway: Gateway, request: Request, path: str, body: bytes = b"") -> Response:
    """Pass a request with a short body on.

    Raises:
        ProblemError: 503 the store is down, 504 too slow, 502 its answer is no problem document.
    """
    wish = gateway.store.build_request(
        request.method, path, params=request.url.query, headers=_headers(request), content=body or None
    )
    return await _answer(gateway, wish)


async def forward_stream(gateway: Gateway, request: Request, path: str) -> Response:
    """Pass a request with a long body on while it arrives."""
    settings = gateway.settings
    next_step = "raise GATEWAY_MAX_IMPORT_BYTES or import at the map store"
    limit = BodyLimit(settings.max_import_bytes, settings.upload_timeout_s, LEAST_BYTES_PER_S, next_step)
    wish = gateway.store.build_request(
        request.method,
        path,
        params=request.url.query,
        headers=_headers(request),
        content=body_of(request, limit).stream(),
        timeout=STREAM_TIMEOUTS,
    )
    with gateway.imports.hold(person_of(request).client):
        return await _answer(gateway, wish)


async def _answer(gateway: Gateway, wish: httpx.Request) -> Response:
    answer = await _send(gateway.store, wish)
    if answer.status_code >= HTTPStatus.BAD_REQUEST:
        return await _problem(answer)
    headers = {name: answer.headers[name] for name in SENT_BACK if name in answer.headers}
    if "content-encoding" in answer.headers:  # unpacked on the way: the length no longer holds
        headers.pop("content-length", None)
    ended = BackgroundTask(answer.aclose)
    return StreamingResponse(answer.aiter_bytes(), answer.status_code, headers, background=ended)


async def _send(store: httpx.AsyncClient, wish: httpx.Request) -> httpx.Response:
    try:
        return await _sent(store, wish)
    except (httpx.ConnectError, httpx.ConnectTimeout, httpx.RemoteProtocolError, httpx.WriteError) as error:
        raise absent("map_store", f"the map store at {store.base_url}", _name(error)) from error
    except httpx.TimeoutException as error:
        raise slow("map_store", "an answer of the map store", _name(error)) from error
    except httpx.HTTPError as error:
        raise _nonsense(_name(error)) from error


async def _sent(store: httpx.AsyncClient, wish: httpx.Request) -> httpx.Response:
    """Reading is asked once more where the connection was ended as the question went out."""
    try:
        return await store.send(wish, stream=True)
    except (httpx.RemoteProtocolError, httpx.WriteError):
        if wish.method not in READING:
            raise
    return await store.send(wish, stream=True)


async def _problem(answer: httpx.Response) -> Response:
    try:
        body = b""
        async for chunk in answer.aiter_bytes():
            body += chunk
            if len(body) > MAX_PROBLEM_BYTES:
                break
    except httpx.HTTPError as error:
        raise _nonsense(_name(error)) from error
    finally:
        await answer.aclose()
    kind = answer.headers.get("content-type", "no content type")
    if kind.startswith(MEDIA_TYPE) and len(body) <= MAX_PROBLEM_BYTES:
        return Response(body, answer.status_code, media_type=MEDIA_TYPE)
    raise _nonsense(f"status {answer.status_code} with {kind[:80]}")


def _headers(request: Request) -> httpx.Headers:
    """Byte for byte as they came: the map store says what is wrong with them."""
    headers = {name: request.headers[name] for name in SENT_ON if name in request.headers}
    if name := person_of(request).name:
        headers[AUTHOR] = name
    return httpx.Headers(headers, encoding="latin-1")


def _nonsense(got: str) -> ProblemError:
    return bad_answer("map_store", "an answer or a problem document of the map store", got)


def _name(error: Exception) -> str:
    return f"{type(error).__name__}: {str(error)[:120]}"
