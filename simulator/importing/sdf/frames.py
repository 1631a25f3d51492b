"""Frames within a model of SDF: links, joints, frames and models that poses may be relative to. Pure."""

import xml.etree.ElementTree as ElementTree

import numpy as np
import numpy.typing as npt

from simulator.importing.entities import WorldImportError
from simulator.importing.sdf.numbers import text_of
from simulator.importing.sdf.poses import frame_of, pose_matrix

FloatArray = npt.NDArray[np.float64]
OWN = {"", "world", "__model__", "__root__"}
"""Names of the frame of the model or world itself."""
MOST_STEPS = 50  # untrusted input


class Frames:
    """Poses by name, in the frame of one model or of the world."""

    def __init__(self, holder: ElementTree.Element, where: str) -> None:
        """Note every frame that `holder` defines; nothing is computed yet."""
        self._where = where
        self._named: dict[str, tuple[ElementTree.Element, str]] = {}
        for one in holder:
            if one.tag in {"link", "frame", "model", "joint", "include"}:
                name = one.get("name") or text_of(one, "name") or ""
                rest = {"frame": one.get("attached_to", ""), "joint": text_of(one, "child") or ""}
                self._named[name] = one, rest.get(one.tag, "")

    def pose(self, element: ElementTree.Element, where: str, default: FloatArray | None = None) -> FloatArray:
        """Pose of an element, (4, 4); relative to `default` unless it names a frame.

        Raises:
            WorldImportError: the frame is not there, or frames go round in a circle.
        """
        frame = frame_of(element)
        base = self._resolved(frame, where, 0) if frame not in OWN else default
        own = pose_matrix(element, where)
        return own if base is None else np.asarray(base @ own)

    def _resolved(self, name: str, where: str, steps: int) -> FloatArray:
        if name in OWN:
            return np.eye(4)
        if name not in self._named:
            known = ", ".join(n for n in self._named if n)[:200] or "none"
            raise WorldImportError(
                f"{where}: pose is relative to frame {name!r:.60}; frames here are {known}"
            )
        if steps > MOST_STEPS:
            raise WorldImportError(f"{where}: frames must not go round in a circle, {name!r:.60} does")
        element, rest = self._named[name]
        base = self._resolved(frame_of(element) or rest, f"{self._where} frame {name!r:.60}", steps + 1)
        return np.asarray(base @ pose_matrix(element, f"{self._where} frame {name!r:.60}"))
