"""How the process starts."""

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
