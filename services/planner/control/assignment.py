"""A mission that is under way, with the map and the matcher that it works with."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from services.planner.control.records import parameters_of
from services.planner.mission_kinds import MissionContext, MissionKinds
from services.planner.ports import Mission
from services.planner.profiles import Profile
from services.planner.remote.map_changes import MapChanges
from services.planner.remote.remote_inspector import RemoteInspector
from services.planner.remote.remote_map import RemoteMap
from services.planner.remote.remote_matcher import RemoteMatcher
from services.planner.remote.traffic import Traffic
from services.planner.settings import PlannerSettings
from services.planner.travel.whereabouts import Whereabouts
from shared.bus import Bus
from shared.mapgraph.graph import MapGraph
from shared.messages.maps import MissionRecord


@dataclass
class Assignment:
    """What a mission under way consists of.

    Attributes:
        whereabouts: where the robot is, for the mission after it.
        known: the map as the mission knows it.
    """

    mission: Mission
    map: RemoteMap
    matcher: RemoteMatcher
    whereabouts: Whereabouts
    known: MapGraph

    def lost_nodes(self) -> list[int]:
        """Nodes that the mission knows and somebody took away since."""
        if self.known is self.map.graph:  # only reading the map again makes another graph
            return []
        lost = sorted(self.known.nodes.keys() - self.map.graph.nodes.keys())
        if not lost:
            self.known = self.map.graph
        return lost


class Assigner:
    """Makes missions from their records, each with a map and a matcher. MissionError where it cannot.

    Args:
        meanwhile: what else there is to do now and then while the feature service is waited for.
    """

    def __init__(
        self,
        settings: PlannerSettings,
        profile: Profile,
        kinds: MissionKinds,
        bus: Bus,
        meanwhile: Callable[[], None] | None = None,
    ) -> None:
        self._settings, self._bus = settings, bus
        self.profile, self.kinds = profile, kinds
        self._meanwhile = meanwhile
        self.traffic = Traffic(bus, settings.robot, settings.query_timeout_s)
        self.changes = MapChanges(bus)

    def map_called(self, name: str) -> RemoteMap:
        """A map that is not loaded yet; from now on it is the one of which changes are heard."""
        self.changes.follow(name)
        return RemoteMap(self._bus, name, self._settings.map_timeout_s, self.traffic, self.changes)

    def begin(self, record: MissionRecord, before: Assignment | None, *, create: bool) -> Assignment:
        """Take a mission up where the one before left the robot; `create` makes a map that is missing."""
        maps = self.map_called(record.map)
        maps.load(create=create)
        timeout_s = self._settings.query_timeout_s
        matcher = RemoteMatcher(self._bus, record.robot, maps, timeout_s, self._meanwhile)
        whereabouts = Whereabouts() if before is None else before.whereabouts
        return self._made(record, maps, matcher, whereabouts.of(record.map))

    def again(self, record: MissionRecord, under_way: Assignment) -> Assignment:
        """The same mission anew, on the map as it is now."""
        whereabouts = under_way.whereabouts.of(record.map)
        return self._made(record, under_way.map, under_way.matcher, whereabouts)

    def _made(
        self, record: MissionRecord, maps: RemoteMap, matcher: RemoteMatcher, whereabouts: Whereabouts
    ) -> Assignment:
        rng = np.random.default_rng(record.seed)
        timeout_s = self._settings.map_timeout_s
        inspector = RemoteInspector(self._bus, maps, matcher, record.mission_id, timeout_s)
        context = MissionContext(
            self.profile, maps, matcher, rng, record.goal, whereabouts, inspector, record.checkpoint
        )
        mission = self.kinds[record.action].start(context, parameters_of(record))
        return Assignment(mission, maps, matcher, whereabouts, maps.graph)
