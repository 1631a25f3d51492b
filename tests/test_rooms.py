"""The shape of the house: rooms that one can take in at a glance, functions that fit a screen."""

import ast
from collections import Counter
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
PACKAGES = ("services", "shared", "simulator", "experiments")
MODULES_MAX = 15
FUNCTION_MAX = 60
LINES_MIN = 25
PLUGINS = {
    "experiments/commands",
    "services/features/extractors",
    "services/features/matchers",
    "services/features/representations",
    "services/planner/missions",
    "shared/messages",
    "simulator/disturbances",
    "simulator/furniture",
    "simulator/textures",
}
"""Folders in which a module is one of a kind that a registry finds: there are as many as there are."""

COMMANDS = "services/launcher/commands/"
"""In its rooms a module is one command of people, which may be short, but no room is crowded."""

ENTRIES = {"__init__.py", "__main__.py"}


def modules() -> list[Path]:
    """All modules of the product and the studies, relative to the repository."""
    found = (path for package in PACKAGES for path in (REPOSITORY / package).rglob("*.py"))
    return sorted(path.relative_to(REPOSITORY) for path in found)


def functions(source: str) -> list[tuple[str, int]]:
    """Names and lengths of all functions, decorators not counted."""
    found = (n for n in ast.walk(ast.parse(source)) if isinstance(n, ast.FunctionDef | ast.AsyncFunctionDef))
    return [(node.name, (node.end_lineno or node.lineno) - node.lineno + 1) for node in found]


def crowded(paths: list[Path]) -> dict[str, int]:
    """Folders with more modules than one takes in at a glance, and how many they have."""
    rooms = Counter(path.parent.as_posix() for path in paths if path.name not in ENTRIES)
    return {room: count for room, count in rooms.items() if count > MODULES_MAX and room not in PLUGINS}


def test_no_folder_outgrows_its_name():
    assert crowded(modules()) == {}


@pytest.mark.parametrize("package", [*PACKAGES, "tests", "deploy"])
def test_every_function_fits_a_screen(package):
    long = [
        f"{path.relative_to(REPOSITORY)} {name}: {lines} lines"
        for path in sorted((REPOSITORY / package).rglob("*.py"))
        for name, lines in functions(path.read_text(encoding="utf-8"))
        if lines > FUNCTION_MAX
    ]
    assert long == []


def test_a_module_is_more_than_a_stub_unless_it_is_a_plugin():
    small = [
        path.as_posix()
        for path in modules()
        if path.name not in ENTRIES
        and path.parent.as_posix() not in PLUGINS
        and not path.as_posix().startswith(COMMANDS)
        and (REPOSITORY / path).read_text(encoding="utf-8").count("\n") < LINES_MIN
    ]
    assert small == []


def test_plugin_folders_are_there():
    assert {room for room in PLUGINS if not (REPOSITORY / room).is_dir()} == set()


def test_a_crowded_room_and_a_long_function_are_seen():
    assert crowded([Path(f"services/x/m{n}.py") for n in range(MODULES_MAX + 1)]) == {"services/x": 16}
    assert crowded([Path(f"simulator/furniture/m{n}.py") for n in range(40)]) == {}
    assert functions("async def f():\n    x = 1\n    return x\n") == [("f", 3)]
