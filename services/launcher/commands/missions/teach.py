"""`topnav teach`: a person drives, the robot maps as it goes."""

from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer()

RouteName = Annotated[str | None, typer.Option("--route", help="Keep the way as a route of this name.")]
Finish = Annotated[bool, typer.Option("--finish", help="End the teaching that is under way; it stays.")]

HOW = """{robot} goes along, map {map}. Drive it:
  in the console {console}: tick "drive by hand", keys W A S D
  or from a shell: topnav drive --forward 0.2 --seconds 2
Drive on more slowly where it says that a node is out of sight. Name the place where it stands:
  topnav place name NAME NODE --map {map}, with the node that the console shows as the robot's nearest
When all is taught: the console's Finish, or topnav teach --finish"""


@app.command()
def teach(
    map_name: options.MapName = "flat",
    route: RouteName = None,
    finish: Finish = False,
    robot: options.Robot = "r1",
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
) -> None:
    """Map while a person drives the robot of a running stack; with --route the way is kept by name."""
    from services.launcher.client.address import running_address
    from services.launcher.client.failure import one_line_errors
    from services.launcher.client.mission import MissionClient
    from services.launcher.processes.state import StateFolder
    from shared.messages.missions import MissionRequest

    address = running_address(endpoint, data_dir)
    with one_line_errors(), address.open() as bus:
        client = MissionClient(bus, robot)
        if finish:
            typer.echo(client.ask(MissionRequest(action="finish")).reason)
            return
        parameters = {} if route is None else {"route": route}
        client.ask(MissionRequest(action="teach", map=map_name, parameters=parameters))
    running = StateFolder(data_dir.resolve()).read()
    console = running.gateway_url if running is not None and running.gateway_url else "of its gateway"
    typer.echo(HOW.format(robot=robot, map=map_name, console=console))
