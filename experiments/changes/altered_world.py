"""A world as furniture in it is altered, and what a picture of it should show as changed."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from experiments.changes.alterations import Alteration
from experiments.changes.judging import Truth
from experiments.changes.sights import FAR_M, SHADE, Measured, labels_of
from shared.messages.simulation import Pose
from simulator.simulation import Simulation
from simulator.world.changes import ChangeError

Changed = tuple[Sequence[Alteration], Truth]
"""Alterations that a picture should show, and where: the first is number 1 there."""


class AlteredWorld:
    """A simulation here, of which pictures are taken with one or other set of alterations.

    Args:
        simulation: of the world as it is first.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._altered: Sequence[Alteration] = ()

    def takes(self, one: Alteration) -> bool:
        """Whether this can be done to the world as it is first."""
        self._become(())
        try:
            alter(self._simulation, [one], back=False)
        except ChangeError:
            return False
        alter(self._simulation, [one], back=True)
        return True

    def measured(self, pose: Pose, altered: Sequence[Alteration]) -> Measured:
        """Picture and ranges from a pose, of the world with these alterations and no others."""
        self._become(altered)
        return self._simulation.measured_at(pose.x_m, pose.y_m, pose.yaw_rad)

    def _become(self, altered: Sequence[Alteration]) -> None:
        alter(self._simulation, [each for each in self._altered if each not in altered], back=True)
        alter(self._simulation, [each for each in altered if each not in self._altered], back=False)
        self._altered = tuple(altered)


def alter(world: Any, drawn: Sequence[Alteration], back: bool) -> None:
    """Do it, or undo it, in a running stack or in a simulation, which takes poses as tuples."""
    for each in drawn:
        if back:
            world.set_item(each.name, True)
        elif each.pose is None:
            world.set_item(each.name, False)
        else:
            pose = each.pose
            as_tuple = (pose.x_m, pose.y_m, pose.yaw_rad)
            world.set_item(each.name, None, as_tuple if isinstance(world, Simulation) else pose)


def changed(
    pose: Pose, before: Measured, after: Measured, was: Sequence[Alteration], now: Sequence[Alteration]
) -> Changed:
    """What a picture shows that an earlier one of its place did not, or not so.

    Args:
        pose: of the camera that took it.
        before: from that pose, picture and ranges of the world as the earlier one saw it.
        after: the same as it is.
        was: alterations of the world as the earlier one saw it.
        now: as it is.
    """
    changes = [each for each in [*was, *now] if each not in was or each not in now]
    if not changes:
        return changes, Truth(np.zeros(before[1].shape, np.uint8), 0)
    labels = labels_of(pose, before, after, changes)
    for number, each in enumerate(changes, start=1):
        if min(math.dist((pose.x_m, pose.y_m), spot) for spot in each.spots) >= FAR_M:
            labels = np.where(labels == number, np.uint8(SHADE), labels)
    return changes, Truth(labels, len(changes))
