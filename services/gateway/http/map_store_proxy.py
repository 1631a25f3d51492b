"""Requests passed on to the map store's REST interface, answers and problems passed back."""

import asyncio
import ssl
import time
from collections.abc import AsyncIterator
from http import HTTPStatus
from pathlib import Path

import httpx
from fastapi import Request
from fastapi.responses import Response, StreamingResponse
from starlette.background import BackgroundTask

from services.gateway.auth.guard import person_of
from services.gateway.http.problems import ProblemError
from services.gateway.settings import GatewaySettings
from services.gateway.state import Gateway
from shared.access.credentials import MAP_STORE_HOST, credentials_in, secured_url
from shared.web.openapi import MEDIA_TYPE

AUTHOR = "x-topnav-author"
AUTHOR_CHARACTERS = 64
SENT_ON = ("accept", "content-type", "if-match", "if-none-match", AUTHOR)
SENT_BACK = ("content-type", "content-length", "content-disposition", "etag", "cache-control", "location")
MAX_PROBLEM_BYTES = 64_000
TIMEOUTS = httpx.Timeout(10.0, connect=2.0)
STREAM_TIMEOUTS = httpx.Timeout(120.0, connect=2.0)
LEAST_BYTES_PER_S = 50_000


def open_client(url: str, token: str, certs: Path | None = None) -> httpx.AsyncClient:
    """A client of the map store at `url`; no proxy settings of the environment apply inside the system.

    With a certificate in the folder `certs` it is HTTPS, and each side shows the other who it is.

    Raises:
        CredentialsError: the folder cannot be used.
    """
    headers = {"Authorization": f"Bearer {token}"} if token else {}
    credentials = credentials_in(certs)
    if credentials is None:
        return httpx.AsyncClient(base_url=url, headers=headers, timeout=TIMEOUTS, trust_env=False)
    trust = credentials.tls_context(ssl.Purpose.SERVER_AUTH)
    return httpx.AsyncClient(
        base_url=secured_url(url),
        headers=headers,
        timeout=TIMEOUTS,
        trust_env=False,
        verify=trust,
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
    headers = _headers(request)
    wish = gateway.store.build_request(
        request.method, path, params=request.url.query, headers=headers, content=body or None
    )
    return await _answer(gateway, wish)


async def forward_stream(gateway: Gateway, request: Request, path: str) -> Response:
    """Pass a request with a long body on while it arrives."""
    wish = gateway.store.build_request(
        request.method,
        path,
        params=request.url.query,
        headers=_headers(request),
        content=_limited(request, gateway.settings),
        timeout=STREAM_TIMEOUTS,
    )
    with gateway.imports.hold(person_of(request).client):
        return await _answer(gateway, wish)


async def fetch(store: httpx.AsyncClient, path: str) -> bytes | None:
    """The body of a short answer of the map store, None where it has nothing.

    Raises:
        ProblemError: 503 the store is down, 504 too slow, 502 it answered anything else.
    """
    answer = await _send(store, store.build_request("GET", path))
    try:
        if answer.status_code == HTTPStatus.NOT_FOUND:
            return None
        if answer.status_code != HTTPStatus.OK:
            raise _nonsense(f"status {answer.status_code} for {path}")
        return await answer.aread()
    except httpx.HTTPError as error:
        raise _nonsense(_name(error)) from error
    finally:
        await answer.aclose()


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
        return await store.send(wish, stream=True)
    except (httpx.ConnectError, httpx.ConnectTimeout, httpx.RemoteProtocolError, httpx.WriteError) as error:
        raise ProblemError(
            503,
            "service_absent",
            expected=f"the map store at {store.base_url}",
            got=_name(error),
            next_step="start map_store (see /readyz) and try again",
            service="map_store",
        ) from error
    except httpx.TimeoutException as error:
        raise ProblemError(
            504,
            "service_slow",
            expected="an answer of the map store",
            got=_name(error),
            next_step="try again; if it stays so, look at its log",
            service="map_store",
        ) from error
    except httpx.HTTPError as error:
        raise _nonsense(_name(error)) from error


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
    if answer.headers.get("content-type", "").startswith(MEDIA_TYPE) and len(body) <= MAX_PROBLEM_BYTES:
        return Response(body, answer.status_code, media_type=MEDIA_TYPE)
    kind = answer.headers.get("content-type", "no content type")[:80]
    raise _nonsense(f"status {answer.status_code} with {kind}")


async def _limited(request: Request, settings: GatewaySettings) -> AsyncIterator[bytes]:
    """A body while it arrives; it must flow, and at the least rate on average."""
    length, stream, began_s = 0, request.stream(), time.monotonic()
    while True:
        left_s = settings.upload_timeout_s + length / LEAST_BYTES_PER_S - (time.monotonic() - began_s)
        try:
            async with asyncio.timeout(min(left_s, settings.upload_timeout_s)):
                chunk = await anext(stream, None)
        except TimeoutError:
            raise ProblemError(
                408,
                "body_too_slow",
                expected=f"{LEAST_BYTES_PER_S} bytes a second",
                got=f"{length} bytes in {time.monotonic() - began_s:.0f} s",
                next_step="send it over a faster link, or import at the map store",
            ) from None
        if chunk is None:
            return
        length += len(chunk)
        if length > settings.max_import_bytes:
            raise ProblemError(
                413,
                "body_too_large",
                expected=f"at most {settings.max_import_bytes} bytes",
                got=f"at least {length} bytes",
                next_step="raise GATEWAY_MAX_IMPORT_BYTES or import at the map store",
            )
        yield chunk


def author_of(request: Request) -> str:
    """Who stands in a map's history: the token's name where there is one, else who the request says it is."""
    return person_of(request).name or request.headers.get(AUTHOR, "")[:AUTHOR_CHARACTERS]


def _headers(request: Request) -> dict[str, str]:
    headers = {name: request.headers[name] for name in SENT_ON if name in request.headers}
    if name := person_of(request).name:
        headers[AUTHOR] = name
    return headers


def _nonsense(got: str) -> ProblemError:
    return ProblemError(
        502,
        "bad_answer",
        expected="an answer or a problem document of the map store",
        got=got,
        next_step="see its log; run the same version of every service",
        service="map_store",
    )


def _name(error: Exception) -> str:
    return f"{type(error).__name__}: {str(error)[:120]}"
