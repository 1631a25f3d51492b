"""Models of SDF, with those that they include, as shapes in their own frame."""

import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import numpy.typing as npt

from simulator.importing.entities import Body, MissingFileError, Shape, WorldImportError
from simulator.importing.sdf.frames import Frames
from simulator.importing.sdf.numbers import text_of
from simulator.importing.sdf.resources import Resources, read_xml
from simulator.importing.sdf.shapes import is_plane, shapes_of

FloatArray = npt.NDArray[np.float64]
MOST_DEPTH = 12  # models within models; untrusted input
MOST_SHAPES = 20_000  # of all models; untrusted input
BUILT_IN = {"ground_plane": "plane", "ground plane": "plane", "sun": "sun"}
"""Models that Gazebo has everywhere, by the last word of their URI: an endless floor, and daylight."""


@dataclass
class ModelShapes:
    """A model: its shapes in its own frame, and heights of endless floors in it.

    Attributes:
        name: in what holds it.
        kind: the folder that it was included from, "" for one that is written out.
        pose: of an included model, that of its own file, (4, 4); None where what holds it says where it is.
        bodies, planes: all of it.
        jointed: whether joints hold its links together.
    """

    name: str
    kind: str = ""
    pose: FloatArray | None = None
    bodies: list[Body] = field(default_factory=list)
    planes: list[float] = field(default_factory=list)
    jointed: bool = False

    def take(self, inner: "ModelShapes", at: FloatArray) -> None:
        """Add a model within this one, at a pose in this one's frame."""
        for body in inner.bodies:
            self.bodies.append(replace(body, pose=at @ body.pose, name=f"{inner.name} {body.name}"))
        self.planes += [float(at[2, 3]) + height_m for height_m in inner.planes]
        self.jointed |= inner.jointed


class Models:
    """Reads models, each file once. Keeps what was left out, and what is missing."""

    def __init__(self, resources: Resources) -> None:
        """Find files by `resources`."""
        self._resources = resources
        self._files: dict[Path, ElementTree.Element] = {}
        self._count = self._misses = 0
        self.left_out: list[str] = []
        self.missing: dict[str, str] = {}
        """What cannot be used, and the first who names it."""
        self.planes: list[float] = []
        self.built_in: set[str] = set()

    def read(self, element: ElementTree.Element, path: Path, depth: int = 0) -> ModelShapes:
        """A <model> or <include> of a file.

        Raises:
            WorldImportError: a part of it cannot be used.
        """
        self._count_one(path)
        if depth > MOST_DEPTH:
            raise WorldImportError(
                f"{path}: models must lie at most {MOST_DEPTH} deep; does one include itself?"
            )
        if element.tag == "include":
            return self._included(element, path, depth)
        name = element.get("name", "")
        where = f"{path}: model {name!r:.60}"
        frames = Frames(element, where)
        model = ModelShapes(name, jointed=element.find("joint") is not None)
        for link in element.iterfind("link"):
            own = link.get("name", "")
            at = frames.pose(link, f"{where} link {own!r:.60}")
            shapes: dict[str, list[Shape]] = {"visual": [], "collision": []}
            misses = self._misses
            for part in link:
                if part.tag in shapes:
                    shapes[part.tag] += self._placed(part, f"{where} {part.tag}", path, frames, at, model)
            if shapes["visual"] or shapes["collision"]:
                seen, felt = tuple(shapes["visual"]), tuple(shapes["collision"])
                model.bodies.append(Body(own, at, seen, felt, lost=self._misses > misses))
        for inner in element:
            if inner.tag in {"model", "include"}:
                one = self.read(inner, path, depth + 1)
                model.take(one, frames.pose(inner, where) if one.pose is None else one.pose)
                model.kind = model.kind or one.kind
        return model

    def _placed(
        self,
        part: ElementTree.Element,
        where: str,
        path: Path,
        frames: Frames,
        link: FloatArray,
        model: ModelShapes,
    ) -> list[Shape]:
        """The shapes of a <visual> or <collision>, in the frame of its link."""
        where = f"{where} {part.get('name', '')!r:.60}"
        pose = np.linalg.inv(link) @ frames.pose(part, where, link)
        if is_plane(part, where):
            model.planes.append(float((link @ pose)[2, 3]))
        return [replace(shape, pose=pose @ shape.pose) for shape in self._shapes(part, where, path)]

    def _shapes(self, part: ElementTree.Element, where: str, path: Path) -> list[Shape]:
        self._count_one(path)
        try:
            shapes, missing = shapes_of(part, where, path.parent, self._resources)
        except MissingFileError as error:
            self.missing.setdefault(str(error), where)
            self._misses += 1
            return []
        self.left_out += missing
        return shapes

    def _count_one(self, path: Path) -> None:
        self._count += 1
        if self._count > MOST_SHAPES:
            raise WorldImportError(f"{path}: a world must have at most {MOST_SHAPES} models and shapes")

    def _included(self, element: ElementTree.Element, path: Path, depth: int) -> ModelShapes:
        uri = text_of(element, "uri")
        if uri is None:
            raise WorldImportError(f"{path}: <include> must have a <uri>, got none")
        kind = uri.rstrip("/").rpartition("/")[2]
        if kind.lower() in BUILT_IN:
            return self._brought(kind.lower(), element)
        try:
            inner = self._inner(self._resources.model_file(uri, path.parent), depth)
        except WorldImportError as error:  # the rest of the world may do without it
            self.missing.setdefault(str(error), f"{path}: <include>")
            return ModelShapes(kind, kind)
        if element.find("pose") is not None:  # it takes the place of the model's, by the specification
            inner.pose = None
        inner.name, inner.kind = text_of(element, "name") or inner.name, kind
        return inner

    def _inner(self, file: Path, depth: int) -> ModelShapes:
        """The model of a file of its own."""
        if file not in self._files:
            self._files[file] = read_xml(file)
        root = self._files[file]
        model = root.find("model")
        if model is None and root.find("light") is not None:  # as those that bring the sun
            self.built_in |= {"sun" for light in root.iterfind("light") if light.get("type") == "directional"}
            return ModelShapes("light", pose=np.eye(4))
        if model is None:
            raise WorldImportError(f"{file} must hold a <model>, got none")
        found = self.read(model, file, depth + 1)
        found.pose = Frames(root, str(file)).pose(model, f"{file}: model {found.name!r:.60}")
        return found

    def _brought(self, kind: str, element: ElementTree.Element) -> ModelShapes:
        self.built_in.add(BUILT_IN[kind])
        pose = np.eye(4) if element.find("pose") is None else None
        return ModelShapes(kind, kind, pose, planes=[0.0] if BUILT_IN[kind] == "plane" else [])
