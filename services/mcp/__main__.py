"""Entry point: `python -m services.mcp`."""

import asyncio

from services.mcp.service import serve
from services.mcp.settings import McpSettings


def main() -> None:
    """Serve until the program that asks is gone, or a signal."""
    asyncio.run(serve(McpSettings.of_service("mcp")))


if __name__ == "__main__":
    main()
