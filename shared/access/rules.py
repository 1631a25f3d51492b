"""Who may say, hear, ask and answer what on the secured bus: one table beside `shared.topics`.

A certificate's common name is its role, followed by ".ROBOT" for roles that belong to one robot: "drive.r1".
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any

from shared import topics
from shared.topics import Query, Topic
from shared.transport.keys import check_robot


class Role(Enum):
    """What a certificate says that its owner is; the value starts the common name."""

    ROUTER = "router"
    ROBOT = "robot"
    SIMULATOR = "simulator"
    CAMERA = "camera"
    FEATURES = "features"
    MAP_STORE = "map_store"
    PLANNER = "planner"
    DRIVE = "drive"
    DISPATCH = "dispatch"
    SIGNS = "signs"
    FLEET = "fleet"
    GATEWAY = "gateway"
    RECORDER = "recorder"
    FOXGLOVE = "foxglove"
    OPERATOR = "operator"
    VIEWER = "viewer"

    @property
    def of_one_robot(self) -> bool:
        """Whether such a service belongs to one robot and may touch the keys of no other."""
        return self in OF_ONE_ROBOT

    def common_name(self, robot: str) -> str:
        """Common name of a certificate, "drive.r1" or "map_store".

        Raises:
            ValueError: not a robot's name.
        """
        check_robot(robot)
        return f"{self.value}.{robot}" if self.of_one_robot else self.value


OF_ONE_ROBOT = (
    Role.ROBOT,
    Role.SIMULATOR,
    Role.CAMERA,
    Role.FEATURES,
    Role.PLANNER,
    Role.DRIVE,
    Role.DISPATCH,
    Role.SIGNS,
)


def robot_names(variables: Mapping[str, str]) -> tuple[str, ...]:
    """Robots of a stack: TOPNAV_ROBOTS, else TOPNAV_ROBOT; the first is that of the stack's own services.

    Raises:
        ValueError: one of the variables that name robots, also those of the features, names something else.
    """
    one = _checked("TOPNAV_ROBOT", [variables.get("TOPNAV_ROBOT") or "r1"])
    _listed(variables, "TOPNAV_FEATURES_ROBOTS")  # not of the stack, but read before anything is started
    return _listed(variables, "TOPNAV_ROBOTS") or one


def _listed(variables: Mapping[str, str], variable: str) -> tuple[str, ...]:
    given = variables.get(variable, "").strip()
    return _checked(variable, [name.strip() for name in given.split(",")] if given else [])


def _checked(variable: str, names: Iterable[str]) -> tuple[str, ...]:
    try:
        return tuple(check_robot(name) for name in names)
    except ValueError as error:
        raise ValueError(f"{variable}: {error}") from None


@dataclass(frozen=True)
class Grant:
    """Of a topic: who may publish and who may subscribe. Of a query: who may answer and who may ask."""

    speakers: frozenset[Role]
    hearers: frozenset[Role]


def _grant(speakers: Iterable[Role], hearers: Iterable[Role]) -> Grant:
    return Grant(frozenset(speakers), frozenset(hearers))


BODIES = (Role.ROBOT, Role.SIMULATOR)
PEOPLE = (Role.GATEWAY, Role.OPERATOR)
"""The two ways in which people's wishes reach the bus: the web console and the shell."""
WATCHERS = (*PEOPLE, Role.RECORDER, Role.FOXGLOVE, Role.VIEWER)
ASKERS = (*PEOPLE, Role.ROBOT)
"""A robot whose body is in ROS passes on what people wish there: of itself only (services/ros)."""
GIVERS = (Role.DISPATCH, Role.FLEET)
"""They decide who begins what by what a robot says of itself."""

STREAMS: dict[Topic[Any], Grant] = {
    topics.FRAME: _grant([*BODIES, Role.CAMERA], [Role.ROBOT, Role.FEATURES, Role.SIGNS, *WATCHERS]),
    topics.CAMERA_STATE: _grant([Role.CAMERA], WATCHERS),
    topics.RANGES: _grant(BODIES, [Role.DRIVE, Role.PLANNER, *WATCHERS]),
    # A camera that replays pictures one step at a time waits for the features of each.
    topics.FEATURES: _grant([Role.FEATURES], [Role.PLANNER, Role.CAMERA, *WATCHERS]),
    topics.HEADING: _grant([Role.PLANNER], [Role.DRIVE, *WATCHERS]),
    topics.VELOCITY: _grant([Role.DRIVE], [*BODIES, Role.PLANNER, *WATCHERS]),
    topics.MANUAL: _grant(PEOPLE, [Role.DRIVE, Role.PLANNER, *GIVERS, *WATCHERS]),
    topics.ODOMETRY: _grant(BODIES, [Role.DRIVE, Role.PLANNER, *WATCHERS]),
    topics.IMU: _grant(BODIES, WATCHERS),
    topics.BATTERY: _grant(BODIES, [*GIVERS, *WATCHERS]),
    topics.ESTOP_STATE: _grant([Role.DRIVE], [*BODIES, Role.PLANNER, *GIVERS, *WATCHERS]),
    topics.ROBOT_ESTOP_STATE: _grant(BODIES, [Role.DRIVE, *WATCHERS]),
    topics.STATUS: _grant([Role.PLANNER], [Role.PLANNER, *GIVERS, Role.ROBOT, *WATCHERS]),
    topics.QUEUE: _grant([Role.DISPATCH], [Role.FLEET, *WATCHERS]),
    topics.FLEET_QUEUE: _grant([Role.FLEET], WATCHERS),
    topics.EVENT: _grant([Role.PLANNER], WATCHERS),
    # Only evaluation may know where the robot really is; simulators show each other's robots (on an open bus:
    # here each hears of its own).
    topics.TRUTH: _grant([Role.SIMULATOR], [Role.SIMULATOR, *PEOPLE, Role.RECORDER]),
    topics.MAP_DELTA: _grant(
        [Role.MAP_STORE], [Role.FEATURES, Role.PLANNER, Role.SIGNS, Role.FLEET, *WATCHERS]
    ),
}
QUESTIONS: dict[Query[Any, Any], Grant] = {
    topics.MATCH: _grant([Role.FEATURES], [Role.PLANNER, Role.MAP_STORE, *PEOPLE]),
    topics.EXTRACT: _grant([Role.FEATURES], ASKERS),
    topics.EXTRACT_PHOTO: _grant([Role.FEATURES], ASKERS),
    topics.MISSION: _grant([Role.PLANNER], [Role.DISPATCH, *ASKERS]),
    topics.MISSION_KINDS: _grant([Role.PLANNER], PEOPLE),
    topics.ESTOP: _grant([Role.DRIVE], ASKERS),
    # One key reads and writes: who only reads has a key of its own.
    topics.MAP: _grant([Role.MAP_STORE], [Role.PLANNER, Role.SIGNS, *PEOPLE]),
    topics.MAP_READ: _grant([Role.MAP_STORE], [Role.FEATURES, Role.FLEET, Role.FOXGLOVE]),
    topics.MISSION_RECORD: _grant([Role.MAP_STORE], [Role.PLANNER]),
    topics.TASKS: _grant([Role.MAP_STORE], [*GIVERS, *PEOPLE]),
    topics.WAY: _grant([Role.FLEET], [Role.PLANNER]),
    topics.COMPARE: _grant([Role.FEATURES], [Role.PLANNER]),
    topics.INSPECTION: _grant([Role.MAP_STORE], [Role.PLANNER]),
    topics.SIMULATION: _grant([Role.SIMULATOR], [Role.OPERATOR]),
}
