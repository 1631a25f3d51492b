"""A private certificate authority and the certificates that it signs: elliptic keys, kept as files."""

import datetime as dt
import ipaddress
import os
from dataclasses import dataclass
from pathlib import Path

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from shared.access.credentials import AUTHORITY_FILE, CERTIFICATE_FILE, KEY_FILE, MAP_STORE_HOST
from shared.access.rules import Role
from shared.certificates.holders import AUTHORITY, CertificatesError, Holder, read_certificate

AUTHORITY_DAYS = 3650
"""Ten years: who renews it must visit every robot."""
CERTIFICATE_DAYS = 397
"""The CA/Browser Forum's limit of 398 days, less one for clocks."""
ROUTER_HOSTS = ("router", "localhost", "127.0.0.1")
"""Where services find the router: among containers, and on one machine."""
CLOCKS_DIFFER = dt.timedelta(hours=1)
"""Certificates hold from a little before they were made: robots' clocks are not exact."""
USAGES = (
    "digital_signature", "content_commitment", "key_encipherment", "data_encipherment", "key_agreement",
    "key_cert_sign", "crl_sign", "encipher_only", "decipher_only",
)  # fmt: skip
"""Of a key, by RFC 5280, 4.2.1.3."""


@dataclass(frozen=True)
class Authority:
    """Signs certificates."""

    certificate: x509.Certificate
    key: ec.EllipticCurvePrivateKey

    @classmethod
    def made(cls, folder: Path, now: dt.datetime) -> "Authority":
        """Make a new one in `folder`.

        Raises:
            CertificatesError: there is one.
        """
        if has_authority(folder):
            raise CertificatesError(
                f"{folder / AUTHORITY}: there is an authority, and all certificates rest on it"
            )
        key = ec.generate_private_key(ec.SECP256R1())
        name = _name("topnav authority")
        certificate = (
            _unsigned(name, name, key, now, AUTHORITY_DAYS)
            .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
            .add_extension(_usage("key_cert_sign", "crl_sign"), critical=True)
            .sign(key, hashes.SHA256())
        )
        _write(folder / AUTHORITY, key, {AUTHORITY_FILE: certificate})
        return cls(certificate, key)

    @classmethod
    def read(cls, folder: Path) -> "Authority":
        """Read the one in `folder`.

        Raises:
            CertificatesError: there is none, or its key was taken elsewhere, as it should be.
        """
        home = folder / AUTHORITY
        try:
            certificate = read_certificate(home / AUTHORITY_FILE)
            key = serialization.load_pem_private_key((home / KEY_FILE).read_bytes(), password=None)
        except (OSError, ValueError) as error:
            raise CertificatesError(f"{home}: no authority that can sign: {error}") from error
        if not isinstance(key, ec.EllipticCurvePrivateKey):
            raise CertificatesError(f"{home}: an elliptic key expected, got {type(key).__name__}")
        return cls(certificate, key)

    def issue(self, folder: Path, holder: Holder, hosts: tuple[str, ...], now: dt.datetime) -> None:
        """Write a new key and certificate for `holder` into its folder, in place of older ones.

        Args:
            folder: of all certificates.
            holder: whose it will be.
            hosts: further host names and addresses at which the router is reached.
            now: start of its validity, with a time zone.
        """
        key = ec.generate_private_key(ec.SECP256R1())
        issuer = self.certificate.subject
        kinds = [ExtendedKeyUsageOID.CLIENT_AUTH]
        builder = _unsigned(_name(holder.common_name), issuer, key, now, CERTIFICATE_DAYS)
        names = _server_names(holder.role, hosts)
        if names:
            kinds.append(ExtendedKeyUsageOID.SERVER_AUTH)
            builder = builder.add_extension(x509.SubjectAlternativeName(names), critical=False)
        certificate = (
            builder.add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
            .add_extension(_usage("digital_signature"), critical=True)
            .add_extension(x509.ExtendedKeyUsage(kinds), critical=False)
            .sign(self.key, hashes.SHA256())
        )
        files = {AUTHORITY_FILE: self.certificate, CERTIFICATE_FILE: certificate}
        _write(folder / holder.name, key, files)


def has_authority(folder: Path) -> bool:
    """Whether there is one; an empty folder, which a mounted volume brings along, is none."""
    home = folder / AUTHORITY
    return (home / AUTHORITY_FILE).exists() or (home / KEY_FILE).exists()


def _server_names(role: Role, hosts: tuple[str, ...]) -> list[x509.GeneralName]:
    """Names of those who are connected to. No two share one: a stolen map store is no router."""
    if role is Role.ROUTER:
        return [_host(name) for name in dict.fromkeys((*ROUTER_HOSTS, *hosts))]
    return [_host(MAP_STORE_HOST)] if role is Role.MAP_STORE else []


def _host(name: str) -> x509.GeneralName:
    try:
        return x509.IPAddress(ipaddress.ip_address(name))
    except ValueError:
        return x509.DNSName(name)


def _unsigned(
    subject: x509.Name, issuer: x509.Name, key: ec.EllipticCurvePrivateKey, now: dt.datetime, days: int
) -> x509.CertificateBuilder:
    return (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(issuer)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - CLOCKS_DIFFER)
        .not_valid_after(now + dt.timedelta(days=days))
    )


def _name(common_name: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, common_name)])


def _usage(*allowed: str) -> x509.KeyUsage:
    return x509.KeyUsage(**{usage: usage in allowed for usage in USAGES})


def _write(home: Path, key: ec.EllipticCurvePrivateKey, certificates: dict[str, x509.Certificate]) -> None:
    """Write a key for its owner only and certificates, into a folder that nobody else may look into."""
    pem = serialization.Encoding.PEM
    encoded = key.private_bytes(pem, serialization.PrivateFormat.PKCS8, serialization.NoEncryption())
    home.mkdir(mode=0o700, parents=True, exist_ok=True)
    _replace(home / KEY_FILE, encoded, 0o600)
    for name, certificate in certificates.items():
        _replace(home / name, certificate.public_bytes(pem), 0o644)


def _replace(path: Path, content: bytes, mode: int) -> None:
    """Replace the file in one step; it never has more than these permissions, not even for a moment."""
    new = path.with_name(f"{path.name}.new")
    new.unlink(missing_ok=True)
    with os.fdopen(os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL, mode), "wb") as file:
        file.write(content)
    new.replace(path)
