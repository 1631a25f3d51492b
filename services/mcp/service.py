"""Serving over stdio or HTTP."""

import logging
import sys
from http import HTTPStatus

import httpx
from mcp.server.transport_security import TransportSecuritySettings

from services.mcp.caller import ASK_S
from services.mcp.gateway import Gateway
from services.mcp.server import build_server
from services.mcp.settings import LOOPBACK, McpSettings

OPEN = (
    "mcp: the gateway at {url} asks nobody for a token, and MCP_HOST={host} can be reached from elsewhere: "
    "anybody could send the robot somewhere. Make tokens ('topnav token add'), or serve on 127.0.0.1\n"
)


async def serve(settings: McpSettings) -> None:
    """Serve over the transport of the settings; a program that shows no token of its own borrows none.

    Raises:
        SystemExit: an open gateway would be reached through an address that is not loopback.
    """
    logging.getLogger("httpx").setLevel(logging.WARNING)  # a line for every call says nothing
    url = str(settings.gateway_url)
    async with httpx.AsyncClient(base_url=url, timeout=ASK_S, trust_env=False) as client:
        server = build_server(Gateway(settings, client), settings.log_level)
        if settings.transport == "stdio":
            await server.run_stdio_async()
            return
        if settings.host not in LOOPBACK and not await _asks_for_tokens(client):
            sys.stderr.write(OPEN.format(url=url, host=settings.host))
            sys.exit(2)
        await server.run_streamable_http_async(
            host=settings.host,
            port=settings.port,
            stateless_http=True,
            transport_security=_only_this_machine(settings),
        )


def _only_this_machine(settings: McpSettings) -> TransportSecuritySettings:
    """On loopback foreign host names are DNS rebinding; elsewhere tokens decide."""
    names = [f"[{name}]" if ":" in name else name for name in sorted(LOOPBACK)]
    return TransportSecuritySettings(
        enable_dns_rebinding_protection=settings.host in LOOPBACK,
        allowed_hosts=[f"{name}:{settings.port}" for name in names],
        allowed_origins=[f"http://{name}:{settings.port}" for name in names],
    )


async def _asks_for_tokens(client: httpx.AsyncClient) -> bool:
    """Whether the gateway turns away somebody without a token; one that is not there does."""
    try:
        answer = await client.post("/api/session")
    except httpx.HTTPError:
        return True
    return answer.status_code == HTTPStatus.UNAUTHORIZED
