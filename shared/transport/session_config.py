"""Zenoh session settings: peers on loopback, or clients of a router that knows everybody by certificate.

In the local profile peers find each other through the router and then talk directly. In the secured profile
nothing goes around the router: it alone listens, and it enforces the access rules.
"""

import json

import zenoh

from shared.access.credentials import Credentials, CredentialsError, secured_endpoint

LEASE_MS = 2000
"""A hung process is declared gone after this; a killed one at once."""
ONE_DIALS = {"peer": {"to_router": "always", "to_peer": "greater-zid"}}
"""Of two peers only one opens the connection. When both do, they share a session of two links; after a freeze
or a cut these expire one by one, and what is opened anew joins a session that one side has closed: they never
hear each other again (zenoh issue 2806)."""
JOIN_MS = 10_000
"""A client opens only with its router: this long it tries before it says that there is none for it."""


def peer_config(endpoint: str, listen: str = "tcp/127.0.0.1:0") -> zenoh.Config:
    """Settings of a service: a peer that keeps trying to reach `endpoint` and never waits for it.

    Raises:
        CredentialsError: the endpoint asks for TLS, and a peer without certificate has none.
    """
    _refuse_tls(endpoint)
    return session_config("peer", [listen], [endpoint], {"scouting/gossip/autoconnect_strategy": ONE_DIALS})


def client_config(endpoint: str, credentials: Credentials) -> zenoh.Config:
    """Settings of a service on the secured bus: it listens nowhere and trusts only its authority."""
    tls = {
        "root_ca_certificate": str(credentials.authority),
        "connect_certificate": str(credentials.certificate),
        "connect_private_key": str(credentials.key),
        "enable_mtls": True,
        "verify_name_on_connect": True,
    }
    closed = {"scouting/gossip/enabled": False, "transport/link/tls": tls, "connect/timeout_ms": JOIN_MS}
    return session_config("client", [], [secured_endpoint(endpoint)], closed)


def looker_config(endpoint: str) -> zenoh.Config:
    """Settings of who looks at the open bus for a moment: a client that does not wait long for the router.

    Raises:
        CredentialsError: as for `peer_config`.
    """
    _refuse_tls(endpoint)
    return session_config(
        "client", [], [endpoint], {"scouting/gossip/enabled": False, "connect/timeout_ms": 2_000}
    )


def _refuse_tls(endpoint: str) -> None:
    if endpoint.startswith("tls/"):
        raise CredentialsError(
            f"{endpoint} is a secured bus: set TOPNAV_CERTS to a folder of 'topnav certs', got none"
        )


def session_config(
    mode: str, listen: list[str], connect: list[str], more: dict[str, object] | None = None
) -> zenoh.Config:
    """What all sessions have in common, and `more` by path."""
    config = zenoh.Config()
    settings: dict[str, object] = {
        "mode": mode,
        "listen/endpoints": listen,
        "connect/endpoints": connect,
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": True,
        "connect/timeout_ms": -1,
        "connect/exit_on_failure": False,
        "connect/retry": {"period_init_ms": 200, "period_max_ms": 1000, "period_increase_factor": 1.5},
        "transport/link/tx/lease": LEASE_MS,
        "transport/shared_memory/enabled": False,
        "timestamping/enabled": True,
        **(more or {}),
    }
    for key, value in settings.items():
        config.insert_json5(key, json.dumps(value))
    return config
