"""How the process starts."""

import os
import subprocess
import sys
from pathlib import Path

EARLY = """
import sys
import services.features.__main__
print(sorted({"numpy", "cv2", "torch"} & sys.modules.keys()))
"""


def test_numpy_is_not_loaded_before_its_threads_are_chosen(repository: Path):
    run = subprocess.run([sys.executable, "-c", EARLY], cwd=repository, stdout=subprocess.PIPE, check=True)
    assert run.stdout.decode().strip() == "[]", (
        "OpenBLAS reads OPENBLAS_NUM_THREADS once, when numpy is loaded"
    )


STARTED = """
import services.features.__main__ as process
import shared.lifecycle
shared.lifecycle.run_service = lambda *_: __import__("torch")
process.main()
"""


def test_threads_of_torch_are_as_many_as_the_settings_allow_and_do_not_spin(repository: Path):
    plain = {name: value for name, value in os.environ.items() if not name.startswith("OMP_")}
    # The library says what it has read.
    told = {**plain, "OMP_DISPLAY_ENV": "VERBOSE", "FEATURES_THREADS": "3"}
    command = [sys.executable, "-c", STARTED]
    run = subprocess.run(command, cwd=repository, env=told, capture_output=True, check=True, text=True)
    assert "GOMP_SPINCOUNT = '0'" in run.stderr
    assert "OMP_NUM_THREADS = '3'" in run.stderr
