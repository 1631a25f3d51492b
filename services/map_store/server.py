"""REST beside the bus: uvicorn in a thread of the same process."""

import logging
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import uvicorn
from fastapi import FastAPI

log = logging.getLogger(__name__)

MAX_CONNECTIONS = 200
STOP_TIMEOUT_S = 5


@contextmanager
def serve(app: FastAPI, host: str, port: int) -> Iterator[int]:
    """Serve `app` while the block runs and give the port; it is bound here, so a taken one is an error."""
    with socket.create_server((host, port), family=_family(host), backlog=256) as listening:
        bound = int(listening.getsockname()[1])
        config = uvicorn.Config(
            app,
            log_config=None,
            access_log=False,
            server_header=False,
            limit_concurrency=MAX_CONNECTIONS,
            timeout_graceful_shutdown=STOP_TIMEOUT_S,
        )
        server = uvicorn.Server(config)
        thread = threading.Thread(target=server.run, args=([listening],), name="rest", daemon=True)
        thread.start()
        log.info("REST on http://%s:%d/docs", host, bound)
        try:
            yield bound
        finally:
            server.should_exit = True
            thread.join(STOP_TIMEOUT_S + 1)


def _family(host: str) -> socket.AddressFamily:
    return socket.AF_INET6 if ":" in host else socket.AF_INET
