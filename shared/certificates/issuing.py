"""Making certificates for a folder of holders, and making them again; nothing is overwritten unasked."""

import datetime as dt
from collections.abc import Iterable
from pathlib import Path

from shared.access.credentials import CERTIFICATE_FILE
from shared.access.rules import Role
from shared.certificates.authority import Authority, has_authority
from shared.certificates.holders import (
    AUTHORITY,
    CertificatesError,
    Holder,
    holder_of,
    hosts_of,
    read_certificate,
)


def make(
    folder: Path, holders: Iterable[Holder], now: dt.datetime, hosts: tuple[str, ...] = (), keep: bool = False
) -> list[Holder]:
    """Make certificates, and the authority if there is none; returns whose were made.

    Args:
        folder: of all certificates.
        holders: who needs one.
        now: time with a time zone.
        hosts: further names at which the router is reached.
        keep: leave those who have one alone, except a router that is to be reached at one more of `hosts`.

    Raises:
        CertificatesError: one has a certificate already, or a name that is not a plain word.
    """
    wanted = list(holders)
    for holder in wanted:
        _require_plain(holder.name)
    there = [holder for holder in wanted if _is_there(folder, holder, hosts if keep else ())]
    if there and not keep:
        raise CertificatesError(
            f"{folder}: {', '.join(h.name for h in there)} have certificates; "
            "--renew makes new ones, --keep only those that are missing"
        )
    for holder in there:
        _require_same(folder, holder)
    authority = Authority.read(folder) if has_authority(folder) else Authority.made(folder, now)
    made = [holder for holder in wanted if holder not in there]
    for holder in made:
        known = hosts_of(read_certificate(path)) if (path := _certificate(folder, holder)).exists() else ()
        authority.issue(folder, holder, tuple(dict.fromkeys((*known, *hosts))), now)
    return made


def renew(folder: Path, now: dt.datetime, hosts: tuple[str, ...] = ()) -> list[Holder]:
    """Make a new key and certificate for everybody in `folder`, with the same authority, names and hosts.

    Services take them when they are started again.

    Raises:
        CertificatesError: no authority that can sign, or a certificate that is not ours.
    """
    authority = Authority.read(folder)
    renewed = []
    for path in sorted(folder.glob(f"*/{CERTIFICATE_FILE}")):
        certificate = read_certificate(path)
        holder = holder_of(path.parent.name, certificate)
        authority.issue(folder, holder, tuple(dict.fromkeys((*hosts_of(certificate), *hosts))), now)
        renewed.append(holder)
    if not renewed:
        raise CertificatesError(f"{folder}: certificates to renew expected, found none")
    return renewed


def _certificate(folder: Path, holder: Holder) -> Path:
    return folder / holder.name / CERTIFICATE_FILE


def _is_there(folder: Path, holder: Holder, hosts: tuple[str, ...]) -> bool:
    """Whether a certificate is there, and holds at these hosts where it is the router's."""
    path = _certificate(folder, holder)
    if not path.exists():
        return False
    return holder.role is not Role.ROUTER or set(hosts) <= set(hosts_of(read_certificate(path)))


def _require_plain(name: str) -> None:
    words = name.replace("-", "").replace("_", "").split(".")
    if name == AUTHORITY or not all(word.isalnum() for word in words):
        raise CertificatesError(
            f"a holder's name is a plain word other than {AUTHORITY!r}, got {name[:80]!r}"
        )


def _require_same(folder: Path, holder: Holder) -> None:
    """What is kept must be what was asked for: another robot's certificate would be refused by the router."""
    certificate = read_certificate(_certificate(folder, holder))
    found = holder_of(holder.name, certificate).common_name
    if found != holder.common_name:
        raise CertificatesError(
            f"{folder / holder.name}: a certificate of {holder.common_name} expected, found one of {found}"
        )
