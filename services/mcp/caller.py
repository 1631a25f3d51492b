"""Requests to the gateway in the name of whoever calls a tool."""

from contextvars import ContextVar
from typing import Any

import httpx
from mcp.server.mcpserver.exceptions import ToolError

Facts = dict[str, Any]
"""An object of the gateway's JSON, whose OpenAPI document says what is in it."""

ASK_S = 30.0
"""Longer than the gateway's own patience with the services behind it."""
LONGEST = 400
"""Characters of a refusal that are passed on."""

CALLER: ContextVar[str | None] = ContextVar("caller", default=None)
"""What the program that asks shows for itself, as an Authorization header; None over stdio."""


class Caller:
    """Asks as the program that calls: over HTTP with the token of its request, over stdio with `secret`."""

    def __init__(self, client: httpx.AsyncClient, secret: str) -> None:
        self._client, self._secret = client, secret

    async def json(self, method: str, path: str, **sent: Any) -> Facts:
        """The object that a request answers; raises as `send`."""
        told: Facts = (await self.send(method, path, **sent)).json()
        return told

    async def list(self, path: str, **sent: Any) -> list[Facts]:
        """The objects that a question answers; raises as `send`."""
        told: list[Facts] = (await self.send("GET", path, **sent)).json()
        return told

    async def send(self, method: str, path: str, **sent: Any) -> httpx.Response:
        """The answer to a request.

        Raises:
            ToolError: the gateway refuses or is not there.
        """
        shown = CALLER.get()
        if shown is None and self._secret:
            shown = f"Bearer {self._secret}"
        headers = {"Authorization": shown} if shown else {}
        try:
            answer = await self._client.request(method, path, headers=headers, **sent)
        except httpx.HTTPError as error:
            raise ToolError(
                f"the gateway at {self._client.base_url} does not answer ({type(error).__name__}): "
                "see whether topnav runs"
            ) from error
        if answer.is_error:
            raise ToolError(_refusal(answer))
        return answer


def _refusal(answer: httpx.Response) -> str:
    """Why, in the gateway's words."""
    try:
        problem = answer.json()
        told = f"{problem['title']}: {problem['detail']}"
    except (ValueError, KeyError, TypeError):
        told = answer.text
    return f"refused ({answer.status_code}), {told}"[:LONGEST]
