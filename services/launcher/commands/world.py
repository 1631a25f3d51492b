"""`topnav world`: look at a world file before anybody drives in it."""

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from services.launcher.terminal import options

if TYPE_CHECKING:
    from simulator.world.world_check import WorldReport
    from simulator.world.world_file import WorldFile

app = typer.Typer(name="world", no_args_is_help=True, help="Check a world file before anybody drives in it.")

World = Annotated[str, typer.Argument(help="A .yaml file, or the name of a world that comes with topnav.")]
Plan = Annotated[Path | None, typer.Option(help="Draw the floor plan to this PNG file.")]
Panorama = Annotated[Path | None, typer.Option(help="Render what the robot sees at the start to this file.")]
PANORAMA_PX = 2048  # twice the running camera's: for people to look at


@app.command()
def check(
    world: World, plan: Plan = None, panorama: Panorama = None, json_file: options.JsonFile = None
) -> None:
    """Say how large a world is, what the robot cannot reach and where it is narrow; exit 1 on faults."""
    from services.launcher.terminal.output import write_json
    from simulator.world.world_check import examine
    from simulator.world.world_file import load_world

    file = load_world(world)
    report = examine(file)
    _show(report)
    write_json(json_file, asdict(report))
    if plan is not None:
        from services.launcher.drawing.plans import draw_start

        draw_start(plan, file)
    if panorama is not None and not report.faults:
        _render(file, panorama)
    raise typer.Exit(1 if report.faults else 0)


@app.command()
def kinds(
    into: Annotated[Path | None, typer.Option(help="Renew the tables of this page instead.")] = None,
) -> None:
    """List furniture with its options, and textures, as Markdown."""
    from simulator.world.world_reference import reference, renewed

    if into is None:
        typer.echo(reference())
    else:
        into.write_text(renewed(into.read_text(encoding="utf-8")), encoding="utf-8")


def _show(report: "WorldReport") -> None:
    from rich.console import Console
    from rich.table import Table

    console = Console()
    table = Table(title=f"world {report.name}", show_header=False)
    figures = {
        "size": f"{report.size_m[0]:g} x {report.size_m[1]:g} m",
        "floor": f"{report.floor_m2:g} m2 in {report.rooms} rooms",
        "free for the robot": f"{report.free_m2:g} m2, and {report.cut_off_m2:g} m2 that it cannot reach",
        "parts": f"{report.parts}, of which {report.solids} solid",
        "lamps, materials": f"{report.lights}, {report.looks}",
        "start": "free" if report.start_free else "not free",
        "cannot be reached": ", ".join(report.unreachable) or "nothing",
    }
    for name, value in figures.items():
        table.add_row(name, value)
    for passage in report.passages[:12]:
        table.add_row(
            f"passage {passage.width_m:.2f} m wide",
            f"at ({passage.x_m:g}, {passage.y_m:g}), {passage.behind_m2:g} m2 behind it",
        )
    console.print(table, highlight=False)
    for fault in report.faults:
        console.print(f"[red]fault[/red]  {fault}", highlight=False)
    for doubt in report.doubts:
        console.print(f"[yellow]check[/yellow]  {doubt}", highlight=False)


def _render(world: "WorldFile", path: Path) -> None:
    import cv2

    from simulator.service_settings import SimulatorSettings
    from simulator.simulation import Simulation

    settings = SimulatorSettings.from_environment().model_copy(update={"width_px": PANORAMA_PX})
    picture = Simulation(world, settings.simulation(), seed=1).panorama()
    path.parent.mkdir(parents=True, exist_ok=True)
    if not cv2.imwrite(str(path), picture):
        raise ValueError(f"--panorama must end in .png or .jpg, got {path}")
