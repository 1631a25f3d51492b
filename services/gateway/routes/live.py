"""The WebSocket of live events: status, decisions, heading, ranges and new frames of one robot as JSON."""

import asyncio
import contextlib

from fastapi import APIRouter, WebSocket, WebSocketDisconnect

from services.gateway.auth.guard import Person, access_of, admit_socket
from services.gateway.http.problems import counted
from services.gateway.http.rates import address_of
from services.gateway.live.outbox import Outbox
from services.gateway.state import Gateway, gateway_of
from shared.transport.keys import RESERVED, is_robot
from shared.web.problems import ProblemError

router = APIRouter(tags=["live"])

CLOSE_S = 1.0
"""Chosen: how long a reader that has to leave may take to say goodbye."""
POLICY, TRY_LATER = 1008, 1013
"""Close codes, RFC 6455, 7.4, and IANA's registry."""
PACE_S = 0.04
"""Between two batches of news: 25 a second look like motion."""
PACE_PER_SOCKET_S = 0.002
"""500 readers get one batch a second each; drive does not notice (tests/benchmarks/test_gateway_load.py)."""


@router.websocket("/api/robots/{robot}/live")
async def live(socket: WebSocket, robot: str) -> None:
    """Send `{"type": ..., "data": ...}`: first what is known, then the news.

    Who may not come in gets an HTTP answer instead; where there is no room, close code 1013 after the start,
    because pages cannot read the former.
    """
    gateway = gateway_of(socket)
    try:
        person = admit_socket(socket)
        _check_name(robot)
    except ProblemError as problem:
        gateway.metrics.sockets_refused.labels(problem.code).inc()
        await socket.send_denial_response(counted(problem, socket.url.path, gateway.metrics))
        return
    try:
        with gateway.sockets.hold(address_of(socket)):
            gateway.metrics.sockets.set(gateway.sockets.taken)
            await socket.accept()
            await _serve(socket, gateway, robot, person)
    except ProblemError as problem:
        gateway.metrics.sockets_refused.labels(problem.code).inc()
        await socket.accept()
        await _close(socket, TRY_LATER, problem.code)
    finally:
        gateway.metrics.sockets.set(gateway.sockets.taken)


def _check_name(robot: str) -> None:
    if not is_robot(robot):
        expected = f"a robot's name of a-z, 0-9, _ and -, none of {', '.join(RESERVED)}"
        raise ProblemError(422, "invalid_request", expected, repr(robot[:80]), "see /api/robots")


async def _serve(socket: WebSocket, gateway: Gateway, robot: str, person: Person) -> None:
    outbox = gateway.hub.join(robot)
    if outbox is None:
        await _close(socket, TRY_LATER, "too_many_robots")
        return
    tasks = [
        asyncio.create_task(_send(socket, outbox, gateway, person)),
        asyncio.create_task(_receive(socket)),
    ]
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        reason = next(iter(done)).result()
        if reason:
            gateway.metrics.sockets_dropped.labels(reason).inc()
            await _close(socket, POLICY if reason == "token_removed" else TRY_LATER, reason)
    finally:
        gateway.hub.leave(robot, outbox)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def _close(socket: WebSocket, code: int, reason: str) -> None:
    with contextlib.suppress(TimeoutError, RuntimeError, WebSocketDisconnect):
        await asyncio.wait_for(socket.close(code, reason), CLOSE_S)


async def _send(socket: WebSocket, outbox: Outbox, gateway: Gateway, person: Person) -> str:
    """Send until the reader leaves ("") or has to: too slow, or no longer somebody who may read.

    The more readers there are, the longer each waits for the next batch of news: their number must not take
    the processor from the services that drive.
    """
    try:
        while not outbox.overflowed:
            for text in await outbox.take():
                async with asyncio.timeout(gateway.settings.send_timeout_s):
                    await socket.send_text(text)
            if not access_of(socket).holds(person):
                return "token_removed"
            await asyncio.sleep(max(PACE_S, gateway.sockets.taken * PACE_PER_SOCKET_S))
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
