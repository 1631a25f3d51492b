"""Where a process keeps its certificate, and what becomes of an endpoint that is secured by it."""

import os
import ssl
from dataclasses import dataclass
from pathlib import Path

AUTHORITY_FILE, CERTIFICATE_FILE, KEY_FILE = "authority.pem", "certificate.pem", "key.pem"
MAP_STORE_HOST = "map-store"
"""Name in the certificate of the map store's REST interface, whatever address it is reached at."""
FILES = (AUTHORITY_FILE, CERTIFICATE_FILE, KEY_FILE)


class CredentialsError(ValueError):
    """A certificate folder that cannot be used; the service must not start without security instead."""


@dataclass(frozen=True)
class Credentials:
    """The three files that make a process known on the secured bus."""

    authority: Path
    certificate: Path
    key: Path

    def tls_context(self, purpose: ssl.Purpose) -> ssl.SSLContext:
        """Settings for HTTPS in which both sides show a certificate of the same authority.

        Args:
            purpose: SERVER_AUTH for a client, CLIENT_AUTH for a server.

        Raises:
            CredentialsError: the files are damaged or do not belong together.
        """
        try:
            context = ssl.create_default_context(purpose, cafile=self.authority)
            context.load_cert_chain(self.certificate, self.key)
        except OSError as error:  # ssl.SSLError is one
            raise CredentialsError(
                f"{self.certificate.parent}: {FILES} do not make a usable certificate: {error}; "
                "make new ones with 'topnav certs --renew'"
            ) from error
        context.verify_mode = ssl.CERT_REQUIRED
        return context


def credentials_in(folder: Path | None) -> Credentials | None:
    """The certificate in `folder`; None where there is no folder, or one without any file (not secured).

    Raises:
        CredentialsError: the folder is missing, unreadable, half filled, or its files do not fit.
    """
    if folder is None:
        return None
    try:
        there = {path.name for path in folder.iterdir()}
    except OSError as error:
        raise CredentialsError(f"TOPNAV_CERTS={folder}: cannot be read: {error.strerror}") from error
    if not there:
        return None
    missing = [name for name in FILES if name not in there]
    if missing:
        raise CredentialsError(
            f"TOPNAV_CERTS={folder}: {', '.join(FILES)} expected, {', '.join(missing)} missing; "
            "run 'topnav certs', or empty the folder to run without security"
        )
    unreadable = [name for name in FILES if not os.access(folder / name, os.R_OK)]
    if unreadable:
        raise CredentialsError(f"TOPNAV_CERTS={folder}: {', '.join(unreadable)} cannot be read by this user")
    credentials = Credentials(*(folder / name for name in FILES))
    credentials.tls_context(ssl.Purpose.SERVER_AUTH)
    return credentials


def secured_endpoint(endpoint: str) -> str:
    """The same place over TLS: "tcp/router:7447" becomes "tls/router:7447"."""
    return f"tls/{endpoint.partition('/')[2]}" if endpoint.startswith("tcp/") else endpoint


def secured_url(url: str) -> str:
    """The same place over TLS: "http://..." becomes "https://..."."""
    return f"https{url[4:]}" if url.startswith("http://") else url
