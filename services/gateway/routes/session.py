"""Who somebody is here, and the cookie with which a page reads pictures and opens WebSockets."""

import time

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel

from services.gateway.auth.guard import access_of, person_of
from services.gateway.auth.sessions import LIFETIME_S
from shared.access.tokens import Role

router = APIRouter(tags=["access"])


class SessionAnswer(BaseModel):
    """Who asks.

    Attributes:
        guarded: whether this gateway asks for tokens at all.
        name: of the token; empty for none and for GATEWAY_TOKEN.
        role: what the token may do; null without one.
        pass_s: how long the cookie made by this request is good; 0 when none was made.
    """

    guarded: bool
    name: str
    role: Role | None
    pass_s: float


@router.get("/api/session")
async def show_session(request: Request) -> SessionAnswer:
    """Say who asks."""
    return _answer(request, 0.0)


@router.post("/api/session")
async def open_session(request: Request, response: Response) -> SessionAnswer:
    """Set a cookie that opens reading and WebSockets, never writing, to a page that showed its token."""
    token, access = person_of(request).token, access_of(request)
    if token is None or not access.tokens.required:
        return _answer(request, 0.0)
    response.set_cookie(
        access.cookie,
        access.sessions.issue(token, time.time()),
        max_age=int(LIFETIME_S),
        path="/",
        secure=request.url.scheme == "https",
        httponly=True,
        samesite="strict",
    )
    response.headers["Cache-Control"] = "no-store"
    return _answer(request, LIFETIME_S)


@router.delete("/api/session")
async def close_session(request: Request, response: Response) -> SessionAnswer:
    """Take the cookie back."""
    response.delete_cookie(access_of(request).cookie, path="/", httponly=True, samesite="strict")
    return _answer(request, 0.0)


def _answer(request: Request, pass_s: float) -> SessionAnswer:
    token, guarded = person_of(request).token, access_of(request).tokens.required
    if token is None:
        return SessionAnswer(guarded=guarded, name="", role=None, pass_s=pass_s)
    return SessionAnswer(guarded=guarded, name=token.name, role=token.role, pass_s=pass_s)
