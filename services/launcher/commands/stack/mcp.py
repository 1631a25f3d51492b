"""`topnav mcp`: the robot as tools for programs that speak the Model Context Protocol."""

from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer()

HTTP_HELP = "Serve http://HOST:PORT/mcp for programs that bring their tokens, in place of stdio for one."


@app.command()
def mcp(
    map_name: options.MapName = "flat",
    http: Annotated[bool, typer.Option("--http", help=HTTP_HELP)] = False,
    host: Annotated[str, typer.Option(help="Address to serve on.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=0, max=65_535, help="Port to serve on.")] = 8002,
    gateway_url: Annotated[
        str, typer.Option(envvar="MCP_GATEWAY_URL", help="Gateway; default: of the stack in --data-dir.")
    ] = "",
    data_dir: options.DataDir = options.DATA_DIR,
) -> None:
    """Let an agent look, drive and stop. Over stdio it has the token in MCP_TOKEN (role agent)."""
    import asyncio
    from importlib.util import find_spec

    from services.launcher.processes.state import StateFolder

    if find_spec("mcp") is None:
        raise ValueError("topnav mcp needs the package mcp: pip install 'topnav[mcp]'")
    from services.mcp.service import serve
    from services.mcp.settings import McpSettings

    running = StateFolder(data_dir.resolve()).read()
    chosen: dict[str, object] = {"map": map_name, "transport": "http" if http else "stdio"}
    chosen |= {"host": host, "port": port}
    if url := gateway_url or (running.gateway_url if running else ""):
        chosen["gateway_url"] = url
    asyncio.run(serve(McpSettings.model_validate({**McpSettings.from_environment().model_dump(), **chosen})))
