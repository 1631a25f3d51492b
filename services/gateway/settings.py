"""Settings of the gateway, read from GATEWAY_*."""

import logging
from pathlib import Path
from typing import Self

from pydantic import Field, HttpUrl, SecretStr, model_validator
from pydantic_settings import SettingsConfigDict

from shared.access.tokens import check_chosen, kept_secret
from shared.settings import OptionalPath, ServiceSettings
from shared.web.origins import is_loopback

log = logging.getLogger(__name__)

MB = 1_000_000


class GatewaySettings(ServiceSettings):
    """What may be set.

    Attributes:
        host, port: address to serve on.
        map_store_url: where the map store's REST interface is.
        map_store_token: secret of the map store, if it asks for one.
        token: secret of the one admin token without a name, sent as `Authorization: Bearer`; empty for none.
        token_file: where a secret is kept that is made when it is missing, for reachable addresses without
            `token` and `tokens_file`, and for a map store that keeps its own there.
        tokens_file: tokens with names and roles, made by `topnav token add`; read again when it changes.
        guard_reading: reading needs a token, too; unset: off loopback only.
        estop_needs_token: engaging the emergency stop asks for a token (any role); off: anybody may stop.
        allow_open: serve on a reachable address without a token all the same.
        allowed_origins: further origins whose pages may use this gateway, for example "https://lab.example".
        allowed_hosts: further host names it answers to while on loopback; they stop DNS rebinding.
        proxies: addresses of reverse proxies whose X-Forwarded-For is believed.
        max_upload_bytes: longest goal picture.
        max_import_bytes: longest map archive.
        upload_timeout_s: how long one body may take to arrive; an archive gets longer as long as it flows.
        header_timeout_s: how long a connection may take to send the head of a request.
        max_uploads: pictures read at once; more are told to come again.
        max_uploads_per_client: of these by one address.
        max_imports: archives received at once.
        writes_per_s, write_burst: of one client: address, or token where there is one.
        uploads_per_s, upload_burst: pictures and archives of one client.
        comparisons_per_s, comparison_burst: pictures compared for one client.
        max_comparisons, max_comparisons_per_client: of these at once; robots ask the same service.
        failures_per_s, failure_burst: wrong tokens of one address; more are not looked at.
        max_connections: connections open at once.
        max_connections_per_client: of these by one address, WebSockets not counted.
        max_sockets: WebSockets open at once.
        max_sockets_per_client: of these by one address.
        send_timeout_s: how long one WebSocket may take to accept a message before it is dropped.
        max_robots: robots followed at once; further names are ignored.
        ask_timeout_s: how long planner and map store may take.
        compute_timeout_s: how long extraction and matching may take.
        runs_dir: where ended missions are written down and commands leave their figures.
        required_services: readiness needs one living process of each; all that a robot needs to go.
    """

    model_config = SettingsConfigDict(env_prefix="GATEWAY_", frozen=True, extra="forbid")

    host: str = "127.0.0.1"
    port: int = Field(default=8000, ge=0, le=65_535)
    map_store_url: HttpUrl = HttpUrl("http://127.0.0.1:8001")
    map_store_token: SecretStr = SecretStr("")
    token: SecretStr = SecretStr("")
    token_file: OptionalPath = None
    tokens_file: OptionalPath = None
    guard_reading: bool | None = None
    estop_needs_token: bool = False
    allow_open: bool = False
    allowed_origins: tuple[str, ...] = ()
    allowed_hosts: tuple[str, ...] = ()
    proxies: tuple[str, ...] = ()
    max_upload_bytes: int = Field(default=20 * MB, ge=1_000, le=60 * MB)
    max_import_bytes: int = Field(default=512 * MB, ge=1_000)
    upload_timeout_s: float = Field(default=30.0, gt=0.0)
    header_timeout_s: float = Field(default=10.0, gt=0.0)
    max_uploads: int = Field(default=8, ge=1)
    max_uploads_per_client: int = Field(default=4, ge=1)
    max_imports: int = Field(default=2, ge=1)
    writes_per_s: float = Field(default=10.0, gt=0.0)
    write_burst: int = Field(default=100, ge=1)
    uploads_per_s: float = Field(default=2.0, gt=0.0)
    upload_burst: int = Field(default=20, ge=1)
    comparisons_per_s: float = Field(default=5.0, gt=0.0)
    comparison_burst: int = Field(default=20, ge=1)
    max_comparisons: int = Field(default=3, ge=1)
    max_comparisons_per_client: int = Field(default=2, ge=1)
    failures_per_s: float = Field(default=0.2, gt=0.0)
    failure_burst: int = Field(default=10, ge=1)
    max_connections: int = Field(default=1024, ge=1)
    max_connections_per_client: int = Field(default=256, ge=1)
    max_sockets: int = Field(default=256, ge=1)
    max_sockets_per_client: int = Field(default=64, ge=1)
    max_robots: int = Field(default=32, ge=1)
    send_timeout_s: float = Field(default=5.0, gt=0.0)
    ask_timeout_s: float = Field(default=5.0, gt=0.0)
    compute_timeout_s: float = Field(default=20.0, gt=0.0)
    runs_dir: Path = Path("data/runs")
    required_services: tuple[str, ...] = ("features", "map_store", "planner", "drive")

    @model_validator(mode="after")
    def _closed_unless_asked(self) -> Self:
        secret = self.token.get_secret_value()
        if self.loopback or self.allow_open:
            return self
        if secret:
            check_chosen(secret, "GATEWAY_TOKEN")
        elif self.tokens_file is None and self.token_file is None:
            raise ValueError(
                f"GATEWAY_HOST {self.host} is reachable from other machines and GATEWAY_TOKEN is empty: "
                "set a token or GATEWAY_TOKENS_FILE, serve on 127.0.0.1, or let anyone drive the robot "
                "with GATEWAY_ALLOW_OPEN=true"
            )
        return self

    def with_kept_secret(self) -> Self:
        """With the secrets that nobody chose taken from `token_file`, which is made where it is missing.

        Raises:
            ValueError: it cannot be.
        """
        if self.token_file is None or (self.loopback and self.tokens_file is None):
            return self
        secret, chosen = SecretStr(kept_secret(self.token_file)), {}
        if not self.token.get_secret_value() and self.tokens_file is None:
            chosen["token"] = secret
            log.warning(
                "no TOPNAV_TOKEN was set: the admin's secret is in %s of this service", self.token_file
            )
        if not self.map_store_token.get_secret_value():
            chosen["map_store_token"] = secret
        return self.model_copy(update=chosen)

    @property
    def loopback(self) -> bool:
        """Whether only this machine can connect."""
        return is_loopback(self.host)

    @property
    def reading_guarded(self) -> bool:
        """Whether reading asks for a token, where there are tokens at all."""
        return not self.loopback if self.guard_reading is None else self.guard_reading
