"""`topnav world`: generate or import a world file, and look at one before anybody drives in it."""

import math
from dataclasses import asdict
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from services.launcher.terminal import options

if TYPE_CHECKING:
    from simulator.world.world_check import WorldReport
    from simulator.world.world_file import WorldFile

app = typer.Typer(
    name="world", no_args_is_help=True, help="Generate or import worlds, and check their files."
)

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
def generate(
    kind: Annotated[str, typer.Option(help="For example flat; a wrong one lists them all.")],
    seed: Annotated[int, typer.Option(min=0, help="Draws everything; the same world for the same seed.")],
    size: Annotated[str, typer.Option(help="small, medium or large.")] = "medium",
    into: Annotated[Path | None, typer.Option(help="World file; default: KIND-SEED-SIZE.yaml.")] = None,
) -> None:
    """Draw a world that nobody tuned for: rooms, doorways, furniture, checked before it is written."""
    from simulator.world.world_check import examine

    path = into or Path(f"{kind}-{seed}-{size}.yaml")
    if path.suffix not in {".yaml", ".yml"}:
        raise ValueError(f"--into must end in .yaml, got {path}")
    world = _generated(kind, seed, size, path)
    _show(examine(world))
    split = world.generated.split if world.generated else ""
    typer.echo(f"{path}: split {split}; next: topnav explore --world {path} --map new")


@app.command("import")
def import_(
    source: Annotated[Path, typer.Argument(help="A Gazebo world (.world, .sdf), or a scene (.glb, .gltf).")],
    into: Annotated[Path, typer.Option(help="Folder for the world file and its models.")],
    models: Annotated[
        list[Path] | None, typer.Option(help="Folder with models; may be given often.", show_default=False)
    ] = None,
    start: Annotated[
        tuple[float, float, float] | None,
        typer.Option(help="x and y (m), yaw (degrees) of the robot; default: in the largest free floor."),
    ] = None,
    leave_out: Annotated[
        bool, typer.Option("--leave-out", help="Go on without models that are missing or broken.")
    ] = False,
) -> None:
    """Turn a world that others made into a world file; floor, walls and obstacles come from its geometry."""
    from services.launcher.terminal.output import wide_console
    from services.launcher.terminal.progress import stage_progress
    from simulator.importing.import_world import import_world
    from simulator.world.world_check import examine

    console = wide_console(stderr=True)
    with stage_progress(console, f"importing {source.name}") as progress:
        imported = import_world(source, into, models or [], start, leave_out, progress)
    for note in imported.notes:
        console.print(f"[yellow]note[/yellow]  {note}", highlight=False)
    _show(examine(imported.world))
    typer.echo(f"{imported.path}; next: topnav explore --world {imported.path} --map {into.name}")


@app.command()
def rearrange(
    world: World,
    into: Annotated[Path, typer.Option(help="World file to write; beside the old one if that names files.")],
    seed: Annotated[int, typer.Option(min=0, help="Draws what changes.")] = 1,
    share: Annotated[float, typer.Option(min=0.0, max=1.0, help="Of the furniture, that changes.")] = 0.3,
) -> None:
    """Write a world as it may be found later: furniture moved, gone or exchanged, other light, doors open."""
    from simulator.generation.rearranged_world import rearrange_file
    from simulator.world.world_check import examine

    _show(examine(rearrange_file(world, into, seed, share)))
    typer.echo(f"{into}; next, with a map of {world}: topnav hide-and-seek --world {into}")


@app.command()
def move(
    item: Annotated[str, typer.Argument(help="Name of a piece, or its kind and number: chair-2.")],
    to: Annotated[tuple[float, float, float] | None, typer.Option(help="x and y (m), yaw (degrees).")] = None,
    gone: Annotated[bool, typer.Option("--gone", help="Take it away.")] = False,
    back: Annotated[bool, typer.Option("--back", help="Put it where the file has it.")] = False,
    robot: Annotated[str, typer.Option(help="Whose simulator.")] = "r1",
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
) -> None:
    """Move furniture in the world of a running stack; the robot finds out by itself."""
    from services.launcher.client.address import running_address
    from services.launcher.client.experimenter import Experimenter
    from services.launcher.client.failure import one_line_errors
    from shared.messages.simulation import Pose

    if (to is not None) + gone + back != 1:
        raise typer.BadParameter("say one of --to X Y YAW, --gone, --back")
    address = running_address(endpoint, data_dir)
    pose = Pose(x_m=to[0], y_m=to[1], yaw_rad=math.radians(to[2])) if to is not None else None
    with one_line_errors(), address.open() as bus:
        Experimenter(bus, robot).set_item(item, None if pose else back, pose)
    typer.echo(f"{item}: {'moved' if pose else 'back' if back else 'gone'}")


@app.command()
def light(
    illumination: Annotated[float, typer.Argument(min=0, max=1, help="0 noon, 0.5 dusk, 1 lamps only.")],
    robot: Annotated[str, typer.Option(help="Whose simulator.")] = "r1",
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
) -> None:
    """Let it become another time of day in the world of a running stack."""
    from services.launcher.client.address import running_address
    from services.launcher.client.experimenter import Experimenter
    from services.launcher.client.failure import one_line_errors

    with one_line_errors(), running_address(endpoint, data_dir).open() as bus:
        Experimenter(bus, robot).set_light(illumination)
    typer.echo(f"light: {illumination:g}, where noon is 0 and lamps only 1")


@app.command()
def gallery(
    into: Annotated[Path, typer.Option(help="Folder for the page, world files and pictures.")],
    count: Annotated[int, typer.Option(min=1, max=1000, help="Worlds: kinds and sizes in turn.")] = 60,
) -> None:
    """Draw many generated worlds and write a page with the plan and a panorama of each."""
    from services.launcher.drawing.gallery import Exhibit, write_page
    from services.launcher.drawing.plans import draw_start
    from simulator.generation.splits import worlds_of
    from simulator.world.world_check import examine

    exhibits = []
    for kind, seed, size in islice(worlds_of({"development", "validation"}), count):
        name = f"{kind}-{seed}-{size}"
        world = _generated(kind, seed, size, into / f"{name}.yaml")
        draw_start(into / f"{name}.png", world)
        _render(world, into / f"{name}.jpg")
        report = examine(world)
        figures = f"{report.size_m[0]:g} x {report.size_m[1]:g} m, {report.free_m2:.0f} m2 free"
        exhibits.append(Exhibit(name, world.generated.split if world.generated else "", figures))
        typer.echo(f"{len(exhibits)} of {count}: {name}, {figures}")
    typer.echo(f"page: {write_page(into, exhibits)}")


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
        "floor": f"{report.floor_m2:g} m2" + (f" in {report.rooms} rooms" if report.rooms else ""),
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


def _generated(kind: str, seed: int, size: str, path: Path) -> "WorldFile":
    """Draw a world and write its file, which is then read as anybody's."""
    from simulator.generation.generate import generate
    from simulator.generation.world_text import write_world

    return write_world(path, generate(kind, seed, size))


def _render(world: "WorldFile", path: Path) -> None:
    import cv2

    from simulator.service_settings import SimulatorSettings
    from simulator.simulation import Simulation

    settings = SimulatorSettings.from_environment().model_copy(update={"width_px": PANORAMA_PX})
    picture = Simulation(world, settings.simulation(), seed=1).panorama()
    path.parent.mkdir(parents=True, exist_ok=True)
    if not cv2.imwrite(str(path), picture):
        raise ValueError(f"--panorama must end in .png or .jpg, got {path}")
