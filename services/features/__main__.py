"""`python -m services.features`."""

import os


def main() -> None:
    """Read the environment and serve."""
    # OpenBLAS reads this once, when numpy is loaded, which the imports below do. Its second thread waits by
    # spinning: on two shared cores the products of one question then took 313 ms of processor time, not 68.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from services.features.service import run
    from services.features.settings import FeaturesSettings
    from shared.lifecycle import run_service

    settings = FeaturesSettings.of_service("features")
    run_service("features", settings, lambda bus, stop: run(settings, bus, stop))


if __name__ == "__main__":
    main()
