"""REST beside the bus: the server, and what a connection to it may do."""

import threading
from contextlib import AbstractContextManager

from fastapi import FastAPI

from services.map_store.settings import MapStoreSettings
from shared.access.credentials import credentials_in
from shared.access.rules import Role
from shared.web.crowding import ConnectionLimits
from shared.web.server import serving

MAX_CONNECTIONS = 200
"""Chosen: there are few gateways and commands, each with a few connections."""
MAX_WAITING_CONNECTIONS = 256
"""Chosen: at least MAX_CONNECTIONS."""
GRACE_S = 5
"""For requests under way; chosen: half of what containers get to stop in."""
HEADER_S, UNREAD_S = 10.0, 120.0
"""Chosen: to send the head of a request; to take what was sent, for slow readers of archives."""
ADMITTED = frozenset({Role.GATEWAY.value, Role.OPERATOR.value, Role.MAP_STORE.value})
"""Common names. REST reads and writes alike, so it is for those whom the access rules let write maps."""


def serve(
    app: FastAPI, settings: MapStoreSettings, stop: threading.Event
) -> AbstractContextManager[threading.Thread]:
    """Serve `app` while the block runs; raises RuntimeError when it does not start, as on a taken port.

    With a certificate it is HTTPS, and only for those who show one that may write maps.
    """
    credentials = credentials_in(settings.certs)
    admitted = ADMITTED if credentials else None
    return serving(
        app,
        settings.host,
        settings.port,
        ConnectionLimits(HEADER_S, UNREAD_S, MAX_CONNECTIONS, MAX_CONNECTIONS, admitted=admitted),
        stop=stop,
        grace_s=GRACE_S,
        credentials=credentials,
        backlog=MAX_WAITING_CONNECTIONS,
    )
