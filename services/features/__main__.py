"""`python -m services.features`."""

import os

from services.features.settings import FeaturesSettings


def main() -> None:
    """Read the environment and serve."""
    settings = FeaturesSettings.from_environment()
    # OpenBLAS reads this once, when numpy is loaded. Its second thread waits by spinning: on two shared
    # cores the products of one question then took 313 ms of processor time instead of 68.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from services.features.service import run
    from shared.lifecycle import run_service

    run_service("features", settings, lambda bus, stop: run(settings, bus, stop))


if __name__ == "__main__":
    main()
