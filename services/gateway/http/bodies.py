"""Bodies of requests: read with a length and a time limit, JSON strictly, pictures from either form."""

import json
from collections.abc import AsyncGenerator
from typing import Any, NoReturn, TypeVar

from fastapi import Request
from pydantic import BaseModel, ValidationError
from starlette.datastructures import UploadFile
from starlette.formparsers import MultiPartException, MultiPartParser
from starlette.requests import ClientDisconnect

from services.gateway.http.problems import invalid
from shared.web.bodies import BodyLimit, limited
from shared.web.problems import ProblemError

B = TypeVar("B", bound=BaseModel)

MAX_JSON_BYTES = 64_000
"""Chosen: the longest body, a stop with its reason, takes a thousand."""
MULTIPART_EXTRA_BYTES = 16_000
"""Room for boundaries and part headers around a picture; browsers need a few hundred."""
PICTURE_TYPES = ("image/png", "image/jpeg", "image/webp")


def json_body(kind: type[BaseModel], required: bool = True) -> dict[str, Any]:
    """What the REST description says of a body that `read_json` reads."""
    content = {"application/json": {"schema": kind.model_json_schema()}}
    return {"requestBody": {"required": required, "content": content}}


def body_of(request: Request, limit: BodyLimit) -> Request:
    """The request with a body that keeps to `limit`."""
    return Request(request.scope, limited(request.receive, limit))


async def read_body(request: Request, limit_bytes: int, timeout_s: float) -> bytes:
    """Read at most `limit_bytes`.

    Raises:
        ProblemError: 413 longer, 408 slower than `timeout_s`, 400 sender gone.
    """
    try:
        return await body_of(request, BodyLimit(limit_bytes, timeout_s)).body()
    except ClientDisconnect:
        raise ProblemError(400, "disconnected", "a whole body", "the sender's end", "send it again") from None


async def read_json(request: Request, kind: type[B], timeout_s: float) -> B:
    """Read a JSON body as `kind`; NaN, infinities and duplicate keys are not JSON.

    Raises:
        ProblemError: 415 not announced as JSON, 422 not JSON or not of that kind.
    """
    media_type = _media_type(request.headers.get("content-type"))
    if media_type != "application/json":
        expected, next_step = "content type application/json", "send the fields as a JSON object"
        raise ProblemError(415, "not_json", expected, media_type[:80] or "none", next_step)
    return parse_json(await read_body(request, MAX_JSON_BYTES, timeout_s), kind)


def parse_json(body: bytes, kind: type[B]) -> B:
    """A JSON object as `kind`.

    Raises:
        ProblemError: 422 not JSON, text that is none (half a surrogate pair), or not of that kind.
    """
    try:
        content = json.loads(body, parse_constant=_no_constant, object_pairs_hook=_no_duplicates)
        json.dumps(content, ensure_ascii=False).encode()  # as the bus will write its texts
    except (ValueError, RecursionError) as error:
        got, next_step = str(error)[:200] or type(error).__name__, "check the body with a JSON linter"
        raise ProblemError(422, "invalid_json", "a JSON object", got, next_step) from None
    try:
        return kind.model_validate(content, strict=True)
    except ValidationError as error:
        raise invalid(error.errors(include_url=False, include_input=False, include_context=False)) from None


async def read_picture(request: Request, limit_bytes: int, timeout_s: float) -> tuple[bytes, str]:
    """Read the one picture of a request, sent as the body or as the one part of a form.

    Returns:
        The file's bytes and the content type it was sent with.

    Raises:
        ProblemError: no picture, several, or another type.
    """
    media_type = _media_type(request.headers.get("content-type"))
    if media_type in PICTURE_TYPES:
        return await read_body(request, limit_bytes, timeout_s), media_type
    if media_type != "multipart/form-data":
        expected = f"one of {', '.join(PICTURE_TYPES)} or multipart/form-data"
        next_step = "send the picture as the body, or as a form with one file"
        raise ProblemError(415, "unsupported_type", expected, media_type[:80] or "no content type", next_step)
    body = await read_body(request, limit_bytes + MULTIPART_EXTRA_BYTES, timeout_s)
    return await _only_part(request, body, limit_bytes)


class _MemoryParser(MultiPartParser):
    spool_max_size = 2**30  # the body is in memory and bounded already: parts never go to a file


async def _only_part(request: Request, body: bytes, limit_bytes: int) -> tuple[bytes, str]:
    async def whole() -> AsyncGenerator[bytes, None]:
        yield body

    parser = _MemoryParser(request.headers, whole(), max_files=1, max_fields=0)
    try:
        form = await parser.parse()
    except (MultiPartException, ValueError, LookupError) as error:
        expected, next_step = "multipart/form-data with one file", "send one file and no fields"
        raise ProblemError(422, "bad_form", expected, str(error)[:200], next_step) from None
    try:
        parts = [value for _, value in form.multi_items() if isinstance(value, UploadFile)]
        if len(parts) != 1:
            raise ProblemError(
                422, "bad_form", "one file in the form", f"{len(parts)} files", "send one file"
            )
        data = await parts[0].read()
    finally:
        await form.close()
    if len(data) > limit_bytes:
        expected, got = f"at most {limit_bytes} bytes", f"{len(data)} bytes"
        raise ProblemError(413, "too_large", expected, got, "send it smaller")
    return data, _media_type(parts[0].content_type)


def _media_type(content_type: str | None) -> str:
    return (content_type or "").partition(";")[0].strip().lower()


def _no_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is not JSON")


def _no_duplicates(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    content = dict(pairs)
    if len(content) != len(pairs):
        raise ValueError("a key stands twice in one object")
    return content
