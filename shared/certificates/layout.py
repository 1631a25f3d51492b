"""Which files a certificate folder has, and who is in it by default."""

from dataclasses import dataclass

from shared.access.rules import Role

AUTHORITY = "authority"
"""Folder of the private key that signs all others. No service ever needs it: keep it off the robot."""


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


def everyone(robot: str) -> tuple[Holder, ...]:
    """One holder per service of a stack with one simulated robot, and one per kind of person.

    Raises:
        ValueError: not a robot's name.
    """
    return tuple(Holder(role.value, role, robot) for role in Role if role is not Role.ROBOT)


def another_robot(robot: str) -> tuple[Holder, ...]:
    """The holders that a further robot needs beside those of `everyone`, in folders such as "drive.r2"."""
    own = [role for role in Role if role.of_one_robot and role is not Role.ROBOT]
    return tuple(Holder(role.common_name(robot), role, robot) for role in own)
