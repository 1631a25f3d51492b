"""Driven rounds of the mission inspect, furniture moved between them, held against what really changed."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import httpx
import numpy as np

from experiments.changes.alterations import Alteration, draw_alteration
from experiments.changes.altered_world import AlteredWorld, Changed, alter, changed
from experiments.changes.passages import reached, shuts_off
from experiments.changes.sights import FAR_M
from experiments.rendered.frames import simulated
from services.launcher.client.failure import ExperimentError
from services.launcher.evaluation.rounds import Game
from services.launcher.terminal.output import rounded
from shared.messages.inspections import Region
from shared.messages.missions import MissionRequest
from shared.messages.simulation import Pose
from simulator.world.world_file import WorldFile

CLEAR_M = 0.6
"""Between what is moved and a place: the robot can still get there."""
TRIES = 50
MAX_STEPS = 20_000

Row = dict[str, Any]


@dataclass(frozen=True)
class Seen:
    """What an inspection of a place said."""

    place: str
    pose: Pose
    compared: bool
    regions: tuple[Region, ...]


class Rounds:
    """Rounds one after the other; every other one undoes what was altered before the last.

    Args:
        game: a stack that knows the map.
        store: a client of its map store.
        map_name: of the map.
        world: as the map saw it.
        places: true poses of the nodes with a name, by name.
        rng: draws what is altered.
        illumination: of every other round, see `Disturbances`; the others are at noon.
    """

    def __init__(
        self,
        game: Game,
        store: httpx.Client,
        map_name: str,
        world: WorldFile,
        places: Mapping[str, Pose],
        rng: np.random.Generator,
        illumination: float = 0.0,
    ) -> None:
        self._illumination = illumination
        self._game, self._store, self._map, self._places, self._rng = game, store, map_name, places, rng
        self._world, self._local = world, AlteredWorld(simulated(world))
        self._altered: list[Alteration] = []
        self._pictured: dict[str, list[Alteration]] = {}

    def play(self, rounds: int, changes: int, seed: int) -> Iterator[Row]:
        """A first round, which only takes pictures, then so many with so many changes before each."""
        seen = self._drive(seed)
        self._pictured = {each.place: [] for each in seen}
        yield {"round": 0, **self._figures(seen, [], {})}
        for number in range(1, rounds + 1):
            drawn = self._altered or self._draw(changes)
            back = bool(self._altered)
            alter(self._game.experimenter, drawn, back)
            if self._illumination:
                self._game.experimenter.set_light(self._illumination * (number % 2))
            self._altered = [] if back else drawn
            seen = self._drive(seed + number)
            truths = self._truths(seen)
            self._pictured |= {each.place: self._altered for each in seen}
            yield {"round": number, **self._figures(seen, drawn, truths)}

    def _draw(self, count: int) -> list[Alteration]:
        """Alterations of pieces near a place that shut no place off; the simulator takes each of them."""
        drawn: list[Alteration] = []
        spots = [(pose.x_m, pose.y_m) for pose in self._places.values()]
        within = reached(self._world, spots)
        for _ in range(TRIES):
            one = draw_alteration(self._world, self._rng, {each.name for each in drawn})
            away = [math.dist(spot, at) for spot in one.spots for at in spots]
            near = min(away) < FAR_M / 2
            shut = one.after is not None and any(
                math.dist(one.after, at) < one.reach_m + CLEAR_M for at in spots
            )
            possible = near and not shut and self._local.takes(one)
            if possible and not shuts_off(self._world, [*drawn, one], within):
                drawn.append(one)
            if len(drawn) == count:
                return drawn
        raise ExperimentError(f"{self._world.name} has no {count} pieces to move near its places")

    def _drive(self, seed: int) -> list[Seen]:
        request = MissionRequest(
            action="inspect",
            map=self._map,
            parameters={"places": list(self._places)},
            seed=seed,
            max_steps=MAX_STEPS,
        )
        run = self._game.client.run(request)
        answer = self._store.get(f"/maps/{self._map}/inspections/{run.status.mission_id}-1")
        answer.raise_for_status()
        trail, seen = self._game.client.trail, []
        for visit in answer.json()["visits"]:
            pose = trail.pose_at(visit["stamp_ns"])
            if pose is None:
                raise ExperimentError(f"no true pose is known for the picture of {visit['place']}")
            regions = tuple(Region.model_validate(each) for each in visit["changes"])
            seen.append(Seen(visit["place"], pose, visit["against_ns"] is not None, regions))
        return seen

    def _truths(self, seen: Sequence[Seen]) -> dict[str, Changed]:
        """What is otherwise than in the picture compared, which is older where a round was missed."""
        now = self._altered
        was = {each.place: self._pictured.get(each.place, now) for each in seen}
        before = {each.place: self._local.measured(each.pose, was[each.place]) for each in seen}
        after = {each.place: self._local.measured(each.pose, now) for each in seen}
        return {s.place: changed(s.pose, before[s.place], after[s.place], was[s.place], now) for s in seen}

    def _figures(
        self, seen: Sequence[Seen], drawn: Sequence[Alteration], truths: Mapping[str, Changed]
    ) -> Row:
        """A change counts once, whatever number of places see it."""
        found: dict[Alteration, bool] = {}
        false = 0
        for each in seen:
            if each.place in truths:
                changes, truth = truths[each.place]
                verdict = truth.judge(each.regions)
                false += len(verdict.false)
                for number, hit in verdict.by_number.items():
                    change = changes[number - 1]
                    found[change] = found.get(change, False) or hit
            else:
                false += len(each.regions)
        offsets = [self._offset_m(each) for each in seen]
        asked = [hit for change, hit in found.items() if change in drawn]
        return {
            "visits": len(seen),
            "missed": len(self._places) - len(seen),
            "compared": sum(each.compared for each in seen),
            "offset_m_median": rounded(np.median(offsets), 3) if offsets else None,
            "offset_m_most": rounded(max(offsets), 3) if offsets else None,
            "altered": len(drawn),
            "in_sight": len(asked),
            "reported": sum(asked),
            "false": false,
        }

    def _offset_m(self, seen: Seen) -> float:
        place = self._places[seen.place]
        return math.hypot(seen.pose.x_m - place.x_m, seen.pose.y_m - place.y_m)
