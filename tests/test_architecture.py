"""Import rules: who may know whom. Read from the syntax trees, nothing is imported."""

import ast
import re
from itertools import pairwise
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
PACKAGES = ("services", "shared", "simulator", "experiments")
SERVICES = (
    "camera",
    "features",
    "map_store",
    "planner",
    "drive",
    "dispatch",
    "signs",
    "fleet",
    "gateway",
    "recorder",
    "launcher",
    "ros",
    "mcp",
)

# Pure code: the same input gives the same output, whatever the clock, the bus and the environment say.
PURE = (
    "shared/geometry/**/*.py",
    "shared/mapgraph/**/*.py",
    "shared/messages/**/*.py",
    "services/planner/**/*.py",
    "services/drive/**/*.py",
    "services/**/core.py",
    "services/**/core/**/*.py",
    "services/**/graph.py",
    "services/**/comparison.py",
    "services/fleet/beginnings.py",
    "services/fleet/condition.py",
    "shared/robots/seen.py",
    "services/camera/calibration/calibrating.py",
    "services/camera/calibration/fitting.py",
    "services/camera/checking/coverage.py",
    "services/camera/checking/flashing.py",
    "services/camera/checking/level.py",
    "services/camera/checking/marking.py",
    "services/camera/checking/report.py",
    "services/camera/checking/robot_frames.py",
    "services/camera/mount/*.py",
    "services/features/matching/*.py",
    "services/features/pipeline/*.py",
    "services/features/retrieval/*.py",
    "services/launcher/compose/**/*.py",
    "services/launcher/checking/distances.py",
    "services/launcher/checking/motion.py",
    "services/launcher/checking/report.py",
    "services/launcher/processes/restart.py",
    "services/ros/conversions/*.py",
    "services/ros/base_link.py",
    "services/ros/driving.py",
    "services/ros/repeating.py",
    "services/ros/wires/bridge.py",
    "services/ros/wires/codec.py",
    "services/ros/wires/rmw_zenoh.py",
)
EDGE_FILES = {
    "__main__.py",
    "service.py",
    "settings.py",
    "assignment.py",
    "mission_control.py",
    "records.py",
}  # where a service meets the world
EDGE_FOLDERS = {"remote"}
IMPURE = {
    "zenoh",
    "fastapi",
    "time",
    "datetime",
    "os",
    "random",
    "socket",
    "subprocess",
    "threading",
    "requests",
}
IMPURE_OURS = {
    "shared.bus",
    "shared.transport.session_config",
    "shared.lifecycle",
    "shared.transport.reconnection",
    "shared.queries",
    "shared.settings",
}
FORBIDDEN = {
    "planner": {"torch", "kornia", "cv2", "sapien", "fastapi", "sqlalchemy"},
    "drive": {"torch", "kornia", "cv2", "sapien", "fastapi", "sqlalchemy"},
    "dispatch": {"torch", "kornia", "cv2", "sapien", "fastapi", "sqlalchemy"},
    "fleet": {"torch", "kornia", "cv2", "sapien", "fastapi", "sqlalchemy"},
    "camera": {"torch", "kornia", "sapien", "fastapi", "sqlalchemy"},
    "signs": {"torch", "kornia", "sapien", "fastapi", "sqlalchemy"},
    "gateway": {"torch", "kornia", "sapien", "sqlalchemy"},
    "map_store": {"torch", "kornia", "cv2", "sapien"},
    "features": {"sapien", "fastapi", "sqlalchemy"},
    "recorder": {"torch", "kornia", "cv2", "sapien", "fastapi", "sqlalchemy"},
    "launcher": {"torch", "kornia", "cv2", "sapien", "fastapi", "sqlalchemy"},
    "ros": {"torch", "kornia", "cv2", "sapien", "fastapi", "sqlalchemy"},
    "mcp": {"torch", "kornia", "cv2", "sapien", "fastapi", "sqlalchemy", "zenoh"},
}
ROOMS = ("compose", "processes", "terminal", "client", "drawing", "evaluation", "checking", "commands")
"""Of the launcher, from the ground up: a room imports itself and those before it."""

SHELL = ("terminal", "client", "drawing", "evaluation", "checking", "commands", "cli.py", "__main__.py")
"""What people use of the launcher: the shell of all processes and no process itself."""

JOINS = {
    "checking/check.py": {"camera"},
    "client/environments.py": {"simulator"},
    "commands/assets/models.py": {"features"},
    "commands/assets/world.py": {"simulator"},
    "commands/maps/map.py": {"map_store"},
    "commands/missions/explore.py": {"simulator"},
    "commands/recordings/foxglove.py": {"recorder"},
    "commands/recordings/record.py": {"recorder"},
    "commands/recordings/recover.py": {"recorder"},
    "commands/recordings/replay.py": {"recorder"},
    "commands/robots/camera.py": {"camera"},
    "commands/stack/demo.py": {"simulator"},
    "commands/stack/mcp.py": {"mcp"},
    "drawing/plans.py": {"simulator"},
    "drawing/true_pose.py": {"recorder"},
    "drawing/world.py": {"simulator"},
    "evaluation/demo.py": {"simulator"},
    "evaluation/exploration.py": {"simulator"},
    "evaluation/outcome.py": {"simulator"},
    "evaluation/rounds.py": {"simulator"},
}
"""All that the launcher imports of other processes, by file."""

OUR_MODULE = re.compile(r"(services|shared|simulator|experiments)\.[\w.:]*")
PLUGIN_TABLES = {"services/features/pipeline/plugins.py"}
TRUTH_NAMES = {"Truth", "TRUTH"}


def imported(source: str) -> set[str]:
    """Full names of everything a source imports, wherever in the file; `from a import b` gives a and a.b."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "relative imports hide who imports whom"
            module = node.module or ""
            names |= {module} | {f"{module}.{alias.name}" for alias in node.names}
    return names


def tops(names: set[str]) -> set[str]:
    """Top-level packages of imported names."""
    return {name.partition(".")[0] for name in names}


def services_in(names: set[str]) -> set[str]:
    """Which services the imported names belong to."""
    parts = [name.split(".") for name in names]
    return {part[1] for part in parts if part[0] == "services" and len(part) > 1}


def names_used(source: str) -> set[str]:
    """Every identifier and attribute of a source."""
    tree = ast.walk(ast.parse(source))
    plain = (node.id if isinstance(node, ast.Name) else getattr(node, "attr", None) for node in tree)
    return {name for name in plain if name} | {name.rpartition(".")[2] for name in imported(source)}


def files(folder: str) -> list[Path]:
    """All Python files of a folder of the repository."""
    return sorted((REPOSITORY / folder).rglob("*.py"))


def by_path(paths: list[Path]) -> list[object]:
    """Make one test per file, named by its path."""
    return [pytest.param(path, id=str(path.relative_to(REPOSITORY))) for path in paths]


def pure_files() -> list[Path]:
    """All files that must be pure."""
    found = {path for pattern in PURE for path in REPOSITORY.glob(pattern)}
    return sorted(p for p in found if p.name not in EDGE_FILES and p.parent.name not in EDGE_FOLDERS)


def shell_files() -> list[Path]:
    """The parts of the launcher that are no process but the shell of all of them."""
    launcher = REPOSITORY / "services/launcher"
    return [path for path in files("services/launcher") if path.relative_to(launcher).parts[0] in SHELL]


def modules_in_strings(source: str) -> list[str]:
    """Every string that names a module of ours, but for those that follow "-m": they start a process."""
    tree = ast.parse(source)
    rows = [node.elts for node in ast.walk(tree) if isinstance(node, ast.List | ast.Tuple)]
    started = {
        id(word)
        for row in rows
        for flag, word in pairwise(row)
        if isinstance(flag, ast.Constant) and flag.value == "-m"
    }
    found = [node for node in ast.walk(tree) if isinstance(node, ast.Constant) and id(node) not in started]
    texts = [node.value for node in found if isinstance(node.value, str)]
    return [text for text in texts if OUR_MODULE.fullmatch(text)]


def module_file(name: str) -> Path | None:
    """File of one of our own modules, None for other names."""
    if name.partition(".")[0] not in PACKAGES:
        return None
    base = REPOSITORY / name.replace(".", "/")
    return next((p for p in (base.with_suffix(".py"), base / "__init__.py") if p.exists()), None)


def reachable(start: list[Path]) -> set[Path]:
    """Follow our own imports from these files."""
    seen: set[Path] = set()
    queue = list(start)
    while queue:
        path = queue.pop()
        if path in seen:
            continue
        seen.add(path)
        queue += filter(None, map(module_file, imported(path.read_text(encoding="utf-8"))))
    return seen


@pytest.mark.parametrize("service", SERVICES)
def test_a_service_imports_no_other_service_no_simulator_and_no_experiment(service):
    for path in set(files(f"services/{service}")) - set(shell_files()):
        names = imported(path.read_text(encoding="utf-8"))
        assert services_in(names) <= {service}, path
        assert not tops(names) & {"simulator", "experiments"}, path


def test_the_rooms_of_the_launcher_know_only_those_below_and_join_what_the_table_says():
    launcher, joins = REPOSITORY / "services/launcher", {}
    for path in files("services/launcher"):
        names, own = imported(path.read_text(encoding="utf-8")), path.relative_to(launcher)
        others = (services_in(names) - {"launcher"}) | (tops(names) & {"simulator", "experiments"})
        if others:
            joins[own.as_posix()] = others
        rooms = {name.split(".")[2] for name in names if name.startswith("services.launcher.")}
        if own.parts[0] in ROOMS:
            below = ROOMS[: ROOMS.index(own.parts[0]) + 1]
            assert rooms <= set(below), f"{own} imports {rooms - set(below)}"
    assert joins == JOINS


@pytest.mark.parametrize("folder", PACKAGES)
def test_nobody_reaches_a_module_by_a_string(folder):
    for path in files(folder):
        if path.relative_to(REPOSITORY).as_posix() not in PLUGIN_TABLES:
            named = modules_in_strings(path.read_text(encoding="utf-8"))
            assert not named, f"{path} names {named}: import it"


@pytest.mark.parametrize("path", by_path(files("shared")))
def test_shared_code_knows_no_service(path):
    assert not tops(imported(path.read_text(encoding="utf-8"))) & {"services", "simulator", "experiments"}


@pytest.mark.parametrize("path", by_path(files("simulator")))
def test_the_simulator_knows_no_service(path):
    assert not tops(imported(path.read_text(encoding="utf-8"))) & {"services", "experiments"}


@pytest.mark.parametrize("path", by_path(pure_files()))
def test_pure_code_reads_no_bus_no_clock_and_no_environment(path):
    names = imported(path.read_text(encoding="utf-8"))
    assert not tops(names) & IMPURE
    assert not names & IMPURE_OURS


@pytest.mark.parametrize("service", SERVICES)
def test_a_service_never_reaches_a_library_that_is_not_its_own(service):
    for path in reachable(sorted(set(files(f"services/{service}")) - set(shell_files()))):
        found = tops(imported(path.read_text(encoding="utf-8"))) & FORBIDDEN[service]
        assert not found, f"{path} imports {found}"


@pytest.mark.parametrize(
    "service", [name for name in SERVICES if name != "gateway"], ids=lambda name: f"{name} is blind"
)
def test_only_the_gateways_debug_view_may_read_the_true_pose(service):
    for path in set(files(f"services/{service}")) - set(shell_files()):
        source = path.read_text(encoding="utf-8")
        assert not names_used(source) & TRUTH_NAMES, path
        assert "/truth" not in source, path


def test_no_code_uses_pickle():
    for folder in PACKAGES:
        for path in files(folder):
            assert not tops(imported(path.read_text(encoding="utf-8"))) & {"pickle", "dill", "joblib"}, path


def test_pure_code_was_found_at_all():
    assert len(pure_files()) > 20
    assert files("services/launcher")


@pytest.mark.parametrize(
    ("source", "names"),
    [
        ("import time as t", {"time"}),
        ("def f():\n    from services.drive import core", {"services.drive", "services.drive.core"}),
        ("from services import drive", {"services", "services.drive"}),
        ("if x:\n    import a.b.c", {"a.b.c"}),
    ],
)
def test_the_reader_sees_imports_in_every_form(source, names):
    assert imported(source) == names


@pytest.mark.parametrize(
    ("source", "names"),
    [
        ("load('services.drive.core')", ["services.drive.core"]),
        ("TABLE = {'x': 'experiments.bench:app'}", ["experiments.bench:app"]),
        ("load(f'services.{name}.core')", ["services."]),
        ("run([python, '-m', 'services.drive'])", []),
        ("'The tests of services.drive are elsewhere.'", []),
    ],
)
def test_the_reader_sees_modules_in_strings(source, names):
    assert modules_in_strings(source) == names


def test_the_reader_sees_the_truth_behind_an_attribute():
    assert names_used("import shared.topics as t\nt.TRUTH") & TRUTH_NAMES
    assert names_used("from shared.messages import Truth as T") & TRUTH_NAMES
    assert services_in(imported("from services import drive")) == {"drive"}
