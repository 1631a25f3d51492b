"""Zenoh session settings of the local profile: peers on loopback that find each other through the router."""

import json

import zenoh

LEASE_MS = 2000
"""A hung process is declared gone after this; a killed one at once."""


def peer_config(endpoint: str, listen: str = "tcp/127.0.0.1:0") -> zenoh.Config:
    """Settings of a service: a peer that keeps trying to reach `endpoint` and never waits for it."""
    return _config("peer", [listen], [endpoint])


def router_config(listen: str) -> zenoh.Config:
    """Settings of the router, which introduces the peers to each other."""
    return _config("router", [listen], [])


def _config(mode: str, listen: list[str], connect: list[str]) -> zenoh.Config:
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
    }
    for key, value in settings.items():
        config.insert_json5(key, json.dumps(value))
    return config
