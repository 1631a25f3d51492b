"""<material> of SDF and the material scripts of Gazebo Classic -> paint."""

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from simulator.importing.entities import Drawn, Paint, Rgba, WorldImportError
from simulator.importing.sdf.numbers import colour_of, is_set, number_of, numbers, text_of
from simulator.importing.sdf.resources import Resources, read_text

GREY: Rgba = (0.7, 0.7, 0.7, 1.0)  # Gazebo's own of what has no material
COLOURS: dict[str, tuple[float, float, float]] = {
    "Black": (0.0, 0.0, 0.0), "FlatBlack": (0.1, 0.1, 0.1), "DarkGrey": (0.175, 0.175, 0.175),
    "Grey": (0.7, 0.7, 0.7), "Gray": (0.7, 0.7, 0.7), "White": (1.0, 1.0, 1.0), "Red": (1.0, 0.0, 0.0),
    "Green": (0.0, 1.0, 0.0), "Blue": (0.0, 0.0, 1.0), "SkyBlue": (0.13, 0.44, 0.7),
    "Yellow": (1.0, 1.0, 0.0), "DarkYellow": (0.7, 0.7, 0.0), "Orange": (1.0, 0.5, 0.04),
    "Purple": (1.0, 0.0, 1.0), "Turquoise": (0.0, 1.0, 1.0), "Indigo": (0.33, 0.0, 0.5),
    "Gold": (0.8, 0.65, 0.2),
}  # fmt: skip
"""Colours that go by a name in Gazebo Classic, close to its own."""
TEXTURES = {
    "Wood": Drawn("wood", (166, 124, 82)), "WoodFloor": Drawn("boards", (150, 104, 66)),
    "WoodPallet": Drawn("planks", (176, 140, 96)), "Bricks": Drawn("bricks", (150, 86, 66)),
    "PaintedWall": Drawn("plaster", (222, 214, 198)), "CeilingTiled": Drawn("ceiling_panel", (236, 236, 232)),
    "Grass": Drawn("grass", (104, 126, 70)), "Road": Drawn("asphalt", (86, 86, 88)),
    "Asphalt": Drawn("asphalt", (86, 86, 88)), "Trunk": Drawn("bark", (110, 84, 60)),
    "Concrete": Drawn("concrete", (176, 174, 168)),
}  # fmt: skip
"""Textures that Gazebo Classic has in its own folder, which a world does not bring: ours in their place."""


def paint_of(
    part: ElementTree.Element, where: str, folder: Path, resources: Resources
) -> tuple[Paint, list[str]]:
    """The paint of a <visual>, and what of it cannot be shown.

    Raises:
        WorldImportError: values that are no colours.
    """
    material = part.find("material")
    opacity = 1.0 - min(1.0, max(0.0, number_of(part, "transparency", 0.0, where)))
    if material is None:
        return Paint(opacity=opacity), []
    two_sided = is_set(material, "double_sided")
    colour = colour_of(material, "diffuse", where)
    albedo = text_of(material, "pbr/metal/albedo_map") or text_of(material, "pbr/specular/albedo_map")
    if albedo is not None:
        try:
            return Paint(colour, resources.find(albedo, folder), opacity, two_sided), []
        except WorldImportError as error:
            return Paint(colour, None, opacity, two_sided), [f"{where}: picture {error}"]
    script = text_of(material, "script/name")
    if script is None:
        return Paint(colour, None, opacity, two_sided), []
    found, missing = _scripted(material, script, folder, resources)
    return Paint(found.colour or colour, found.picture, opacity, two_sided), [
        f"{where}: {m}" for m in missing
    ]


def _scripted(
    material: ElementTree.Element, name: str, folder: Path, resources: Resources
) -> tuple[Paint, list[str]]:
    """What the material script of a name says: by its files, or of those that Gazebo brings."""
    short = name.removeprefix("Gazebo/")
    if name.startswith("Gazebo/") and short in TEXTURES:
        return Paint(picture=TEXTURES[short]), []
    if name.startswith("Gazebo/") and short in COLOURS:
        return Paint((*COLOURS[short], 1.0)), []
    places = [one.text.strip() for one in material.iterfind("script/uri") if one.text and one.text.strip()]
    for uri in places:
        try:
            place = resources.find(uri, folder)
        except WorldImportError:
            continue
        files = [place] if place.is_file() else sorted(place.glob("*.material"))
        for file in files:
            found, fault = _in_script(file, name, places, resources)
            if found is not None:
                return found, [fault] if fault else []
    return Paint(), [f"material {name!r:.80} is in no script that is here: shown grey"]


def _in_script(file: Path, name: str, places: list[str], resources: Resources) -> tuple[Paint | None, str]:
    """The first picture and the diffuse colour of a material of an OGRE script."""
    text = re.sub(r"//[^\n]*", "", read_text(file))
    block = re.search(rf"^\s*material\s+\"?{re.escape(name)}\"?\s*(?::[^\n{{]*)?\{{", text, re.MULTILINE)
    if block is None:
        return None, ""
    body = _braced(text, block.end())
    diffuse = re.search(r"^\s*diffuse\s+((?:[-+.\deE]+[ \t]+){2,3}[-+.\deE]+)", body, re.MULTILINE)
    colour = None
    if diffuse is not None:
        r, g, b = numbers(" ".join(diffuse[1].split()[:3]), 3, f"{file}: diffuse must be r g b")
        colour = (r, g, b, 1.0)
    picture = re.search(r"^\s*texture\s+\"?([^\s\"]+)", body, re.MULTILINE)
    if picture is None:
        return Paint(colour), ""
    for folder in (file.parent, file.parent.parent / "textures", *_folders(places, file.parent, resources)):
        if (folder / picture[1]).is_file():
            return Paint(picture=folder / picture[1]), ""
    return Paint(colour), f"picture {picture[1]!r:.80} of material {name!r:.80} is not there"


def _folders(places: list[str], beside: Path, resources: Resources) -> list[Path]:
    found = []
    for uri in places:
        try:
            found.append(resources.find(uri, beside))
        except WorldImportError:
            continue
    return [place for place in found if place.is_dir()]


def _braced(text: str, start: int) -> str:
    """From after an opening brace to the one that closes it."""
    depth = 1
    for k in range(start, len(text)):
        depth += {"{": 1, "}": -1}.get(text[k], 0)
        if depth == 0:
            return text[start:k]
    return text[start:]
