"""Which tokens this gateway takes: GATEWAY_TOKEN and a file that is read again when it changes."""

import logging
from pathlib import Path
from typing import Self

from services.gateway.settings import GatewaySettings
from shared.access.tokens import Token, digest_of, find, read_tokens

log = logging.getLogger(__name__)


class ValidTokens:
    """The tokens of now. Lives in the asyncio thread.

    Args:
        secret: of the one unnamed admin token, empty for none.
        path: token file, None for none.
    """

    def __init__(self, secret: str, path: Path | None) -> None:
        self._single = (Token(role="admin", sha256=digest_of(secret)),) if secret else ()
        self._path, self._tokens = path, self._single
        self._seen: tuple[int, ...] | None = None

    @classmethod
    def chosen(cls, settings: GatewaySettings) -> Self:
        """The tokens of these settings.

        Raises:
            ValueError: the file named cannot be read, or nobody could come in.
        """
        secret, path = settings.token.get_secret_value(), settings.tokens_file
        if path is not None and not read_tokens(path) and not secret:
            raise ValueError(
                f"GATEWAY_TOKENS_FILE {path} holds no token: make one with "
                f"'topnav token add NAME --role admin {path}'"
            )
        return cls(secret, path)

    @property
    def required(self) -> bool:
        """Whether tokens are asked for: one was set, or a file was named, be it empty by now."""
        return bool(self._single) or self._path is not None

    def find(self, secret: str) -> Token | None:
        """The token of a secret."""
        return find(self._now(), secret)

    def named(self, name: str) -> Token | None:
        """The token of a name; "" is that of GATEWAY_TOKEN."""
        return next((token for token in self._now() if token.name == name), None)

    def __contains__(self, token: Token) -> bool:
        return token in self._now()

    def _now(self) -> tuple[Token, ...]:
        """Read the file if it changed. One that cannot be read opens nothing: who was removed stays out."""
        if self._path is not None and (seen := _state_of(self._path)) != self._seen:
            self._seen = seen
            try:
                self._tokens = (*self._single, *read_tokens(self._path))
                log.info("token file read: %d tokens", len(self._tokens) - len(self._single))
            except ValueError as error:
                self._tokens = self._single
                log.error("no token of the file is taken any more: %s", error)
        return self._tokens


def _state_of(path: Path) -> tuple[int, ...]:
    """What changes with a file; nothing where there is none."""
    try:
        stat = path.stat()
    except OSError:
        return ()
    return stat.st_ctime_ns, stat.st_mtime_ns, stat.st_size, stat.st_ino
