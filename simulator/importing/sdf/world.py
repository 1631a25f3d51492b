"""SDF worlds (http://sdformat.org/spec, 1.4 to 1.11) -> entities with what is seen and felt of them."""

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import numpy.typing as npt

from simulator.importing.entities import Entity, Scene, WorldImportError
from simulator.importing.sdf.frames import Frames
from simulator.importing.sdf.lights import lamps_of, sun_of
from simulator.importing.sdf.models import Models
from simulator.importing.sdf.numbers import rgb_of
from simulator.importing.sdf.poses import pose_matrix
from simulator.importing.sdf.resources import Resources, read_xml

FloatArray = npt.NDArray[np.float64]
NOT_SHOWN = ("actor", "population", "road")
MOST_MODELS = 3000  # as many pieces of furniture as a world file takes


def read_sdf(path: Path, resources: Resources) -> tuple[Scene, list[str]]:
    """Read a world file and the models it includes.

    Returns:
        The scene, and which files are missing, one line each.

    Raises:
        WorldImportError: not SDF, or a part of it cannot be used; the message names file and element.
    """
    root = read_xml(path)
    if root.tag != "sdf":
        raise WorldImportError(f"{path} must be SDF, its first element <sdf>; got <{root.tag:.40}>")
    world = root.find("world")
    top = root if world is None else world
    elements = [one for one in top if one.tag in {"model", "include"}]
    if not 0 < len(elements) <= MOST_MODELS:
        raise WorldImportError(
            f"{path} must hold 1 to {MOST_MODELS} <model> and <include> elements, got {len(elements)}"
        )
    reader = Models(resources)
    frames, states = Frames(top, str(path)), _states(top)
    planes: list[float] = []
    entities = []
    for element in elements:
        model = reader.read(element, path)
        where = f"{path}: model {model.name!r:.60}"
        pose = frames.pose(element, where) if model.pose is None else model.pose
        pose = states.get(model.name, pose)
        planes += [float(pose[2, 3]) + height_m for height_m in model.planes]
        if model.bodies:
            entities.append(Entity(model.name, model.kind, pose, tuple(model.bodies), model.jointed))
    hidden = [f"{one.tag} {one.get('name', '')!r:.60} is not shown" for one in top if one.tag in NOT_SHOWN]
    sun = sun_of(top, path, "sun" in reader.built_in)
    scene = Scene(
        tuple(entities),
        tuple(lamps_of(top, path, frames)),
        sun,
        min(planes, default=None),
        rgb_of(top, "scene/ambient", f"{path}: scene"),
        None
        if sun or top.find("scene/sky") is not None
        else rgb_of(top, "scene/background", f"{path}: scene"),
        (*hidden, *dict.fromkeys(reader.left_out)),
    )
    return scene, [f"{where}: {what}" for what, where in reader.missing.items()]


def _states(top: ElementTree.Element) -> dict[str, FloatArray]:
    """Poses by model of a world that was saved while it ran: they count."""
    return {
        model.get("name", ""): pose_matrix(model, f"state of model {model.get('name', '')!r:.60}")
        for model in top.iterfind("state/model")
        if model.find("pose") is not None
    }
