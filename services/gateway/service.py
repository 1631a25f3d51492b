"""The gateway as a process: uvicorn on its own thread, the main thread waits for the signal to stop."""

import logging
import resource
import threading

import uvicorn

from services.gateway.app import create_app
from services.gateway.settings import GatewaySettings
from shared.bus import Bus, wait_until
from shared.web.patience import Patience, patient_protocol

log = logging.getLogger(__name__)

START_S = 30.0
GRACE_S = 1
STOP_S = 1.8
MAX_SOCKET_MESSAGE_BYTES = 4096
UNREAD_S = 30.0
OTHER_FILES = 256
MAX_WAITING_CONNECTIONS = 256


def run(settings: GatewaySettings, bus: Bus, stop: threading.Event) -> None:
    """Serve until `stop` is set; announces itself once it answers.

    Raises:
        RuntimeError: the server did not start, for example because the port is taken.
    """
    _allow_files(settings.max_connections + OTHER_FILES)
    server = uvicorn.Server(_config(settings, bus))
    thread = threading.Thread(target=_serve, args=(server,), name="http", daemon=True)
    thread.start()
    wait_until(lambda: server.started or not thread.is_alive() or stop.is_set(), START_S)
    if not server.started and not stop.is_set():
        raise RuntimeError(f"no HTTP on {settings.host}:{settings.port}: see the log; is the port taken?")
    bus.announce("gateway")
    log.info("serving on http://%s:%d", settings.host, settings.port)
    while thread.is_alive() and not stop.wait(0.5):
        pass
    ended_alone = not stop.is_set()
    server.should_exit = True
    thread.join(STOP_S)
    if ended_alone:
        raise RuntimeError("the HTTP server ended by itself: see the log")


def _allow_files(count: int) -> None:
    """Raise this process's limit of open files where that is allowed: each connection is one."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft < count:
        most = count if hard == resource.RLIM_INFINITY else min(count, hard)
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, hard))


def _serve(server: uvicorn.Server) -> None:
    try:
        server.run()
    except SystemExit:  # uvicorn's way to say that it could not start; the reason is in the log
        log.error("the HTTP server could not start")


def _config(settings: GatewaySettings, bus: Bus) -> uvicorn.Config:
    patience = Patience(
        header_s=settings.header_timeout_s,
        unread_s=UNREAD_S,
        most_per_client=settings.max_connections_per_client,
        unlimited=settings.proxies,
    )
    return uvicorn.Config(
        create_app(settings, bus),
        host=settings.host,
        port=settings.port,
        loop="asyncio",
        http=patient_protocol(patience),
        ws="websockets-sansio",
        ws_max_size=MAX_SOCKET_MESSAGE_BYTES,
        ws_per_message_deflate=False,  # a compressor for each reader costs more than it saves
        limit_concurrency=settings.max_connections,
        backlog=MAX_WAITING_CONNECTIONS,
        proxy_headers=bool(settings.proxies),
        forwarded_allow_ips=list(settings.proxies),
        timeout_graceful_shutdown=GRACE_S,
        log_config=None,
        access_log=False,
        server_header=False,
    )
