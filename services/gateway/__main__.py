"""`python -m services.gateway`."""

import sys

from services.gateway.auth.tokens import ValidTokens
from services.gateway.service import run
from services.gateway.settings import GatewaySettings
from shared.lifecycle import run_service


def main() -> int:
    """Run until told to stop; 2 when the settings are wrong."""
    try:
        settings = GatewaySettings.from_environment().with_kept_secret()
        ValidTokens.chosen(settings)
    except ValueError as error:
        sys.stderr.write(f"gateway: {error}\n")
        return 2
    run_service("gateway", settings, lambda bus, stop: run(settings, bus, stop))
    return 0


if __name__ == "__main__":
    sys.exit(main())
