"""Answers the experimenter's requests: reset, robots, furniture, light, pictures from anywhere."""

from shared.messages.sensors import Frame
from shared.messages.simulation import SimulationReply, SimulationRequest
from simulator.outbox import MessageMaker
from simulator.scene.parts import Pose2
from simulator.simulation import Simulation
from simulator.world.changes import ChangeError


class RequestError(ValueError):
    """A request that cannot be carried out; the text goes back to the asker."""


class Experimenter:
    """Carries out requests on a simulation."""

    def __init__(self, simulation: Simulation, maker: MessageMaker, seed: int) -> None:
        self._simulation, self._maker, self._seed = simulation, maker, seed

    def handle(self, request: SimulationRequest, seq: int, stamp_ns: int) -> tuple[SimulationReply, bool]:
        """Carry out one request.

        Returns:
            The reply, and whether what the robot senses has changed, so that the frame in flight is void.

        Raises:
            RequestError: a pose is missing or lies outside the world, or the world cannot change like that.
        """
        frame: Frame | None = None
        if request.action == "reset":
            pose = self._pose(request) if request.pose is not None else None
            self._seed = self._seed if request.seed is None else request.seed
            self._simulation.reset(self._seed, pose)
        elif request.action == "place_robot":
            self._simulation.place_robot(*self._pose(request))
        elif request.action == "place_hider":
            pose = self._pose(request)
            self._simulation.place_hider(*pose)
            frame = self._maker.look(pose, seq, stamp_ns)
        elif request.action == "remove_hider":
            self._simulation.remove_hider()
        elif request.action == "look":
            true = self._simulation.truth()
            here = (true.x_m, true.y_m, true.yaw_rad)
            pose = here if request.pose is None else self._pose(request)
            frame = self._maker.look(pose, seq, stamp_ns)
        elif request.action in {"set_item", "place_obstacle"}:
            self._change_world(request)
        elif request.action == "set_light":
            if request.illumination is None:
                raise RequestError("set_light needs the time of day (illumination, 0 to 1), got none")
            self._simulation.set_light(request.illumination)
        changed = request.action not in {"look", "truth"}
        return SimulationReply(
            seq=seq, stamp_ns=stamp_ns, truth=self._maker.truth(seq, stamp_ns), frame=frame
        ), changed

    def _change_world(self, request: SimulationRequest) -> None:
        """Move, remove, restore or add a piece of furniture."""
        try:
            if request.action == "set_item":
                if request.item is None:
                    raise RequestError("set_item needs the item's name, got none")
                pose = self._pose(request) if request.pose is not None else None
                self._simulation.set_item(request.item, request.present, pose)
                return
            if request.kind is None:
                raise RequestError("place_obstacle needs a kind of furniture, got none")
            self._simulation.place_obstacle(request.kind, self._pose(request), request.item)
        except ChangeError as error:
            raise RequestError(f"{request.action}: {error}") from error

    def _pose(self, request: SimulationRequest) -> Pose2:
        if request.pose is None:
            raise RequestError(f"{request.action} needs a pose (x_m, y_m, yaw_rad), got none")
        pose = (request.pose.x_m, request.pose.y_m, request.pose.yaw_rad)
        world = self._simulation.world
        if not world.holds(pose[0], pose[1]):
            raise RequestError(
                f"{request.action}: ({pose[0]}, {pose[1]}) must lie inside a room of {world.name}"
            )
        return pose
