"""Entry point: `python -m services.signs`."""

from functools import partial

from services.signs.recognition import TextReader
from services.signs.service import run
from services.signs.settings import SignsSettings
from shared.lifecycle import run_service


def main() -> None:
    """Read signs until a signal."""
    settings = SignsSettings.of_service("signs")
    run_service("signs", settings, partial(run, settings, TextReader(settings.threads)))


if __name__ == "__main__":
    main()
