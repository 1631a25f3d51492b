"""Settings of the MCP server, from MCP_*."""

from typing import Annotated, Literal, Self

from pydantic import Field, HttpUrl, SecretStr, StringConstraints, model_validator
from pydantic_settings import SettingsConfigDict

from shared.settings import ServiceSettings

LOOPBACK = frozenset({"127.0.0.1", "localhost", "::1"})


class McpSettings(ServiceSettings):
    """Which robot a program may ask for what, and how it asks.

    Attributes:
        gateway_url: gateway that carries out what is asked; its tokens, roles and limits hold.
        token: secret of the program's token, role agent; over stdio only.
        map: map that questions are about.
        transport: stdio: one program, which started this one; http: any, each with a token of its own.
        host, port: address to serve on, path /mcp.
    """

    model_config = SettingsConfigDict(env_prefix="MCP_", frozen=True, extra="forbid")

    gateway_url: HttpUrl = HttpUrl("http://127.0.0.1:8000")
    token: SecretStr = SecretStr("")
    map: Annotated[str, StringConstraints(pattern=r"^[a-z0-9_-]{1,64}$")] = "flat"
    transport: Literal["stdio", "http"] = "stdio"
    host: str = "127.0.0.1"
    port: int = Field(default=8002, ge=0, le=65_535)

    @model_validator(mode="after")
    def _nobody_borrows_a_token(self) -> Self:
        if self.transport == "http" and self.token.get_secret_value():
            raise ValueError(
                "MCP_TOKEN would be lent to whoever reaches the port: over http each program sends its own "
                "as Authorization: Bearer; unset MCP_TOKEN"
            )
        return self
