"""Texts and numbers in SDF's elements. Pure."""

import math
import xml.etree.ElementTree as ElementTree

from simulator.importing.entities import Rgb, Rgba, WorldImportError


def text_of(element: ElementTree.Element, path: str) -> str | None:
    """Text of an element below, without spaces round it; None if there is none."""
    found = element.find(path)
    return None if found is None or found.text is None else found.text.strip() or None


def is_set(element: ElementTree.Element, path: str) -> bool:
    """Whether an element below says so."""
    return (text_of(element, path) or "").lower() in {"true", "1"}


def numbers(text: str, count: int, expected: str) -> list[float]:
    """So many finite numbers; WorldImportError says what was expected and what came."""
    try:
        values = [float(word) for word in text.split()]
    except ValueError:
        values = []
    if len(values) != count or not all(math.isfinite(v) for v in values):
        raise WorldImportError(f"{expected}, {count} finite numbers; got {text.strip()!r:.80}")
    return values


def number_of(element: ElementTree.Element, path: str, default: float, where: str) -> float:
    """A number below an element, or the default."""
    text = text_of(element, path)
    return default if text is None else numbers(text, 1, f"{where}: {path} must be a number")[0]


def colour_of(element: ElementTree.Element, path: str, where: str) -> Rgba | None:
    """A colour below an element, 0 to 1, opaque where it does not say; None if there is none."""
    text = text_of(element, path)
    if text is None:
        return None
    words = [*text.replace(",", " ").split(), "1"][:4]
    values = numbers(" ".join(words), 4, f"{where}: {path} must be r g b a")
    r, g, b, a = (min(1.0, max(0.0, value)) for value in values)
    return r, g, b, a


def rgb_of(element: ElementTree.Element, path: str, where: str) -> Rgb | None:
    """The same without opacity."""
    found = colour_of(element, path, where)
    return None if found is None else found[:3]
