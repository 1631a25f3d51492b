"""Who has a certificate: a folder, a role and a robot; and what stands in a certificate about its holder."""

from dataclasses import dataclass
from pathlib import Path

from cryptography import x509
from cryptography.x509.oid import NameOID

from shared.access.rules import Role
from shared.transport.keys import is_robot

AUTHORITY = "authority"
"""Folder of the private key that signs all others. No service ever needs it: keep it off the robot."""


class CertificatesError(ValueError):
    """What was asked would overwrite a certificate, or needs one that is not there, or is none of ours."""


@dataclass(frozen=True)
class Holder:
    """Who gets a certificate: a folder's name, the role, and the robot where the role belongs to one."""

    name: str
    role: Role
    robot: str

    @property
    def common_name(self) -> str:
        """What the access rules know the holder by."""
        return self.role.common_name(self.robot)


def everyone(robot: str, *others: str) -> tuple[Holder, ...]:
    """One holder per service of a stack with one robot and per kind of person; and `others`' own.

    A robot of role "robot" in the stack is that in ROS, and its folder is named for its service.

    Raises:
        ValueError: not a robot's name.
    """
    stack = (Holder("ros" if role is Role.ROBOT else role.value, role, robot) for role in Role)
    return (*stack, *(holder for other in others for holder in another_robot(other)))


def another_robot(robot: str) -> tuple[Holder, ...]:
    """The holders that a further robot needs beside those of `everyone`, in folders such as "drive.r2"."""
    own = [role for role in Role if role.of_one_robot and role is not Role.ROBOT]
    return tuple(Holder(role.common_name(robot), role, robot) for role in own)


def read_certificate(path: Path) -> x509.Certificate:
    """Read a PEM file.

    Raises:
        CertificatesError: it is not there, or no certificate.
    """
    try:
        return x509.load_pem_x509_certificate(path.read_bytes())
    except (OSError, ValueError) as error:
        raise CertificatesError(f"{path}: no certificate: {error}") from error


def holder_of(name: str, certificate: x509.Certificate) -> Holder:
    """Whose it is; `name` is that of its folder.

    Raises:
        CertificatesError: its common name is none of ours.
    """
    names = certificate.subject.get_attributes_for_oid(NameOID.COMMON_NAME)
    common_name = str(names[0].value) if names else ""
    role, _, robot = common_name.partition(".")
    if role in {known.value for known in Role}:
        holder = Holder(name, Role(role), robot or "r1")
        if is_robot(holder.robot) and holder.common_name == common_name:
            return holder
    roles = ", ".join(known.value for known in Role)
    raise CertificatesError(f"{name}: a common name of one of {roles} expected, got {common_name[:80]!r}")


def hosts_of(certificate: x509.Certificate) -> tuple[str, ...]:
    """Host names and addresses at which a server's certificate holds."""
    try:
        names = certificate.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except x509.ExtensionNotFound:
        return ()
    return (*names.get_values_for_type(x509.DNSName), *map(str, names.get_values_for_type(x509.IPAddress)))
