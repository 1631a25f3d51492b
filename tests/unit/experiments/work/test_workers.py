"""Workers end with who gave them work."""

import os
import signal
import subprocess
import sys
from pathlib import Path

from shared.inbox import wait_until

SOON_S = 30.0
PARENT = """
import sys
from experiments.work.workers import workers
from tests.unit.experiments.work.test_workers import busy

if __name__ == "__main__":
    with workers(1, None) as pool:
        pool.submit(busy, sys.argv[1]).result()
"""


def busy(folder: str) -> None:
    """Say who works, and when it was stopped."""
    Path(folder, "pid").write_text(str(os.getpid()), encoding="ascii")
    try:
        signal.pause()
    finally:
        Path(folder, "stopped").touch()


def test_a_worker_whose_parent_is_killed_stops_what_it_runs_and_ends(tmp_path, repository):
    program = tmp_path / "parent.py"
    program.write_text(PARENT, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(repository)}
    parent = subprocess.Popen([sys.executable, str(program), str(tmp_path)], env=environment)
    told = tmp_path / "pid"
    assert wait_until(lambda: told.exists() and told.read_text(encoding="ascii") != "", SOON_S)
    worker = int(told.read_text(encoding="ascii"))
    parent.kill()
    parent.wait()
    assert wait_until((tmp_path / "stopped").exists, SOON_S)
    assert wait_until(lambda: not Path(f"/proc/{worker}").exists(), SOON_S)
