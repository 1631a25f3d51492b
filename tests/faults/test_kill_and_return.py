"""The processes of docker-compose.yml under the launcher, without the simulator: killed, each comes back."""

import pytest

from services.launcher.processes.supervisor import Launcher
from tests.integration.launcher.returning import PATIENCE_S, kills_until_it_is_back_in_time


@pytest.fixture(scope="module")
def stack(tmp_path_factory):
    folder = tmp_path_factory.mktemp("stack")
    services = ["features", "map-store", "planner", "drive", "gateway"]
    with Launcher(folder, lockstep=True, seed=1, only=services, timeout_s=120.0) as launcher:
        yield launcher


@pytest.mark.parametrize("service", ["router", "map-store", "features", "planner", "drive", "gateway"])
def test_a_killed_service_is_back_and_the_others_go_on(stack, service):
    others = {name: stack.pid(name) for name in stack.status() if name != service}
    assert kills_until_it_is_back_in_time(stack, service)
    assert {name: stack.pid(name) for name in others} == others
    stack.wait_all_healthy(PATIENCE_S)


def test_what_must_be_kept_is_kept_in_the_data_folder(stack):
    assert (stack.settings.data_dir / "maps" / "maps.sqlite3").exists()
    assert {path.name for path in stack.logs.iterdir()} == {f"{name}.jsonl" for name in stack.status()}
