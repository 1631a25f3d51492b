"""The WebSocket of live events: status, decisions, heading, ranges and new frames of one robot as JSON."""

import asyncio
import contextlib

from fastapi import APIRouter, WebSocket, WebSocketDisconnect

from services.gateway.access import check_host, check_origin
from services.gateway.outbox import Outbox
from services.gateway.problems import ProblemError, problem_response
from services.gateway.state import Gateway, gateway_of
from shared.topics import NAME

router = APIRouter(tags=["live"])

CLOSE_S = 1.0
TRY_LATER = 1013


@router.websocket("/api/robots/{robot}/live")
async def live(socket: WebSocket, robot: str) -> None:
    """Send `{"type": ..., "data": ...}`: first what is known, then the news."""
    gateway = gateway_of(socket)
    try:
        _admit(socket, gateway, robot)
    except ProblemError as problem:
        gateway.metrics.sockets_refused.labels(problem.code).inc()
        await socket.send_denial_response(problem_response(problem, socket.url.path, gateway.metrics))
        return
    gateway.sockets += 1
    gateway.metrics.sockets.set(gateway.sockets)
    try:
        await socket.accept()
        await _serve(socket, gateway, robot)
    finally:
        gateway.sockets -= 1
        gateway.metrics.sockets.set(gateway.sockets)


def _admit(socket: WebSocket, gateway: Gateway, robot: str) -> None:
    check_host(socket, gateway.settings)
    check_origin(socket, gateway.settings)
    if not NAME.match(robot):
        raise ProblemError(
            422,
            "invalid_request",
            expected="a robot's name of a-z, 0-9, _ and -",
            got=repr(robot[:80]),
            next_step="see /api/robots",
        )
    if gateway.sockets >= gateway.settings.max_sockets or gateway.hub.view(robot) is None:
        raise ProblemError(
            503,
            "too_many_sockets",
            expected=f"at most {gateway.settings.max_sockets} connections",
            got="one more",
            next_step="close another page, or raise GATEWAY_MAX_SOCKETS",
        )


async def _serve(socket: WebSocket, gateway: Gateway, robot: str) -> None:
    outbox = gateway.hub.join(robot)
    assert outbox is not None
    tasks = [
        asyncio.create_task(_send(socket, outbox, gateway.settings.send_timeout_s)),
        asyncio.create_task(_receive(socket)),
    ]
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        reason = next(iter(done)).result()
        if reason:
            gateway.metrics.sockets_dropped.labels(reason).inc()
            with contextlib.suppress(TimeoutError, RuntimeError, WebSocketDisconnect):
                await asyncio.wait_for(socket.close(TRY_LATER, reason), CLOSE_S)
    finally:
        gateway.hub.leave(robot, outbox)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def _send(socket: WebSocket, outbox: Outbox, timeout_s: float) -> str:
    """Send until the reader leaves ("") or proves too slow."""
    try:
        while not outbox.overflowed:
            for text in await outbox.take():
                async with asyncio.timeout(timeout_s):
                    await socket.send_text(text)
    except TimeoutError:
        return "slow"
    except (WebSocketDisconnect, RuntimeError):
        return ""
    return "overflow"


async def _receive(socket: WebSocket) -> str:
    """Nothing is expected from the reader but its leaving."""
    with contextlib.suppress(WebSocketDisconnect, RuntimeError, KeyError):
        while True:
            await socket.receive_text()
    return ""
