"""Entry point: `python -m services.planner`."""

from functools import partial

from services.planner.service import run
from services.planner.settings import PlannerSettings
from shared.lifecycle import run_service


def main() -> None:
    """Run the planner until a signal."""
    settings = PlannerSettings.of_service("planner")
    run_service("planner", settings, partial(run, settings))


if __name__ == "__main__":
    main()
