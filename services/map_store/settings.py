"""Settings of the map store."""

from typing import Self

from pydantic import Field, SecretStr, model_validator
from pydantic_settings import SettingsConfigDict

from shared.access.credentials import credentials_in
from shared.access.tokens import check_chosen, kept_secret
from shared.settings import OptionalPath, ServiceSettings
from shared.web.origins import is_loopback


class MapStoreSettings(ServiceSettings):
    """Read from the environment, for example MAP_STORE_PORT=8001.

    Attributes:
        database_url: sqlite:///relative/file, sqlite:////absolute/file or postgresql://user:password@host/database.
        host, port: where REST listens; port 0 takes any free one.
        token: bearer token that writes over REST need, off loopback reading as well; empty = none.
        token_file: where a secret is kept that is made when it is missing, without `token` for reachable
            addresses, and beside `tokens_file`.
        tokens_file: that of the gateway, not read here: where people need tokens, so do writes on loopback.
        allow_open: listen on a reachable address without a token all the same, as in a network of
            containers of which no port is published.
        max_archive_bytes: largest archive that may be imported, packed and unpacked.
        compute_timeout_s: how long matching one node of a map that is merged may take.
    """

    model_config = SettingsConfigDict(env_prefix="MAP_STORE_")

    database_url: str = "sqlite:///data/map_store/maps.sqlite3"
    host: str = "127.0.0.1"
    port: int = Field(default=8001, ge=0, le=65_535)
    token: SecretStr = SecretStr("")
    token_file: OptionalPath = None
    tokens_file: OptionalPath = None
    allow_open: bool = False
    max_archive_bytes: int = Field(default=4_000_000_000, ge=1)
    compute_timeout_s: float = Field(default=20.0, gt=0.0)

    @model_validator(mode="after")
    def _closed_unless_asked(self) -> Self:
        secret = self.token.get_secret_value()
        if self.loopback or self.allow_open or credentials_in(self.certs) is not None:
            return self
        if not secret and self.token_file is not None:
            return self
        if not secret:
            raise ValueError(
                f"MAP_STORE_HOST {self.host} is reachable from other machines and MAP_STORE_TOKEN is empty: "
                "set one (and GATEWAY_MAP_STORE_TOKEN), listen on 127.0.0.1, or where no port is published "
                "let everybody there change maps with MAP_STORE_ALLOW_OPEN=true"
            )
        check_chosen(secret, "MAP_STORE_TOKEN")
        return self

    def with_kept_secret(self) -> Self:
        """With the secret of `token_file` where one is needed and none was chosen.

        Raises:
            ValueError: it can be neither read nor made.
        """
        trusted = self.loopback and self.tokens_file is None
        if trusted or self.token_file is None or self.token.get_secret_value():
            return self
        return self.model_copy(update={"token": SecretStr(kept_secret(self.token_file))})

    @property
    def loopback(self) -> bool:
        """Whether only this machine can connect."""
        return is_loopback(self.host)
