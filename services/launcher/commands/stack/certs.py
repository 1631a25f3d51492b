"""`topnav certs`: the private authority of a secured stack and a certificate for each of its services."""

import datetime as dt
import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from shared.certificates.checking import Finding
    from shared.certificates.holders import Holder

app = typer.Typer()


@app.command()
def certs(
    folder: Annotated[Path, typer.Argument(help="Where all certificates lie, one folder for each holder.")],
    robot: Annotated[str, typer.Option(help="Robot of the services.")] = "r1",
    add_robot: Annotated[
        list[str] | None, typer.Option(help="A further robot: a set of its own, in ROLE.ROBOT.")
    ] = None,
    name: Annotated[str | None, typer.Option(help="One further holder, in a folder of this name.")] = None,
    role: Annotated[str | None, typer.Option(help="What that holder may do.", metavar="ROLE")] = None,
    host: Annotated[
        list[str] | None, typer.Option(help="Further host name or address of the router.")
    ] = None,
    keep: Annotated[bool, typer.Option("--keep", help="Make only what is missing.")] = False,
    again: Annotated[bool, typer.Option("--renew", help="New keys and certificates for everybody.")] = False,
    look: Annotated[bool, typer.Option("--check", help="Say what expires or does not fit.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON instead of text.")] = False,
) -> None:
    """Make, renew and check the certificates of a secured stack.

    The key of the authority is in FOLDER/authority: keep it apart.
    """
    from shared.certificates.checking import check
    from shared.certificates.holders import AUTHORITY
    from shared.certificates.issuing import make, renew

    now, hosts = dt.datetime.now(dt.UTC), tuple(host or ())
    if look:
        findings = check(folder, now)
        _show(findings, as_json)
        raise typer.Exit(1 if any(finding.faults for finding in findings) else 0)
    if again:
        made = renew(folder, now, hosts)
    else:
        made = make(folder, _wanted(robot, add_robot or [], name, role), now, hosts, keep)
    if as_json:
        typer.echo(json.dumps([{"name": h.name, "common_name": h.common_name} for h in made], indent=2))
        return
    typer.echo(f"{len(made)} certificates in {folder}: {', '.join(holder.name for holder in made)}")
    typer.echo(f"give each service its own folder only; {folder / AUTHORITY} signs new ones: keep it apart")


def _wanted(robot: str, add_robot: list[str], name: str | None, role: str | None) -> "list[Holder]":
    from shared.access.rules import Role
    from shared.certificates.holders import Holder, another_robot, everyone

    if (name is None) != (role is None):
        raise ValueError(f"--name and --role belong together, got --name {name} --role {role}")
    if name is not None and role is not None:
        if role not in (known := [one.value for one in Role]):
            raise typer.BadParameter(f"--role must be one of {', '.join(known)}, got {role[:40]!r}")
        return [Holder(name, Role(role), robot)]
    if add_robot:
        return [holder for further in add_robot for holder in another_robot(further)]
    return list(everyone(robot))


def _show(findings: "list[Finding]", as_json: bool) -> None:
    from rich.console import Console
    from rich.table import Table

    if as_json:
        rows = [
            {
                "name": f.name,
                "common_name": f.common_name,
                "expires": f.expires.isoformat() if f.expires else None,
                "faults": f.faults,
                "warnings": f.warnings,
            }
            for f in findings
        ]
        typer.echo(json.dumps(rows, indent=2))
        return
    table = Table("", "holder", "common name", "expires", "what is wrong", box=None)
    for f in findings:
        mark = "[yellow]SOON[/yellow]" if f.warnings else "[green]OK[/green]"
        mark = "[bold red]FAIL[/bold red]" if f.faults else mark
        expires = f"{f.expires:%Y-%m-%d}" if f.expires else ""
        table.add_row(mark, f.name, f.common_name, expires, "; ".join((*f.faults, *f.warnings)))
    Console().print(table, highlight=False)
