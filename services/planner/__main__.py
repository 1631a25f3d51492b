"""Entry point: `python -m services.planner`."""

import os
from functools import partial


def main() -> None:
    """Run the planner until a signal."""
    # As in services.features: OpenBLAS reads it when numpy is loaded, and its second thread only spins.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from services.planner.service import run
    from services.planner.settings import PlannerSettings
    from shared.lifecycle import run_service

    settings = PlannerSettings.of_service("planner")
    run_service("planner", settings, partial(run, settings))


if __name__ == "__main__":
    main()
