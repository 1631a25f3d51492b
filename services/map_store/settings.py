"""Settings of the map store."""

from pydantic import Field, SecretStr
from pydantic_settings import SettingsConfigDict

from shared.settings import ServiceSettings


class MapStoreSettings(ServiceSettings):
    """Read from the environment, for example MAP_STORE_PORT=8001.

    Attributes:
        database_url: SQLAlchemy URL; sqlite:///relative/file, sqlite:////absolute/file or postgresql+psycopg://...
        host, port: where REST listens; port 0 takes any free one.
        token: bearer token that writes over REST need; empty = none.
        max_archive_bytes: largest archive that may be imported, packed and unpacked.
    """

    model_config = SettingsConfigDict(env_prefix="MAP_STORE_")

    database_url: str = "sqlite:///data/map_store/maps.sqlite3"
    host: str = "127.0.0.1"
    port: int = Field(default=8001, ge=0, le=65_535)
    token: SecretStr = SecretStr("")
    max_archive_bytes: int = Field(default=4_000_000_000, ge=1)
