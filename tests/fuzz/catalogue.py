"""All decoders by family; a family is a module, imported when it is asked for."""

import importlib
from dataclasses import replace
from pathlib import Path

from tests.fuzz.decoder import Decoder

FAMILIES = ("bus", "pictures", "archives", "recordings", "worlds", "importing", "files", "requests")
FOUND = Path(__file__).parent / "found"
"""Inputs that crashed a decoder once, by its name; they are the first of its seeds for ever."""


def family(name: str, scratch: Path) -> list[Decoder]:
    """The decoders of one family, which may write below `scratch`."""
    if name not in FAMILIES:
        raise ValueError(f"family must be one of {', '.join(FAMILIES)}, got {name!r}")
    module = importlib.import_module(f"tests.fuzz.decoders.{name}")
    folder = scratch / name
    folder.mkdir(parents=True, exist_ok=True)
    found: list[Decoder] = module.decoders(folder)
    return [replace(decoder, seeds=(*saved_inputs(decoder.name), *decoder.seeds)) for decoder in found]


def chosen(names: list[str], scratch: Path) -> list[Decoder]:
    """Decoders by full name or by family; all of them for an empty list.

    Raises:
        ValueError: no decoder has that name.
    """
    wanted = names or list(FAMILIES)
    families = {name.partition("/")[0]: None for name in wanted}
    known = [decoder for name in families for decoder in family(name, scratch)]
    unknown = {name for name in wanted if "/" in name} - {decoder.name for decoder in known}
    if unknown:
        raise ValueError(
            f"no decoder {sorted(unknown)[0]!r}; there are {', '.join(decoder.name for decoder in known)}"
        )
    return [one for one in known if one.name in wanted or one.name.partition("/")[0] in wanted]


def saved_inputs(decoder: str) -> tuple[bytes, ...]:
    """What crashed a decoder before."""
    return tuple(path.read_bytes() for path in sorted((FOUND / decoder).glob("*.bin")))
