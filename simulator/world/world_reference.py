"""Tables of everything a world file can name, made from the code. Pure."""

import inspect
from collections.abc import Callable
from typing import Any

from simulator.furniture.catalogue import FURNITURE, Kind
from simulator.textures.catalogue import KINDS

BEGIN, END = "<!-- begin: topnav world kinds -->", "<!-- end: topnav world kinds -->"


def reference() -> str:
    """Markdown tables of furniture and textures."""
    furniture = [
        f"| `{name}` | {_summary(kind.function)} | {_options(kind)} |" for name, kind in _by_name(FURNITURE)
    ]
    textures = [f"| `{name}` | {_summary(draw)} |" for name, draw in _by_name(KINDS)]
    return "\n".join(
        ["| kind | what it is | options and their defaults |", "|---|---|---|", *furniture, "",
         "| texture | what it shows |", "|---|---|", *textures]
    )  # fmt: skip


def renewed(page: str) -> str:
    """A page with the tables between its two marks replaced.

    Raises:
        ValueError: a mark is missing.
    """
    before, begin, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"the page must have the lines {BEGIN} and {END}; add them")
    return f"{before}{BEGIN}\n{reference()}\n{END}{after}"


def _by_name(table: dict[str, Any]) -> list[tuple[str, Any]]:
    return sorted(table.items())


def _summary(function: Callable[..., Any]) -> str:
    lines = (inspect.getdoc(function) or "").partition("\n\n")[0].split()
    return " ".join(lines).rstrip(".").replace("|", "/")


def _options(kind: Kind) -> str:
    parameters = inspect.signature(kind.function).parameters
    return ", ".join(f"`{name}` {_value(parameters[name].default)}" for name in kind.options()) or "none"


def _value(default: object) -> str:
    if default is inspect.Parameter.empty:
        return "(needed)"
    if isinstance(default, tuple):
        return "[" + ", ".join(str(value) for value in default) + "]"
    if isinstance(default, bool):
        return str(default).lower()
    return "none" if default is None else str(default)
