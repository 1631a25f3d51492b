"""Entry point: `python -m services.dispatch`."""

from functools import partial

from services.dispatch.service import run
from services.dispatch.settings import DispatchSettings
from shared.lifecycle import run_service


def main() -> None:
    """Run the dispatch service until a signal."""
    settings = DispatchSettings.of_service("dispatch")
    run_service("dispatch", settings, partial(run, settings))


if __name__ == "__main__":
    main()
