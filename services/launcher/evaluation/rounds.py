"""One round of hide and seek: a robot hides, the other gets its picture and looks for it."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from services.launcher.client.experimenter import Experimenter
from services.launcher.client.failure import ExperimentError
from services.launcher.client.maps import read_map
from services.launcher.client.mission import MissionClient, MissionRun, goal_features
from services.launcher.client.stack import Stack
from services.launcher.evaluation.outcome import ARRIVED_M, Round
from services.launcher.terminal.progress import Watch
from shared.messages.missions import MissionRequest
from shared.messages.sensors import Frame
from shared.messages.simulation import Pose, Truth
from shared.topics import FRAME
from simulator.world.freespace import FreeSpace

MIN_APART_M = 1.5
"""Three times ARRIVED_M of way: nobody is found without driving."""

MARGIN_M = 0.05
"""One cell of the free space's grid: a hider touches nothing, wherever in its cell it stands."""

MAX_DRAWS = 1000
"""Finds one part in a hundred of the floor but for 4 times in 100,000: 0.99 ** 1000."""

FRAME_TIMEOUT_S = 10.0
"""Frames come every 0.5 s at most; a simulator that restarts needs seconds."""


def hiding_place(space: FreeSpace, seeker: Pose, rng: np.random.Generator) -> Pose:
    """A random free pose at least MIN_APART_M of way from the seeker.

    Raises:
        ValueError: the free floor is too small for that.
    """
    for _ in range(MAX_DRAWS):
        x_m, y_m, yaw_rad = space.random_pose(rng, MARGIN_M)
        way_m = space.shortest_path_m((seeker.x_m, seeker.y_m), (x_m, y_m))
        if MIN_APART_M <= way_m < math.inf:
            return Pose(x_m=x_m, y_m=y_m, yaw_rad=yaw_rad)
    raise ValueError(f"no free spot at least {MIN_APART_M} m away from the seeker in {MAX_DRAWS} draws")


class Game:
    """Rounds in one stack; the seeker stays where the last one ended.

    Args:
        stack: services that know the map.
        space: the free floor as it is.
        map_name: of the map to find the way in.
        rng: draws the hiding places.
        arrived_m: how near the hider counts as found.
        hideouts: where a robot may hide; by default all of `space`.
    """

    def __init__(
        self,
        stack: Stack,
        space: FreeSpace,
        map_name: str,
        rng: np.random.Generator,
        arrived_m: float = ARRIVED_M,
        hideouts: FreeSpace | None = None,
    ) -> None:
        self._stack, self._space, self._map, self._rng = stack, space, map_name, rng
        self._arrived_m, self._hideouts = arrived_m, hideouts or space
        self.client = MissionClient(stack.bus, stack.robot)
        self.experimenter = Experimenter(stack.bus, stack.robot)

    def begin(self, seed: int) -> Truth:
        """Put the seeker at the world's start and wait until it sees something; returns the state there."""
        truth = self.experimenter.reset(seed)
        self.client.wait_for_frame(truth.stamp_ns)
        return truth

    def choose(self) -> tuple[Pose, Pose]:
        """Where the seeker stands, and a random place to hide."""
        start = self.experimenter.settled_truth().pose
        return start, hiding_place(self._hideouts, start, self._rng)

    def hide(self, hider: Pose) -> Frame:
        """Hide the other robot; returns its picture once the seeker may see it."""
        picture = self.experimenter.place_hider(hider)
        self.client.wait_for_frame(picture.stamp_ns)
        return picture

    def play(self, seed: int, max_steps: int, watch: Watch | None = None) -> Round:
        """One round with a random place to hide."""
        return self.seek(*self.choose(), seed, max_steps, watch)

    def seek(self, start: Pose, hider: Pose, seed: int, max_steps: int, watch: Watch | None = None) -> Round:
        """Hide, extract the picture's features, go there."""

        def drive(picture: Frame) -> MissionRun:
            goal = goal_features(self._stack.bus, picture)
            request = MissionRequest(action="goto", map=self._map, goal=goal, seed=seed, max_steps=max_steps)
            return self.client.run(request, watch)

        return self.seek_by(start, hider, drive)

    def seek_by(self, start: Pose, hider: Pose, drive: Callable[[Frame], MissionRun]) -> Round:
        """Hide, and let `drive` bring the seeker to the picture."""
        picture, usable = self.hide(hider), self._usable_edges()
        moved = self.experimenter.moves
        run = drive(picture)
        played = self.finish(start, hider, picture, run, self.experimenter.moves - moved)
        return replace(played, edges_suspended=max(0, usable - self._usable_edges()))

    def final_views(self, hider: Pose) -> tuple[Frame, Frame]:
        """What the seeker sees now, and what the hider saw."""
        with self._stack.session() as own:
            frame = own.bus.subscribe(FRAME, robot=own.robot).wait(FRAME_TIMEOUT_S)
        if frame is None:
            raise ExperimentError(f"no frame of {self._stack.robot} within {FRAME_TIMEOUT_S:.0f} s")
        return frame, self.experimenter.look(hider)

    def finish(self, start: Pose, hider: Pose, goal: Frame, run: MissionRun, moves: int) -> Round:
        """Read where the seeker stands now."""
        final = self.experimenter.settled_truth(run.last_seq).pose
        self.client.collect()
        shortest_m = self._space.shortest_path_m((start.x_m, start.y_m), (hider.x_m, hider.y_m))
        return Round(start, hider, final, goal, run, shortest_m, moves, self._arrived_m)

    def _usable_edges(self) -> int:
        found = read_map(self._stack, self._map)
        return sum(not edge.suspended for edge in found.edges) if found is not None else 0
