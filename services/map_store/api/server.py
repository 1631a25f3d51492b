"""REST beside the bus: uvicorn in a thread of the same process."""

import logging
import socket
import ssl
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import uvicorn
from fastapi import FastAPI

from services.map_store.api.certified import certified_protocol
from shared.access.credentials import Credentials
from shared.web.patience import Patience, patient_protocol

log = logging.getLogger(__name__)

MAX_CONNECTIONS = 200
STOP_TIMEOUT_S = 5
HEADER_S, UNREAD_S = 10.0, 120.0


@contextmanager
def serve(app: FastAPI, host: str, port: int, credentials: Credentials | None = None) -> Iterator[int]:
    """Serve `app` while the block runs and give the port; it is bound here, so a taken one is an error.

    With `credentials` it is HTTPS, and only for those who show a certificate that may write maps.
    """
    with socket.create_server((host, port), family=_family(host), backlog=256) as listening:
        bound = int(listening.getsockname()[1])
        config = uvicorn.Config(
            app,
            log_config=None,
            access_log=False,
            server_header=False,
            limit_concurrency=MAX_CONNECTIONS,
            timeout_graceful_shutdown=STOP_TIMEOUT_S,
            **(_secured(credentials) if credentials else _open()),
        )
        server = uvicorn.Server(config)
        thread = threading.Thread(target=server.run, args=([listening],), name="rest", daemon=True)
        thread.start()
        log.info("REST on %s://%s:%d/docs", "https" if credentials else "http", host, bound)
        try:
            yield bound
        finally:
            server.should_exit = True
            thread.join(STOP_TIMEOUT_S + 1)


def _open() -> dict[str, Any]:
    return {"http": patient_protocol(Patience(HEADER_S, UNREAD_S, MAX_CONNECTIONS))}


def _secured(credentials: Credentials) -> dict[str, Any]:
    return {
        "http": certified_protocol(Patience(HEADER_S, UNREAD_S, MAX_CONNECTIONS)),
        "ssl_certfile": credentials.certificate,
        "ssl_keyfile": credentials.key,
        "ssl_ca_certs": str(credentials.authority),
        "ssl_cert_reqs": ssl.CERT_REQUIRED,
    }


def _family(host: str) -> socket.AddressFamily:
    return socket.AF_INET6 if ":" in host else socket.AF_INET
