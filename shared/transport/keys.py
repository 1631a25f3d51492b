"""Key expressions and the names in them, apart from the messages: a health check reads no more than this."""

import re

NAME = re.compile(r"[a-z0-9_-]{1,64}\Z")
"""Names of robots, maps and services: without the signs that mean something in key expressions and paths."""
ANY = "any"
"""Whose queue is that of the fleet: tasks for whichever robot."""
RESERVED = ("alive", ANY, "features", "maps", "missions")
"""No robots: topnav/missions/estop would stop one called missions and be the record of one called estop."""


def is_robot(name: str) -> bool:
    """Whether a robot may be called so."""
    return NAME.match(name) is not None and name not in RESERVED


def check_robot(name: str) -> str:
    """Return a robot's name as it is, or raise ValueError."""
    if not is_robot(name):
        raise ValueError(
            "a robot's name must match [a-z0-9_-]{1,64}, as r1 does, and be none of "
            f"{', '.join(RESERVED)}, which begin keys of no robot; got {name[:80]!r}"
        )
    return name


def check_queue(name: str) -> str:
    """Return the name of a queue of tasks, a robot's or ANY, as it is, or raise ValueError."""
    return name if name == ANY else check_robot(name)


def fill(template: str, names: dict[str, str]) -> str:
    """Put checked names into a key template."""
    for label, name in names.items():
        if name == "*":
            continue
        if label == "robot":
            check_robot(name)
        elif label == "queue":
            check_queue(name)
        elif not NAME.match(name):
            raise ValueError(f"{label} must match [a-z0-9_-]{{1,64}}, got {name[:80]!r}")
    return template.format(**names)


def alive_key(service: str, instance: str) -> str:
    """Liveliness key of one process; '*' as instance watches them all."""
    return fill("topnav/alive/{service}/{instance}", {"service": service, "instance": instance})


def robot_key(robot: str, holder: str) -> str:
    """Liveliness key of a process that is robot `robot`; '*' as holder watches for all that say so."""
    return fill("topnav/alive/robot/{robot}/{holder}", {"robot": robot, "holder": holder})
