"""Key expressions and the names in them, apart from the messages: a health check reads no more than this."""

import re

NAME = re.compile(r"[a-z0-9_-]{1,64}\Z")
"""Names of robots, maps and services: without the signs that mean something in key expressions and paths."""
"""Names of robots, maps and services: without the signs that mean something in key expressions and paths."""


def fill(template: str, names: dict[str, str]) -> str:
    """Put checked names into a key template."""
    for label, name in names.items():
        if name != "*" and not NAME.match(name):
            raise ValueError(f"{label} must match [a-z0-9_-]{{1,64}}, got {name[:80]!r}")
    return template.format(**names)


def alive_key(service: str, instance: str) -> str:
    """Liveliness key of one process; '*' as instance watches them all."""
    return fill("topnav/alive/{service}/{instance}", {"service": service, "instance": instance})


def robot_key(robot: str, holder: str) -> str:
    """Liveliness key of a process that is robot `robot`; '*' as holder watches for all that say so."""
    return fill("topnav/alive/robot/{robot}/{holder}", {"robot": robot, "holder": holder})
