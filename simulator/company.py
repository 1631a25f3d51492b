"""Other simulated robots that are in the same place: where their own simulators say they are. Pure.

Each simulator has a stage with one robot that it moves; the others are bodies that follow what is told.
"""

import math
from dataclasses import dataclass, field

from simulator.disturbances.people import UNSEEN, Figure
from simulator.robot.robot_shape import HIDER, whole_robot
from simulator.scene.parts import Piece, Pose2, moved
from simulator.scene.shapes import post
from simulator.settings import RobotSettings
from simulator.world.footprints import Footprints, footprints
from simulator.world.freespace import BODY_BAND_M, Point

# All chosen:
AWAY: Pose2 = (-1000.0, -1000.0, 0.0)  # where a body is that is not there
FOLLOW_MPS = 1.5  # a body goes to where its robot is said to be; faster than any robot drives
FOLLOW_RADPS = 6.0
PUT_M = 0.6  # a robot that is so far from where it was did not drive there
ROOM_M = 0.02  # between two robots, of which one was put where the other stands, before they are solid


@dataclass
class Fellow:
    """One of them.

    Attributes:
        told: where it is; None while nobody says.
        pose: where its body is, which follows; None while it is nowhere.
    """

    told: Pose2 | None = None
    pose: Pose2 | None = None


@dataclass
class Company:
    """The other robots of a place, by name.

    Two robots may be put at one spot, as at the start of a world. There the other is neither seen nor felt
    until they are apart.

    Attributes:
        robot: shape and size of all robots.
    """

    robot: RobotSettings
    fellows: dict[str, Fellow] = field(default_factory=dict)

    def figures(self) -> list[Figure]:
        """How they look and what of them is solid, in the order of `fellows`."""
        radius_m, heights_m = self.robot.body_radius_m, (self.robot.body_low_m, self.robot.body_top_m)
        solid = post(0.0, 0.0, heights_m, radius_m, UNSEEN)
        return [Figure(whole_robot(self.robot, HIDER), solid, radius_m, 0.0) for _ in self.fellows]

    def tell(self, name: str, pose: Pose2 | None) -> None:
        """Where one is now; None when nothing is heard of it any more.

        Raises:
            KeyError: no such robot.
        """
        self.fellows[name].told = pose

    def advance(self, dt_s: float, own: Point) -> None:
        """Let the bodies follow for a moment; `own` is where the robot of this simulator is."""
        for fellow in self.fellows.values():
            if fellow.told is None:
                fellow.pose = None
            elif fellow.pose is None or math.dist(fellow.pose[:2], fellow.told[:2]) > PUT_M:
                apart_m = 2.0 * self.robot.body_radius_m + ROOM_M
                fellow.pose = fellow.told if math.dist(fellow.told[:2], own) >= apart_m else None
            else:
                fellow.pose = _followed(fellow.pose, fellow.told, dt_s)

    def withdraw(self, own: Point) -> None:
        """The robot of this simulator was put somewhere: who stands there is not there."""
        for fellow in self.fellows.values():
            fellow.pose = None
        self.advance(0.0, own)

    def poses(self) -> list[Pose2 | None]:
        """Where the bodies are."""
        return [fellow.pose for fellow in self.fellows.values()]

    def outlines(self) -> Footprints:
        """What the distance sensors feel of them."""
        solids = tuple(
            part
            for figure, pose in zip(self.figures(), self.poses(), strict=True)
            if pose is not None
            for part in moved(Piece((figure.solid,)), *pose).parts
        )
        return footprints(solids, *BODY_BAND_M)


def company_of(names: tuple[str, ...], robot: RobotSettings) -> Company:
    """Robots of these names, of which nothing was heard yet."""
    return Company(robot, {name: Fellow() for name in names})


def _followed(pose: Pose2, told: Pose2, dt_s: float) -> Pose2:
    """`pose` a moment later, on its way to `told`."""
    way_m = math.dist(pose[:2], told[:2])
    share = min(1.0, FOLLOW_MPS * dt_s / way_m) if way_m else 1.0
    turn_rad = math.remainder(told[2] - pose[2], math.tau)
    most_rad = FOLLOW_RADPS * dt_s
    x_m, y_m = (a + share * (b - a) for a, b in zip(pose[:2], told[:2], strict=True))
    return x_m, y_m, pose[2] + max(-most_rad, min(most_rad, turn_rad))
