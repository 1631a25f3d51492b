"""`python -m services.features`."""

from services.features.service import run
from services.features.settings import FeaturesSettings
from shared.lifecycle import run_service


def main() -> None:
    """Read the environment and serve."""
    settings = FeaturesSettings.from_environment()
    run_service("features", settings, lambda bus, stop: run(settings, bus, stop))


if __name__ == "__main__":
    main()
