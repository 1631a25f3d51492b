"""What people and programs may do: three roles, each of which includes the ones before it. Pure."""

from typing import Literal, get_args

Role = Literal["viewer", "operator", "admin"]
"""viewer looks; operator moves robots and lets them go again; admin also changes and removes maps."""

ROLES: tuple[Role, ...] = get_args(Role)


def includes(role: Role, needed: Role) -> bool:
    """Whether `role` may do what `needed` may."""
    return ROLES.index(role) >= ROLES.index(needed)
