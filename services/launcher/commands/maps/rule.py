"""`topnav rule`: where robots may not go, which edges they take one way, slowly, or at some hours only."""

import re
from pathlib import Path
from typing import Annotated, Any

import typer

from services.launcher.terminal import options

app = typer.Typer(name="rule", no_args_is_help=True, help="Rules on a map, obeyed by every mission.")

Name = Annotated[str, typer.Argument(help="Name of the rule, which refusals tell.")]
Edges = Annotated[list[str], typer.Argument(help="Edges as A-B, two nodes; one way is from A to B.")]
Nodes = Annotated[list[int] | None, typer.Option("--node", min=0, help="A node; may be given often.")]
Areas = Annotated[list[str] | None, typer.Option("--area", help="A named place; may be given often.")]
Share = Annotated[float, typer.Option(min=0.1, max=1.0, help="Of the usual speed.")]
Zone = Annotated[str, typer.Option("--zone", help="Time zone of the hours, such as Europe/Berlin.")]
Open = Annotated[
    list[str] | None, typer.Option("--open", help="When, as 'mon,tue 08:00-18:00' or '08:00-18:00'.")
]

HOURS = re.compile(r"(?:(?P<days>[a-z,]+) +)?(?P<opens>[0-9:]+)-(?P<closes>[0-9:]+)\Z")


@app.command("list")
def list_rules(
    map_name: options.MapName = "flat",
    data_dir: options.DataDir = options.DATA_DIR,
    as_json: options.AsJson = False,
) -> None:
    """Show the rules of a map."""
    from services.launcher.client.marks import Marks

    Marks("rule", map_name, data_dir).list(_row, as_json)


@app.command("keep-out")
def keep_out(
    name: Name,
    nodes: Nodes = None,
    areas: Areas = None,
    map_name: options.MapName = "flat",
    data_dir: options.DataDir = options.DATA_DIR,
) -> None:
    """Let no robot go to or through these nodes and areas."""
    _put({"kind": "keep_out", "name": name, "nodes": nodes or [], "areas": areas or []}, map_name, data_dir)


@app.command("one-way")
def one_way(
    name: Name,
    edges: Edges,
    map_name: options.MapName = "flat",
    data_dir: options.DataDir = options.DATA_DIR,
) -> None:
    """Have edges driven from their first node to their second only."""
    _put({"kind": "one_way", "name": name, "edges": _pairs(edges)}, map_name, data_dir)


@app.command("slow")
def slow(
    name: Name,
    edges: Edges,
    share: Share = 0.5,
    map_name: options.MapName = "flat",
    data_dir: options.DataDir = options.DATA_DIR,
) -> None:
    """Have edges driven slowly."""
    _put({"kind": "slow", "name": name, "edges": _pairs(edges), "speed_share": share}, map_name, data_dir)


@app.command("hours")
def hours(
    name: Name,
    edges: Edges,
    spans: Open = None,
    zone: Zone = "UTC",
    map_name: options.MapName = "flat",
    data_dir: options.DataDir = options.DATA_DIR,
) -> None:
    """Have edges, such as a door, open at some hours only; without --open they are shut."""
    rule = {"kind": "opening_hours", "name": name, "edges": _pairs(edges), "time_zone": zone}
    _put({**rule, "hours": [_hours(span) for span in spans or []]}, map_name, data_dir)


@app.command("lift")
def lift(
    name: Name, map_name: options.MapName = "flat", data_dir: options.DataDir = options.DATA_DIR
) -> None:
    """Take a rule away."""
    from services.launcher.client.marks import Marks

    Marks("rule", map_name, data_dir).forget(name)


def _put(rule: dict[str, Any], map_name: str, data_dir: Path) -> None:
    from services.launcher.client.marks import Marks

    revision = Marks("rule", map_name, data_dir).put(rule)
    typer.echo(f"rule {rule['name']} holds in {map_name}, revision {revision}")


def _pairs(texts: list[str]) -> list[list[int]]:
    pairs = []
    for text in texts:
        ends = re.fullmatch(r"(\d{1,18})-(\d{1,18})", text)
        if ends is None:
            raise typer.BadParameter(f"an edge is given as A-B, two nodes, got {text!r}")
        pairs.append([int(end) for end in ends.groups()])
    return pairs


def _hours(text: str) -> dict[str, Any]:
    """A span as the map store takes it, which checks days and times."""
    found = HOURS.match(text)
    if found is None:
        raise typer.BadParameter(f"--open expects 'mon,tue 08:00-18:00' or '08:00-18:00', got {text!r}")
    days = {"days": found["days"].split(",")} if found["days"] else {}
    return {**days, "opens": found["opens"], "closes": found["closes"]}


def _row(rule: dict[str, Any]) -> dict[str, str]:
    about = [f"{a}-{b}" for a, b in rule.get("edges", ())]
    about += [*rule.get("areas", ()), *map(str, rule.get("nodes", ()))]
    more = {"slow": f"{rule.get('speed_share')} of the speed", "opening_hours": _said(rule)}
    return {
        "rule": rule["name"],
        "kind": rule["kind"].replace("_", " "),
        "about": ", ".join(about),
        "how": more.get(rule["kind"], ""),
    }


def _said(rule: dict[str, Any]) -> str:
    spans = [f"{','.join(h['days'])} {h['opens']}-{h['closes']}" for h in rule.get("hours", ())]
    return f"{'; '.join(spans) or 'shut'} ({rule.get('time_zone')})"
