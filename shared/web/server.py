"""An HTTP server beside a service's own loop: uvicorn on a thread of the same process."""

import logging
import ssl
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

import uvicorn
from starlette.types import ASGIApp

from shared.access.credentials import Credentials
from shared.inbox import wait_until
from shared.web.connections import limited_protocol
from shared.web.crowding import ConnectionLimits

log = logging.getLogger(__name__)

START_S = 30.0
"""An application starts within a second; a machine under load takes many times that."""
CLOSING_S = 0.8
"""Beyond the time for requests under way: uvicorn's own pauses while it closes, and the lifespan's end."""


@contextmanager
def serving(
    app: ASGIApp,
    host: str,
    port: int,
    limits: ConnectionLimits,
    *,
    stop: threading.Event,
    grace_s: int,
    credentials: Credentials | None = None,
    **options: Any,
) -> Iterator[threading.Thread]:
    """Serve `app` while the block runs and give the thread that does it; it answers once the block begins.

    Args:
        app: the application.
        host: address to listen on.
        port: of that address; 0 takes any free one.
        limits: of each connection.
        stop: ends the waiting for the start.
        grace_s: how long requests under way may take once the block has ended.
        credentials: with these it is HTTPS, and clients must show a certificate of the same authority.
        options: further ones of `uvicorn.Config`.

    Raises:
        RuntimeError: the server did not start, for example because the port is taken.
    """
    config = uvicorn.Config(
        app,
        host=host,
        port=port,
        http=limited_protocol(limits),
        timeout_graceful_shutdown=grace_s,
        log_config=None,
        access_log=False,
        server_header=False,
        **options,
        **(_secured(credentials) if credentials else {}),
    )
    server = uvicorn.Server(config)
    place = f"[{host}]" if ":" in host else host  # RFC 3986, 3.2.2: else an IPv6 address ends in a port
    thread = threading.Thread(target=_run, args=(server,), name="http", daemon=True)
    thread.start()
    try:
        wait_until(lambda: server.started or not thread.is_alive() or stop.is_set(), START_S)
        if server.started:
            bound = server.servers[0].sockets[0].getsockname()[1]
            log.info("serving on %s://%s:%d", "https" if credentials else "http", place, bound)
        elif not stop.is_set():
            raise RuntimeError(f"no HTTP on {place}:{port}: see the log; is the port taken?")
        yield thread
    finally:
        server.should_exit = True
        thread.join(grace_s + CLOSING_S)


def _run(server: uvicorn.Server) -> None:
    with suppress(SystemExit):  # uvicorn's way to say that it could not start; the reason is in the log
        server.run()


def _secured(credentials: Credentials) -> dict[str, Any]:
    return {
        "ssl_certfile": credentials.certificate,
        "ssl_keyfile": credentials.key,
        "ssl_ca_certs": str(credentials.authority),
        "ssl_cert_reqs": ssl.CERT_REQUIRED,
    }
