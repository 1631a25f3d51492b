"""Who asks: HTTP's Basic and Digest, by the standard library. THETAs in a house's network want Digest."""

import base64
from urllib.error import URLError
from urllib.request import (
    AbstractDigestAuthHandler,
    HTTPPasswordMgrWithDefaultRealm,
    Request,
    parse_http_list,
    parse_keqv_list,
)

from services.camera.camera_url import CameraUrl
from services.camera.source import SourceError


def authorization(challenge: str, url: CameraUrl, method: str, path: str) -> str:
    """The header that answers a server's challenge.

    Raises:
        SourceError: it asks for something else than Basic or Digest.
    """
    scheme, _, rest = challenge.partition(" ")
    if scheme.lower() == "basic":
        return "Basic " + base64.b64encode(f"{url.user}:{url.password}".encode()).decode()
    if scheme.lower() == "digest":
        address = f"http://{url.host}{path}"
        passwords = HTTPPasswordMgrWithDefaultRealm()
        passwords.add_password(None, address, url.user, url.password)
        handler = AbstractDigestAuthHandler(passwords)
        try:
            fields = parse_keqv_list(parse_http_list(rest))
            proof = handler.get_authorization(Request(address, method=method), fields)
        except (ValueError, IndexError, URLError) as error:
            raise SourceError(f"its challenge cannot be answered: {challenge[:80]!r}") from error
        if proof:
            return f"Digest {proof}"
    raise SourceError(f"Basic or Digest authorization expected, the server asks for {challenge[:80]!r}")
