"""What is wrong with the certificates of a folder, before a service finds out."""

import datetime as dt
import stat
from dataclasses import dataclass
from pathlib import Path

from cryptography import x509
from cryptography.exceptions import InvalidSignature

from shared.access.credentials import (
    AUTHORITY_FILE,
    CERTIFICATE_FILE,
    KEY_FILE,
    CredentialsError,
    credentials_in,
)
from shared.certificates.holders import AUTHORITY, CertificatesError, holder_of, read_certificate

SOON = dt.timedelta(days=30)
"""Chosen: time for a visit to every robot."""


@dataclass(frozen=True)
class Finding:
    """One holder's certificate; `faults` stop it from working, `warnings` will or may.

    Attributes:
        name: of its folder.
        common_name: "" where it cannot be read.
        expires: end of its validity; None where it cannot be read.
    """

    name: str
    common_name: str
    expires: dt.datetime | None
    faults: tuple[str, ...]
    warnings: tuple[str, ...]


def check(folder: Path, now: dt.datetime) -> list[Finding]:
    """Look at everybody's certificate in `folder`.

    Raises:
        CertificatesError: there is none at all.
    """
    homes = sorted(path for path in folder.glob("*/") if path.name != AUTHORITY)
    if not homes:
        raise CertificatesError(f"{folder}: certificates expected, found none; make them with 'topnav certs'")
    path = folder / AUTHORITY / AUTHORITY_FILE
    authority = read_certificate(path) if path.exists() else None  # the folder may have come without it
    return [_check(home, authority, now) for home in homes]


def _check(home: Path, authority: x509.Certificate | None, now: dt.datetime) -> Finding:
    try:
        credentials = credentials_in(home)
        certificate = read_certificate(home / CERTIFICATE_FILE)
        name = holder_of(home.name, certificate).common_name
        chain = authority or read_certificate(home / AUTHORITY_FILE)
    except (CredentialsError, CertificatesError) as error:
        return Finding(home.name, "", None, (str(error),), ())
    assert credentials is not None  # an empty folder has no certificate to read
    faults, warnings = _validity(certificate, now)
    if fault := _chain_fault(certificate, chain):
        faults.append(fault)
    if read_certificate(home / AUTHORITY_FILE) != chain:
        faults.append("trusts another authority than the one in this folder")
    mode = stat.S_IMODE((home / KEY_FILE).stat().st_mode)
    if mode & 0o077:
        warnings.append(f"{KEY_FILE} may be read by others: mode 600 expected, got {mode:o}")
    expires = certificate.not_valid_after_utc
    return Finding(home.name, name, expires, tuple(faults), tuple(warnings))


def _validity(certificate: x509.Certificate, now: dt.datetime) -> tuple[list[str], list[str]]:
    end, start = certificate.not_valid_after_utc, certificate.not_valid_before_utc
    if now > end:
        return [f"expired on {end:%Y-%m-%d}: make new ones with 'topnav certs --renew'"], []
    if now < start:
        return [f"holds from {start:%Y-%m-%d %H:%M} UTC on: is this machine's clock right?"], []
    return [], [f"expires on {end:%Y-%m-%d}"] if now > end - SOON else []


def _chain_fault(certificate: x509.Certificate, authority: x509.Certificate) -> str | None:
    try:
        certificate.verify_directly_issued_by(authority)
    except (ValueError, TypeError, InvalidSignature):
        return "not signed by the authority of this folder"
    return None
