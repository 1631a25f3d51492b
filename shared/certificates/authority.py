"""A private certificate authority and the certificates that it signs: elliptic keys, kept as files."""

import datetime as dt
import ipaddress
from dataclasses import dataclass
from pathlib import Path

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from shared.access.credentials import AUTHORITY_FILE, CERTIFICATE_FILE, KEY_FILE, MAP_STORE_HOST
from shared.access.rules import Role
from shared.certificates.files import private_folder, write, write_key
from shared.certificates.layout import AUTHORITY, Holder

AUTHORITY_DAYS = 3650
CERTIFICATE_DAYS = 397
ROUTER_HOSTS = ("router", "localhost", "127.0.0.1")
"""Where services find the router: among containers, and on one machine."""
CLOCKS_DIFFER = dt.timedelta(hours=1)
"""Certificates hold from a little before they were made: robots' clocks are not exact."""


class CertificatesError(ValueError):
    """What was asked would overwrite a certificate, or needs one that is not there."""


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
        home = folder / AUTHORITY
        if has_authority(folder):
            raise CertificatesError(f"{home}: there is an authority, and all certificates rest on it")
        key = ec.generate_private_key(ec.SECP256R1())
        name = _name("topnav authority")
        certificate = (
            _unsigned(name, name, key, now, AUTHORITY_DAYS)
            .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
            .add_extension(_usage(signs_certificates=True), critical=True)
            .sign(key, hashes.SHA256())
        )
        private_folder(home)
        write_key(home / KEY_FILE, key)
        write(home / AUTHORITY_FILE, _pem(certificate), 0o644)
        return cls(certificate, key)

    @classmethod
    def read(cls, folder: Path) -> "Authority":
        """Read the one in `folder`.

        Raises:
            CertificatesError: there is none, or its key was taken elsewhere, as it should be.
        """
        home = folder / AUTHORITY
        try:
            certificate = x509.load_pem_x509_certificate((home / AUTHORITY_FILE).read_bytes())
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
            builder = builder.add_extension(x509.SubjectAlternativeName(_hosts(names)), critical=False)
        certificate = (
            builder.add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
            .add_extension(_usage(signs_certificates=False), critical=True)
            .add_extension(x509.ExtendedKeyUsage(kinds), critical=False)
            .sign(self.key, hashes.SHA256())
        )
        home = folder / holder.name
        private_folder(home)
        write(home / AUTHORITY_FILE, _pem(self.certificate), 0o644)
        write_key(home / KEY_FILE, key)
        write(home / CERTIFICATE_FILE, _pem(certificate), 0o644)


def has_authority(folder: Path) -> bool:
    """Whether there is one; an empty folder, which a mounted volume brings along, is none."""
    home = folder / AUTHORITY
    return (home / AUTHORITY_FILE).exists() or (home / KEY_FILE).exists()


def _server_names(role: Role, hosts: tuple[str, ...]) -> tuple[str, ...]:
    """Names of those who are connected to. No two share one: a stolen map store is no router."""
    if role is Role.ROUTER:
        return tuple(dict.fromkeys((*ROUTER_HOSTS, *hosts)))
    return (MAP_STORE_HOST,) if role is Role.MAP_STORE else ()


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


def _hosts(names: tuple[str, ...]) -> list[x509.GeneralName]:
    found: list[x509.GeneralName] = []
    for name in names:
        try:
            found.append(x509.IPAddress(ipaddress.ip_address(name)))
        except ValueError:
            found.append(x509.DNSName(name))
    return found


def _usage(signs_certificates: bool) -> x509.KeyUsage:
    return x509.KeyUsage(
        digital_signature=not signs_certificates,
        content_commitment=False,
        key_encipherment=False,
        data_encipherment=False,
        key_agreement=False,
        key_cert_sign=signs_certificates,
        crl_sign=signs_certificates,
        encipher_only=False,
        decipher_only=False,
    )


def _pem(certificate: x509.Certificate) -> bytes:
    return certificate.public_bytes(serialization.Encoding.PEM)
