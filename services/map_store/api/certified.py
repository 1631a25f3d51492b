"""REST for holders of a certificate that may write maps: others of the same authority are not even read."""

import asyncio
import logging
import ssl
from typing import Any, cast

from shared.access.rules import Role
from shared.web.patience import Patience, PatientProtocol

log = logging.getLogger(__name__)

ADMITTED = frozenset({Role.GATEWAY.value, Role.OPERATOR.value, Role.MAP_STORE.value})
"""Common names. REST reads and writes alike, so it is for those whom the access rules let write maps."""


class CertifiedProtocol(PatientProtocol):
    """HTTP over a TLS connection whose client has shown a certificate; TLS itself has checked the chain."""

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Hang up on those who may not."""
        name = common_name(transport.get_extra_info("ssl_object"))
        if name not in ADMITTED:
            log.warning("REST refused to %r: one of %s expected", name, sorted(ADMITTED))
            transport.abort()
            return
        super().connection_made(transport)

    def data_received(self, data: bytes) -> None:
        """Read, unless the connection was hung up."""
        if self.transport is not None:
            super().data_received(data)

    def connection_lost(self, exc: Exception | None) -> None:
        """End it; there is nothing to end for those who never came in."""
        if self.transport is not None:
            super().connection_lost(exc)


def certified_protocol(patience: Patience) -> type[asyncio.Protocol]:
    """What to give uvicorn as `http`."""

    class Protocol(CertifiedProtocol):
        def __init__(self, **options: Any) -> None:
            super().__init__(patience, **options)

    return cast(type[asyncio.Protocol], Protocol)


def common_name(connection: ssl.SSLObject | None) -> str:
    """Who has shown a certificate; "" for nobody."""
    certificate: dict[str, Any] = dict(connection.getpeercert() or {}) if connection is not None else {}
    for part in certificate.get("subject", ()):
        for name, value in part:
            if name == "commonName":
                return str(value)
    return ""
