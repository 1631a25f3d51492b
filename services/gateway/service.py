"""The gateway as a process: the HTTP server on a thread, the main thread waits for the signal to stop."""

import resource
import threading

from services.gateway.app import create_app
from services.gateway.routes.estop import STOP_PATH
from services.gateway.settings import GatewaySettings
from shared.bus import Bus
from shared.web.crowding import RESERVE, ConnectionLimits
from shared.web.server import serving
from shared.web.sockets import SparingSocketProtocol

GRACE_S = 1
"""For requests under way: with the rest of the shutdown less than the 2 s in which a signal must end it."""
LOOK_S = 0.5
"""How soon a server that ended by itself is noticed."""
UNREAD_S = 30.0
"""Like GATEWAY_UPLOAD_TIMEOUT_S: who takes nothing for that long has gone."""
OTHER_FILES = 256
"""Beside connections: the bus, pictures, scripts and libraries; a process with none has 60 open."""
MAX_WAITING_CONNECTIONS = 256
"""What one address may have open, as GATEWAY_MAX_CONNECTIONS_PER_CLIENT."""


def run(settings: GatewaySettings, bus: Bus, stop: threading.Event) -> None:
    """Serve until `stop` is set; announces itself once it answers.

    Raises:
        RuntimeError: the server did not start, for example because the port is taken, or ended by itself.
    """
    _allow_files(settings.max_connections + RESERVE + settings.max_sockets + OTHER_FILES)
    limits = ConnectionLimits(
        header_s=settings.header_timeout_s,
        unread_s=UNREAD_S,
        most=settings.max_connections,
        most_per_client=settings.max_connections_per_client,
        unlimited=settings.proxies,
        always=STOP_PATH,
    )
    with serving(
        create_app(settings, bus),
        settings.host,
        settings.port,
        limits,
        stop=stop,
        grace_s=GRACE_S,
        loop="asyncio",
        ws=SparingSocketProtocol,
        ws_per_message_deflate=False,  # a compressor for each reader costs more than it saves
        backlog=MAX_WAITING_CONNECTIONS,
        proxy_headers=bool(settings.proxies),
        forwarded_allow_ips=list(settings.proxies),
    ) as server:
        bus.announce("gateway")
        while server.is_alive() and not stop.wait(LOOK_S):
            pass
        if not stop.is_set():
            raise RuntimeError("the HTTP server ended by itself: see the log")


def _allow_files(count: int) -> None:
    """Raise this process's limit of open files where that is allowed: each connection is one."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft < count:
        most = count if hard == resource.RLIM_INFINITY else min(count, hard)
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, hard))
