"""Settings of the gateway, read from GATEWAY_*."""

import ipaddress
from pathlib import Path
from typing import Self

from pydantic import Field, HttpUrl, SecretStr, model_validator
from pydantic_settings import SettingsConfigDict

from shared.settings import ServiceSettings

MB = 1_000_000


class GatewaySettings(ServiceSettings):
    """What may be set.

    Attributes:
        host, port: address to serve on.
        map_store_url: where the map store's REST interface is.
        map_store_token: secret of the map store, if it asks for one.
        token: secret every write must carry as `Authorization: Bearer`; empty asks for none.
        allow_open: serve on a reachable address without a token all the same.
        allowed_origins: further origins whose pages may use this gateway, for example "https://lab.example".
        allowed_hosts: further host names it answers to while on loopback; they stop DNS rebinding.
        max_upload_bytes: longest goal picture.
        max_import_bytes: longest map archive.
        upload_timeout_s: how long one body may take to arrive.
        max_uploads: pictures read at once; more are told to come again.
        max_sockets: WebSockets open at once.
        send_timeout_s: how long one WebSocket may take to accept a message before it is dropped.
        max_robots: robots followed at once; further names are ignored.
        ask_timeout_s: how long planner and map store may take.
        compute_timeout_s: how long extraction and matching may take.
        runs_dir: where ended missions are written down and commands leave their figures.
        required_services: readiness needs one living process of each.
    """

    model_config = SettingsConfigDict(env_prefix="GATEWAY_", frozen=True, extra="forbid")

    host: str = "127.0.0.1"
    port: int = Field(default=8000, ge=0, le=65_535)
    map_store_url: HttpUrl = HttpUrl("http://127.0.0.1:8001")
    map_store_token: SecretStr = SecretStr("")
    token: SecretStr = SecretStr("")
    allow_open: bool = False
    allowed_origins: tuple[str, ...] = ()
    allowed_hosts: tuple[str, ...] = ()
    max_upload_bytes: int = Field(default=20 * MB, ge=1_000, le=60 * MB)
    max_import_bytes: int = Field(default=512 * MB, ge=1_000)
    upload_timeout_s: float = Field(default=30.0, gt=0.0)
    max_uploads: int = Field(default=8, ge=1)
    max_sockets: int = Field(default=32, ge=1)
    max_robots: int = Field(default=32, ge=1)
    send_timeout_s: float = Field(default=5.0, gt=0.0)
    ask_timeout_s: float = Field(default=5.0, gt=0.0)
    compute_timeout_s: float = Field(default=20.0, gt=0.0)
    runs_dir: Path = Path("data/runs")
    required_services: tuple[str, ...] = ("features", "map_store", "planner")

    @model_validator(mode="after")
    def _closed_unless_asked(self) -> Self:
        if not self.loopback and not self.token.get_secret_value() and not self.allow_open:
            raise ValueError(
                f"GATEWAY_HOST {self.host} is reachable from other machines and GATEWAY_TOKEN is empty: "
                "set a token, serve on 127.0.0.1, or let anyone drive the robot with GATEWAY_ALLOW_OPEN=true"
            )
        return self

    @property
    def loopback(self) -> bool:
        """Whether only this machine can connect."""
        if self.host == "localhost":
            return True
        try:
            return ipaddress.ip_address(self.host).is_loopback
        except ValueError:
            return False
