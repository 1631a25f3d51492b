"""What stands in a certificate."""

from pathlib import Path

from cryptography import x509
from cryptography.x509.oid import NameOID

from shared.access.rules import Role
from shared.certificates.layout import Holder


class UnreadableError(ValueError):
    """A file that is no certificate, or one that `topnav certs` did not make."""


def read_certificate(path: Path) -> x509.Certificate:
    """Read a PEM file.

    Raises:
        UnreadableError: it is not there, or no certificate.
    """
    try:
        return x509.load_pem_x509_certificate(path.read_bytes())
    except (OSError, ValueError) as error:
        raise UnreadableError(f"{path}: no certificate: {error}") from error


def holder_of(name: str, certificate: x509.Certificate) -> Holder:
    """Whose it is; `name` is that of its folder.

    Raises:
        UnreadableError: its common name is none of ours.
    """
    names = certificate.subject.get_attributes_for_oid(NameOID.COMMON_NAME)
    common_name = str(names[0].value) if names else ""
    role, _, robot = common_name.partition(".")
    try:
        holder = Holder(name, Role(role), robot or "r1")
        if holder.common_name != common_name:
            raise ValueError(common_name)
    except ValueError as error:
        roles = ", ".join(r.value for r in Role)
        raise UnreadableError(
            f"{name}: a common name of one of {roles} expected, got {common_name[:80]!r}"
        ) from error
    return holder


def hosts_of(certificate: x509.Certificate) -> tuple[str, ...]:
    """Host names and addresses at which a server's certificate holds."""
    try:
        names = certificate.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except x509.ExtensionNotFound:
        return ()
    return (*names.get_values_for_type(x509.DNSName), *map(str, names.get_values_for_type(x509.IPAddress)))
