"""Each service imports with nothing but its own extra of pyproject.toml.

The modules of all other distributions are hidden by an import hook in a process of its own. The images of
deploy/docker do it for real: each installs one extra only.
"""

import importlib.metadata
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

REPOSITORY = Path(__file__).resolve().parents[3]
PROJECT = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["project"]
SERVICES = {
    "simulator": "simulator",
    "camera": "services.camera",
    "features": "services.features",
    "map-store": "services.map_store",
    "planner": "services.planner",
    "drive": "services.drive",
    "dispatch": "services.dispatch",
    "fleet": "services.fleet",
    "gateway": "services.gateway",
    "ros": "services.ros",
    "recorder": "services.recorder",
    "foxglove": "services.recorder.foxglove",
    "signs": "services.signs",
    "launcher": "services.launcher",
    "mcp": "services.mcp",
}
HOOK = """
import importlib.abc, sys

class Hidden(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in hidden:
            raise ModuleNotFoundError(f"{name} is not in this extra", name=name)

hidden = set(sys.argv[1].split(","))
sys.meta_path.insert(0, Hidden())
__import__(sys.argv[2])
loaded = {name.partition(".")[0] for name in sys.modules}
print(",".join(sorted(loaded & {"torch", "cv2", "sapien"})))
"""


def closure(requirements):
    """Names of all installed distributions that these requirements bring."""
    names, queue = set(), [(Requirement(text), "") for text in requirements]
    while queue:
        requirement, extra = queue.pop()
        if requirement.marker and not requirement.marker.evaluate({"extra": extra}):
            continue
        key = (canonicalize_name(requirement.name), frozenset(requirement.extras))
        if key in names:
            continue
        try:
            needs = importlib.metadata.requires(requirement.name) or []
        except importlib.metadata.PackageNotFoundError:
            continue
        names.add(key)
        queue += [(Requirement(text), one) for text in needs for one in ("", *requirement.extras)]
    return {name for name, _ in names}


def import_with_only(extra, module):
    """Import `module` where only the core and one extra are visible."""
    allowed = closure([*PROJECT["dependencies"], *PROJECT["optional-dependencies"][extra]])
    hidden = {
        top
        for top, owners in importlib.metadata.packages_distributions().items()
        if not {canonicalize_name(owner) for owner in owners} & allowed
    } - {"services", "shared", "simulator", "experiments", *sys.stdlib_module_names}
    return subprocess.run(
        [sys.executable, "-c", HOOK, ",".join(hidden), module],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def entry_point(package):
    return f"{package}.__main__"


@pytest.mark.parametrize(("extra", "package"), SERVICES.items())
def test_a_service_imports_with_only_its_own_extra(extra, package):
    run = import_with_only(extra, entry_point(package))
    assert run.returncode == 0, run.stderr
    heavy = set(filter(None, run.stdout.strip().split(",")))
    known = {
        "simulator": {"sapien", "cv2"},
        "features": {"torch", "cv2"},
        "camera": {"cv2"},
        "signs": {"cv2"},
    }
    allowed = known.get(extra, set())
    assert heavy <= allowed


def test_the_hook_really_hides_what_is_not_in_the_extra():
    run = import_with_only("drive", "networkx")
    assert run.returncode == 1
    assert "networkx is not in this extra" in run.stderr


def test_the_planners_and_gateways_extras_bring_neither_torch_nor_opencv_nor_sapien():
    heavy = {"torch", "opencv-python", "opencv-contrib-python-headless", "sapien", "kornia"}
    for extra in ("planner", "gateway", "drive", "map-store"):
        assert not heavy & closure(PROJECT["optional-dependencies"][extra])
