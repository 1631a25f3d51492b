"""Zenoh settings of the router: it introduces peers, or lets clients in by certificate and access rules."""

from collections.abc import Sequence

import zenoh

from shared.access.credentials import Credentials, CredentialsError, secured_endpoint
from shared.access.router_policy import access_control
from shared.transport.session_config import session_config


def router_config(listen: str) -> zenoh.Config:
    """Settings of the router, which introduces the peers to each other.

    Raises:
        CredentialsError: as for `peer_config`.
    """
    if listen.startswith("tls/"):
        raise CredentialsError(
            f"{listen} is to be secured: set TOPNAV_CERTS to a folder of 'topnav certs', got none"
        )
    return session_config("router", [listen], [])


def secured_router_config(listen: str, credentials: Credentials, robots: Sequence[str]) -> zenoh.Config:
    """Settings of the router that lets in who has a certificate, and lets pass what the table allows.

    Raises:
        ValueError: `robots` has no name or a bad one.
    """
    tls = {
        "root_ca_certificate": str(credentials.authority),
        "listen_certificate": str(credentials.certificate),
        "listen_private_key": str(credentials.key),
        "enable_mtls": True,
        "close_link_on_expiration": True,
    }
    closed = {
        "scouting/gossip/enabled": False,
        "transport/link/tls": tls,
        "access_control": access_control(robots),
    }
    return session_config("router", [secured_endpoint(listen)], [], closed)
