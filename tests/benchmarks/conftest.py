"""What every benchmark does with its figures: they are printed, and kept with the machine's description."""

import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from experiments.bench.resources import machine
from services.launcher.terminal.output import rounded, write_json
from tests.benchmarks.test_exploring_plans import world_of


@pytest.fixture
def keep(request: pytest.FixtureRequest, repository: Path) -> Callable[[dict[str, Any]], None]:
    """Call it with the figures; the file in runs/bench, or in BENCH_DIR, is named after the test's."""
    folder = Path(os.environ.get("BENCH_DIR") or repository / "runs" / "bench")
    case = request.node.name.partition("[")[2].rstrip("]")
    name = "-".join(filter(None, [request.path.stem.removeprefix("test_"), case]))

    def write(figures: dict[str, Any]) -> None:
        figures = json.loads(json.dumps(figures), parse_float=lambda text: rounded(float(text)))
        sys.stdout.write(f"\n{name}: {json.dumps(figures, indent=2)}\n")
        write_json(folder / f"{name}.json", {"machine": machine(), **figures})

    return write


@pytest.fixture(scope="module")
def world(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> str:
    """The file of the world that a benchmark's PLAN names."""
    folder, plan = tmp_path_factory.mktemp("world"), request.module.PLAN
    world_of(plan, folder)
    return str(folder / f"{plan}.yaml")
