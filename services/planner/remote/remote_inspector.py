"""Visits to places: pictures compared by the feature service, kept by the map store."""

from services.planner.remote.remote_map import RemoteMap
from services.planner.remote.remote_matcher import RemoteMatcher
from shared.bus import Bus
from shared.messages.inspections import CompareRequest, Inspection, InspectionRequest
from shared.topics import COMPARE, INSPECTION

COMPARE_TIMEOUT_S = 40.0
"""Longest wait for a comparison, while the robot stands; chosen: three times what spots 0.3 m
apart took where two cores had work for ten; alone they take a second."""


class RemoteInspector:
    """Inspects with the frame that `matcher` asks about.

    Args:
        mission_id: of the mission that inspects.
        store_timeout_s: longest wait for the map store.
    """

    def __init__(
        self,
        bus: Bus,
        maps: RemoteMap,
        matcher: RemoteMatcher,
        mission_id: str,
        store_timeout_s: float,
    ) -> None:
        self._bus, self._maps, self._matcher = bus, maps, matcher
        self._mission_id = mission_id
        self._store_timeout_s = store_timeout_s

    def inspect(self, place: str, round_number: int, keep: int) -> Inspection:
        """Picture, comparison and record of a place; QueryError where a service does not answer.

        Made again, as after a restart, it takes the place of the one before.
        """
        about = {"place": place, "mission_id": self._mission_id, "round": round_number, "keep": keep}
        last = self._ask(InspectionRequest(action="last", **about))
        seen = self._matcher.ask_features(
            COMPARE,
            CompareRequest(
                seq=self._matcher.frame_seq,
                stamp_ns=self._matcher.frame_stamp_ns,
                reference=b"" if last is None else last.picture,
            ),
            COMPARE_TIMEOUT_S,
            robot=self._matcher.robot,
        )
        visit = Inspection(
            seq=seen.seq,
            stamp_ns=seen.stamp_ns,
            robot=self._matcher.robot,
            mission_id=self._mission_id,
            round=round_number,
            place=place,
            against_ns=last.stamp_ns if last is not None and seen.compared else None,
            why=seen.why,
            inliers=seen.inliers,
            yaw_rad=seen.yaw_rad,
            disparity_rad=seen.disparity_rad,
            regions=seen.regions,
            picture=seen.picture,
        )
        self._ask(InspectionRequest(action="save", inspection=visit, **about))
        return visit

    def _ask(self, request: InspectionRequest) -> Inspection | None:
        return self._bus.ask(INSPECTION, request, self._store_timeout_s, map=self._maps.name).inspection
