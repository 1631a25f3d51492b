"""A test process that dies fails its test; the run still ends."""

import subprocess
import sys
from pathlib import Path

FILES = 16
DYING = FILES - 2
"""Near the end, when the one that dies has finished more files than there are tests left."""

CONFTEST = """
def pytest_xdist_make_scheduler(config, log):
    from tests.scheduling import ByStackAndFile
    config.option.loadscopereorder = False
    return ByStackAndFile(config, log)
"""
TEST = """
import os, pathlib, signal, time

def test_one():
    time.sleep(0.02)
    died = pathlib.Path(__file__).with_name("died")
    if {dies} and not died.exists():
        died.touch()
        os.kill(os.getpid(), signal.SIGKILL)

def test_two():
    pass
"""


def test_a_run_ends_though_a_worker_died(tmp_path: Path, repository: Path) -> None:
    (tmp_path / "conftest.py").write_text(CONFTEST)
    for number in range(FILES):
        (tmp_path / f"test_{number:02}.py").write_text(TEST.format(dies=number == DYING))
    ended = subprocess.run(
        [
            sys.executable,
            "-m",
            "pytest",
            "-n",
            "2",
            "-p",
            "no:cacheprovider",
            "--rootdir",
            tmp_path,
            tmp_path,
        ],
        env={"PATH": "/usr/bin:/bin", "PYTHONPATH": str(repository)},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=150.0,
        check=False,
    )
    assert f"1 failed, {2 * FILES} passed" in ended.stdout, ended.stdout[-2000:]
    assert "crashed while running" in ended.stdout
