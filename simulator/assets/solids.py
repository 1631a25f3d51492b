"""What of a model stops the robot, by the outline that a world file chooses. Pure."""

from collections.abc import Sequence
from typing import Literal

import numpy as np

from simulator.assets.hollow import is_hollow
from simulator.assets.shell import shell_of
from simulator.scene.meshes import Mesh, joined
from simulator.scene.prisms import MOST_PRISMS, SKIN_M, Prism, hull_outline, prisms_of

Outline = Literal["convex", "concave", "sheets", "box", "none"]
MOST_SHEETS = 20_000  # chosen: a floor of offices has 8000


def prisms(shapes: Sequence[Mesh], outline: Outline) -> list[Prism]:
    """Prisms of a model whose z axis points up.

    Args:
        shapes: its nodes; what touches in different nodes stays apart.
        outline: convex hulls of what hangs together in a slice; sheets along all faces; concave: sheets of
            the nodes whose hulls would fill floor between their faces, hulls of the others; one box
            round everything; or none.

    Raises:
        ValueError: it falls into too many pieces.
    """
    if outline == "none" or not shapes:
        return []
    if outline == "convex":
        return _hulls(shapes)
    if outline in ("concave", "sheets"):
        return _sheets(shapes, always=outline == "sheets")
    points = joined(list(shapes)).vertices.astype(float)
    low, high = points.min(axis=0), points.max(axis=0)
    corners = hull_outline(np.array([(x, y) for x in (low[0], high[0]) for y in (low[1], high[1])]))
    return [Prism(float(low[2]), float(max(high[2], low[2] + SKIN_M)), corners)]


def needs_sheets(shapes: Sequence[Mesh]) -> bool:
    """Whether convex hulls would fill floor on which the robot fits between the faces of a node."""
    low_m = min((float(shape.vertices[:, 2].min()) for shape in shapes), default=0.0)
    return any(is_hollow(shape, low_m) for shape in shapes)


def _hulls(shapes: Sequence[Mesh]) -> list[Prism]:
    """Of each node by itself; of all together where the nodes are many, as leaves are."""
    found: list[Prism] = []
    if len(shapes) <= MOST_PRISMS:
        for shape in shapes:
            found += prisms_of(shape.vertices.astype(float), shape.triangles)
        if len(found) <= MOST_PRISMS:
            return found
    whole = joined(list(shapes))
    return prisms_of(whole.vertices.astype(float), whole.triangles)


def _sheets(shapes: Sequence[Mesh], always: bool) -> list[Prism]:
    low_m = min(float(shape.vertices[:, 2].min()) for shape in shapes)
    found: list[Prism] = []
    for shape in {_place(shape): shape for shape in shapes}.values():
        cut = shell_of if always or is_hollow(shape, low_m) else prisms_of
        found += cut(shape.vertices.astype(float), shape.triangles)
    if len(found) > MOST_SHEETS:
        raise ValueError(
            f"the mesh must fall into at most {MOST_SHEETS} pieces, got {len(found)}; give it a simpler "
            "collision file, or choose collision: convex or box"
        )
    return found


def _place(shape: Mesh) -> bytes:
    """Equal for nodes that fill the same place: many files have each face twice, for its two sides."""
    return np.unique(shape.vertices.round(4), axis=0).tobytes()
