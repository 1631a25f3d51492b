"""Requests generated from the OpenAPI documents: no server error, nothing undocumented."""

import subprocess
import sys

import pytest

from services.launcher.processes.supervisor import Launcher
from tests.integration.gateway.conftest import UNHURRIED

CHECKS = "not_a_server_error,status_code_conformance,content_type_conformance,response_schema_conformance"
EXAMPLES = 3


NO_RATE_LIMITS = {f"GATEWAY_{name.upper()}": str(value) for name, value in UNHURRIED.items()}
PATIENT = {**NO_RATE_LIMITS, "GATEWAY_ASK_TIMEOUT_S": "60", "GATEWAY_COMPUTE_TIMEOUT_S": "60"}
"""A service that stands still for a while on a busy machine is no server error."""
START_S, RUN_S = 240.0, 600.0


@pytest.fixture(scope="module")
def stack(tmp_path_factory):
    """Every service but the simulator."""
    services = ["features", "map-store", "planner", "drive", "gateway"]
    folder = tmp_path_factory.mktemp("stack")
    with Launcher(folder, only=services, timeout_s=START_S, environment=PATIENT) as launcher:
        yield launcher


@pytest.mark.slow
@pytest.mark.timeout(START_S + RUN_S)
@pytest.mark.parametrize(
    ("service", "left_out"), [("gateway", "/api/maps/import"), ("map_store", "/maps/import")]
)
def test_every_answer_is_one_that_the_description_names(stack, service, left_out):
    """Imports take archives, which have tests of their own."""
    url = {"gateway": stack.gateway_url, "map_store": stack.map_store_url}[service]
    options = ["--checks", CHECKS, "--max-examples", str(EXAMPLES), "--phases", "coverage,fuzzing"]
    options += ["--seed", "1", "--generation-database", "none", "--exclude-path", left_out, "--no-color"]
    options += ["--request-timeout", "90"]
    run = subprocess.run(
        [sys.executable, "-m", "schemathesis.cli", "run", f"{url}/openapi.json", *options],
        capture_output=True,
        text=True,
        timeout=RUN_S,
        check=False,
    )
    assert run.returncode == 0, run.stdout[-4000:] + run.stderr[-1000:]
    assert " passed" in run.stdout
