"""A finished round of hide and seek: its figures and its drawings."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from services.launcher.client.mission import MissionRun
from services.launcher.client.trail import collisions, driven_m, manual_moves, spl
from services.launcher.drawing.pictures import save_picture
from services.launcher.drawing.plans import Way, draw_way
from services.launcher.terminal.output import rounded
from shared.messages.maps import Edge
from shared.messages.sensors import Frame
from shared.messages.simulation import Pose
from simulator.world.world_file import WorldFile

ARRIVED_M = 0.5
"""Two robots of 0.25 m radius touch: seeker and hider stand on the same spot."""


@dataclass(frozen=True)
class Round:
    """A finished round.

    Attributes:
        start, hider: where the two robots stood when it began.
        final: where the seeker really ended.
        goal: the picture it was given.
        shortest_m: length of the shortest collision-free way.
        experimenter_moves: times the experiment itself moved the seeker during it.
        arrived_m: how near the hider counts as found.
        edges_suspended: edges of the map that experience of this round put aside.
    """

    start: Pose
    hider: Pose
    final: Pose
    goal: Frame
    run: MissionRun
    shortest_m: float
    experimenter_moves: int
    arrived_m: float = ARRIVED_M
    edges_suspended: int = 0

    @property
    def distance_m(self) -> float:
        """True distance left at the end."""
        return math.hypot(self.final.x_m - self.hider.x_m, self.final.y_m - self.hider.y_m)

    @property
    def success(self) -> bool:
        """The planner says that it arrived, and it is right."""
        return self.run.succeeded and self.distance_m <= self.arrived_m

    @property
    def spl(self) -> float:
        """Success weighted by path length."""
        return spl(self.success, self.shortest_m, driven_m(self.run.truths))

    def figures(self) -> dict[str, object]:
        """One entry of "rounds"; the keys up to reason are fixed."""
        status = self.run.status
        failure = status.failure or ("" if self.success else "wrong_place")
        return {
            "success": self.success,
            "final_distance_m": rounded(self.distance_m),
            "spl": rounded(self.spl),
            "steps": status.step,
            "collisions": collisions(self.run.truths),
            "reason": f"{failure}: {status.reason}" if failure else status.reason,
            "failure": failure,
            "manual_moves": max(self.experimenter_moves, manual_moves(self.run.truths)),
            "shortest_m": rounded(self.shortest_m, 3),
            "driven_m": rounded(driven_m(self.run.truths), 3),
            "path_ratio": rounded(driven_m(self.run.truths) / self.shortest_m, 3),
            "edges_suspended": self.edges_suspended,
            "wall_s": rounded(self.run.wall_s, 2),
            "start": _plain(self.start),
            "hider": _plain(self.hider),
            "final": _plain(self.final),
        }


def draw_round(
    folder: Path,
    world: WorldFile,
    played: Round,
    poses: Mapping[int, Pose],
    edges: Iterable[Edge],
    final_views: tuple[Frame, Frame],
) -> None:
    """Write path.png (the way on the plan), goal.png, seeker_final.png and hider_final.png into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    points = tuple((t.pose.x_m, t.pose.y_m) for t in played.run.truths)
    way = Way(points, played.start, played.hider, played.run.via)
    draw_way(folder / "path.png", world, poses, edges, way)
    for name, frame in zip(("goal", "seeker_final", "hider_final"), (played.goal, *final_views), strict=True):
        save_picture(folder / f"{name}.png", frame)


def _plain(pose: Pose) -> dict[str, float]:
    return {name: rounded(value) for name, value in pose.model_dump().items()}
