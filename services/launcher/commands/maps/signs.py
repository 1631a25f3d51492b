"""`topnav signs`: what robots read in a map, and from where."""

import math
from typing import Annotated, Any

import typer

from services.launcher.terminal import options

app = typer.Typer()

Search = Annotated[str, typer.Argument(help="Only signs that hold this, and signs like it.")]
Forget = Annotated[str | None, typer.Option(help="Forget the sign that says this: it was misread.")]


@app.command()
def signs(
    search: Search = "",
    forget: Forget = None,
    map_name: options.MapName = "flat",
    data_dir: options.DataDir = options.DATA_DIR,
    as_json: options.AsJson = False,
) -> None:
    """Show the signs that were read in a map, with the node from which each is read best."""
    from services.launcher.client.marks import Marks

    marks = Marks("sign", map_name, data_dir)
    if forget is None:
        marks.list(_row, as_json, search)
    else:
        marks.forget(forget)


def _row(sign: dict[str, Any]) -> dict[str, str]:
    best = next(iter(sign["sightings"]), None)
    return {
        "sign": str(sign["name"]),
        "best node": "" if best is None else str(best["node"]),
        "bearing": "" if best is None else f"{math.degrees(best['bearing_rad']):.0f} deg",
        "also from": ", ".join(str(one["node"]) for one in sign["sightings"][1:]),
    }
