"""What a run needs from this machine: each check says what is wrong and how to mend it."""

import importlib.metadata
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from services.launcher.processes.stack_settings import Ports
from services.launcher.processes.state import StateFolder

DISK_NEEDED_GB = 2.0
"""Room for eight logs of twice 10 MB, a map of 10,000 nodes (230 MB) and a recording."""

PYTHON_NEEDED = (3, 11)
"""As pyproject.toml requires."""

IMPORT_TIMEOUT_S, RENDER_TIMEOUT_S = 30.0, 90.0
"""Importing cv2 takes a second; a software driver compiles its shaders on the first picture."""

RENDER_SCRIPT = """
import sapien
scene = sapien.Scene()
camera = scene.add_camera("doctor", 32, 32, 1.5, 0.01, 10.0)
scene.update_render()
camera.take_picture()
print(camera.get_picture("Color").shape)
"""
CV2_SCRIPT = "import cv2; cv2.xfeatures2d.BEBLID_create(1.0); print(cv2.__version__)"


@dataclass(frozen=True)
class Check:
    """Outcome of one check; `fix` is empty when it is fine."""

    name: str
    ok: bool
    detail: str
    fix: str = ""


def examine(data_dir: Path, ports: Ports) -> list[Check]:
    """Run all checks, the slow one last."""
    checks: list[Callable[[], Check]] = [
        check_python,
        check_opencv,
        lambda: check_disk(data_dir),
        lambda: check_ports(ports, StateFolder(data_dir).owned()),
        check_weights,
        check_rendering,
    ]
    return [check() for check in checks]


def check_python() -> Check:
    """Require the Python version of pyproject.toml."""
    ok = sys.version_info >= PYTHON_NEEDED
    return Check("python", ok, sys.version.split()[0], "" if ok else "make setup PYTHON=/path/to/python3.11")


def check_opencv() -> Check:
    """Require one owner of `cv2`, with the contrib modules."""
    owners = sorted(
        {
            d.name
            for d in importlib.metadata.distributions()
            if d.name.startswith("opencv") and any(str(f).startswith("cv2/") for f in d.files or ())
        }
    )
    run = _python(CV2_SCRIPT, IMPORT_TIMEOUT_S)
    ok = owners == ["opencv-contrib-python-headless"] and run.returncode == 0
    detail = f"cv2 {run.stdout.strip()} from {', '.join(owners) or 'nowhere'}"
    if run.returncode != 0:
        detail += f": {_last_line(run.stderr)}"
    return Check(
        "opencv", ok, detail, "" if ok else "make clean setup (two OpenCV wheels overwrite each other)"
    )


def check_disk(data_dir: Path) -> Check:
    """Require room for maps and logs."""
    folder = next(p for p in (data_dir, *data_dir.parents) if p.exists())
    free_gb = shutil.disk_usage(folder).free / 1e9
    ok = free_gb >= DISK_NEEDED_GB and os.access(folder, os.W_OK)
    fix = "" if ok else f"free {DISK_NEEDED_GB:.0f} GB there, or name a folder you may write with --data-dir"
    return Check("disk", ok, f"{free_gb:.1f} GB free in {folder}", fix)


def check_ports(ports: Ports, stack_runs: bool) -> Check:
    """Require that nobody else listens on our ports."""
    if stack_runs:
        return Check("ports", True, "in use by the running stack")
    taken = ports.taken()
    fix = ", ".join(f"set TOPNAV_{name}_PORT to another port than {port}" for name, port in taken.items())
    return Check("ports", not taken, f"{ports.router} {ports.gateway} {ports.map_store}", fix)


def check_weights() -> Check:
    """Report which trained weights are there; the default pipeline needs none, so this never fails."""
    home = Path(os.environ.get("TORCH_HOME") or "~/.cache/torch").expanduser()
    files = sorted(p.name for p in (home / "hub" / "checkpoints").glob("*"))
    detail = ", ".join(files) if files else "none yet; the default pipeline needs none"
    return Check("weights", True, f"{home}: {detail}")


def check_rendering() -> Check:
    """Require a Vulkan device on which SAPIEN renders (it needs VK_KHR_external_semaphore_fd)."""
    run = _python(RENDER_SCRIPT, RENDER_TIMEOUT_S)
    if run.returncode == 0:
        return Check("rendering", True, "SAPIEN rendered a picture")
    fix = "bash deploy/setup/vulkan.sh installs or names the driver (Mesa 24.3 or newer, or NVIDIA)"
    return Check("rendering", False, _last_line(run.stderr) or f"exit {run.returncode}", fix)


def _python(script: str, timeout_s: float) -> subprocess.CompletedProcess[str]:
    """Run a script in a process of its own: a broken driver may crash or hang it."""
    command = [sys.executable, "-c", script]
    try:
        return subprocess.run(command, capture_output=True, text=True, timeout=timeout_s, check=False)
    except subprocess.TimeoutExpired:
        return subprocess.CompletedProcess(command, 124, "", f"no answer after {timeout_s:.0f} s")


def _last_line(text: str) -> str:
    lines = text.strip().splitlines()
    return lines[-1][:200] if lines else ""
