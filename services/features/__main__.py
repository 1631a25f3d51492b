"""`python -m services.features`."""

import os


def main() -> None:
    """Read the environment and serve."""
    # OpenBLAS reads this once, when numpy is loaded, which the imports below do. Its second thread waits by
    # spinning: on two shared cores the products of one question then took 313 ms of processor time, not 68.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # Nor shall those of torch spin: beside one busy process a network on two threads then takes four to seven
    # times as long, matching eight pictures 780 ms, not 110.
    os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")
    from services.features.settings import FeaturesSettings
    from shared.lifecycle import run_service

    settings = FeaturesSettings.of_service("features")
    os.environ.setdefault("OMP_NUM_THREADS", str(settings.threads))
    from services.features.service import run

    run_service("features", settings, lambda bus, stop: run(settings, bus, stop))


if __name__ == "__main__":
    main()
