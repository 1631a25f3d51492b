"""Who somebody is here, and the pass with which a page reads pictures and opens WebSockets."""

import time

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel

from services.gateway.auth.guard import person_of
from services.gateway.auth.passes import LIFETIME_S
from services.gateway.state import Gateway, GatewayDep
from shared.access.roles import Role

router = APIRouter(tags=["access"])


class SessionAnswer(BaseModel):
    """Who asks.

    Attributes:
        guarded: whether this gateway asks for tokens at all.
        name: of the token; empty for none and for GATEWAY_TOKEN.
        role: what the token may do; null without one.
        pass_s: how long the pass made by this request is good; 0 when none was made.
    """

    guarded: bool
    name: str
    role: Role | None
    pass_s: float


@router.get("/api/session")
async def show_session(request: Request, gateway: GatewayDep) -> SessionAnswer:
    """Say who asks."""
    return _answer(request, gateway, 0.0)


@router.post("/api/session")
async def open_session(request: Request, gateway: GatewayDep, response: Response) -> SessionAnswer:
    """Set a cookie that opens reading and WebSockets, never writing, to a page that showed its token."""
    token, access = person_of(request).token, gateway.access
    if token is None or not access.book.guards:
        return _answer(request, gateway, 0.0)
    response.set_cookie(
        access.cookie,
        access.passes.issue(token, time.time()),
        max_age=int(LIFETIME_S),
        path="/",
        secure=request.url.scheme == "https",
        httponly=True,
        samesite="strict",
    )
    response.headers["Cache-Control"] = "no-store"
    return _answer(request, gateway, LIFETIME_S)


@router.delete("/api/session")
async def close_session(request: Request, gateway: GatewayDep, response: Response) -> SessionAnswer:
    """Take the cookie back."""
    response.delete_cookie(gateway.access.cookie, path="/", httponly=True, samesite="strict")
    return _answer(request, gateway, 0.0)


def _answer(request: Request, gateway: Gateway, pass_s: float) -> SessionAnswer:
    token = person_of(request).token
    return SessionAnswer(
        guarded=gateway.access.book.guards,
        name=token.name if token is not None else "",
        role=token.role if token is not None else None,
        pass_s=pass_s,
    )
