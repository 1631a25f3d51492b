"""The record of a robot's mission in the map store, from which a planner that restarts goes on."""

import uuid
from typing import Any

from services.planner.settings import PlannerSettings
from shared.bus import Bus
from shared.messages.maps import MissionRecord, MissionRecordRequest
from shared.messages.missions import FailureKind, MissionRequest, MissionState
from shared.topics import MISSION_RECORD


class MissionRecords:
    """Claims and saves the record of one robot.

    What the map store does not answer is a QueryError; an end is then kept until `settle` saves it.
    """

    def __init__(self, settings: PlannerSettings, bus: Bus) -> None:
        self._bus, self.robot, self._timeout_s = bus, settings.robot, settings.map_timeout_s
        self._unsaved: MissionRecord | None = None

    def claim(self, record: MissionRecord) -> MissionRecord:
        """Take over from a planner before; what it left, with a new epoch."""
        return self._ask(MissionRecordRequest(action="claim", record=record))

    def save(self, record: MissionRecord) -> None:
        """Keep a record instead of the last one."""
        self._ask(MissionRecordRequest(action="save", record=record))

    def end(self, ended: MissionRecord) -> None:
        """Keep how a mission ended."""
        self._unsaved = ended
        self.settle()

    def settle(self) -> None:
        """Save an end that the map store was not there to hear of."""
        if self._unsaved is not None:
            self.save(self._unsaved)
            self._unsaved = None

    def _ask(self, request: MissionRecordRequest) -> MissionRecord:
        return self._bus.ask(MISSION_RECORD, request, self._timeout_s, robot=self.robot)


def begun(before: MissionRecord, request: MissionRequest) -> MissionRecord:
    """The record of a mission that begins, by the planner whose record `before` is."""
    return MissionRecord(
        robot=before.robot,
        epoch=before.epoch,
        mission_id=request.mission_id or uuid.uuid4().hex[:12],
        action=request.action,
        map=request.map,
        parameters=request.parameters,
        checkpoint=request.checkpoint,
        goal=request.goal,
        goal_node=request.goal_node,
        seed=request.seed,
        max_steps=request.max_steps,
    )


def ended(
    record: MissionRecord, state: MissionState, failure: FailureKind, reason: str, step: int
) -> MissionRecord:
    """What stays of the record of a mission that ended after so many steps."""
    kept = MissionRecord(
        robot=record.robot,
        epoch=record.epoch,
        mission_id=record.mission_id,
        map=record.map,
        seed=record.seed,
        max_steps=record.max_steps,
        step=step,
    )
    how = {"ended_action": record.action, "outcome": state, "failure": failure}
    return kept.model_copy(update={**how, "reason": reason[:400]})


def parameters_of(record: MissionRecord) -> dict[str, Any]:
    """Of the mission, with the goal node of a sender or a record that knows no parameters."""
    node = {} if record.goal_node is None else {"goal_node": record.goal_node}
    return {**record.parameters, **node}


def has_goal(record: MissionRecord) -> bool:
    """Whether the mission is to get to somewhere that the map has."""
    return record.goal is not None or not {"goal_node", "place", "sign"}.isdisjoint(parameters_of(record))
