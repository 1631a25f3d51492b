"""<geometry> of SDF -> shapes."""

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np

from simulator.importing.entities import MissingFileError, Paint, Primitive, Shape, WorldImportError, identity
from simulator.importing.sdf.materials import GREY, paint_of
from simulator.importing.sdf.numbers import numbers, text_of
from simulator.importing.sdf.resources import Resources

LEVEL = 0.01  # a plane that rises less is level
MOST_SIZE_M = 1000.0  # untrusted input
SIZES = {"cylinder": ("radius", "length"), "sphere": ("radius",)}


def is_plane(part: ElementTree.Element, where: str) -> bool:
    """Whether a <visual> or <collision> is an endless floor that lies level."""
    plane = part.find("geometry/plane")
    if plane is None:
        return False
    x, y, z = numbers(text_of(plane, "normal") or "0 0 1", 3, f"{where}: normal must be x y z")
    return z > 0.0 and abs(x) + abs(y) < LEVEL * z


def shapes_of(
    part: ElementTree.Element, where: str, folder: Path, resources: Resources
) -> tuple[list[Shape], list[str]]:
    """The shape of a <visual> or <collision> in its own frame, and what of it cannot be shown.

    Raises:
        MissingFileError: a mesh that is not there.
        WorldImportError: measures that are none.
    """
    geometry = part.find("geometry")
    if geometry is None or not len(geometry):
        raise WorldImportError(f"{where}: <geometry> must hold a shape, got none")
    shape, name = geometry[0], part.get("name", "")
    if shape.tag in {"plane", "empty"}:
        return [], []
    if shape.tag not in {"mesh", "box", *SIZES}:
        return [], [f"{where}: <{shape.tag:.40}> is not read; give it as a mesh"]
    paint, missing = paint_of(part, where, folder, resources) if part.tag == "visual" else (Paint(), [])
    if shape.tag == "mesh":
        return [_mesh(shape, name, where, folder, resources, paint)], missing
    if paint.colour is None and paint.picture is None:
        paint = Paint(GREY, None, paint.opacity, paint.two_sided)
    return [Shape(_primitive(shape, where), identity(), name, paint=paint)], missing


def _mesh(
    shape: ElementTree.Element, name: str, where: str, folder: Path, resources: Resources, paint: Paint
) -> Shape:
    uri = text_of(shape, "uri") or text_of(shape, "filename")
    if uri is None:
        raise WorldImportError(f"{where}: <mesh> must have a <uri>, got none")
    try:
        file = resources.find(uri, folder)
    except MissingFileError:
        raise  # whoever counts what is missing says who names it
    except WorldImportError as error:
        raise WorldImportError(f"{where}: {error}") from error
    x, y, z = numbers(text_of(shape, "scale") or "1 1 1", 3, f"{where}: scale must be x y z")
    if not min(abs(x), abs(y), abs(z)) > 0:
        raise WorldImportError(f"{where}: scale must not be 0, got {x:g} {y:g} {z:g}")
    return Shape(file, identity(), name, (x, y, z), paint, text_of(shape, "submesh/name"))


def _primitive(shape: ElementTree.Element, where: str) -> Primitive:
    if shape.tag == "box":
        size = numbers(text_of(shape, "size") or "", 3, f"{where}: box size must be x y z")
    else:
        size = [
            numbers(text_of(shape, n) or "", 1, f"{where}: {shape.tag} {n} must be a number")[0]
            for n in SIZES[shape.tag]
        ]
    if not all(0.0 < side <= MOST_SIZE_M for side in np.array(size)):
        raise WorldImportError(
            f"{where}: {shape.tag} must be above 0 and at most {MOST_SIZE_M:g} m, got {size}"
        )
    kind = "box" if shape.tag == "box" else "cylinder" if shape.tag == "cylinder" else "sphere"
    return Primitive(kind, tuple(size))  # type: ignore[arg-type]
