"""`topnav schedule`: tasks that are made again and again, by the clocks of a time zone."""

import json
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer(name="schedule", no_args_is_help=True, help="When tasks are made, again and again.")

Name = Annotated[str, typer.Argument(help="Of the schedule: a to z, 0 to 9, _ and -.")]
Cron = Annotated[
    str, typer.Argument(help="Minute, hour, day of the month, month, day of the week: '30 7 * * MON-FRI'.")
]
Zone = Annotated[str, typer.Option("--zone", help="Time zone of the clocks, such as Europe/Zurich.")]
Off = Annotated[bool, typer.Option("--off", help="Keep it, but let it make no task.")]
Priority = Annotated[int, typer.Option(min=0, max=9, help="Of its tasks; higher first.")]


@app.command("set")
def set_schedule(
    name: Name,
    cron: Cron,
    kind: options.Kind,
    map_name: options.MapName = "flat",
    given: options.Given = None,
    zone: Zone = "UTC",
    priority: Priority = 4,
    off: Off = False,
    seed: options.Seed = 0,
    max_steps: options.MaxSteps = 20_000,
    robot: options.Robot = "r1",
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
) -> None:
    """Set a schedule, or change the one of that name."""
    from services.launcher.client.queue import next_due, open_queue
    from shared.messages.tasks import Errand, Schedule, TaskRequest

    parameters = dict(options.named_value(text) for text in given or [])
    with open_queue(robot, data_dir, endpoint) as queue:
        errand = Errand(
            kind=kind,
            map=map_name,
            parameters=parameters,
            priority=priority,
            seed=seed,
            max_steps=max_steps,
        )
        schedule = Schedule(name=name, robot=robot, cron=cron, time_zone=zone, task=errand, enabled=not off)
        due = next_due(schedule)
        queue.check(errand)
        queue.ask(TaskRequest(action="put_schedule", schedule=schedule))
    typer.echo(f"{name}: {kind} in {map_name}, next {due}")


@app.command("list")
def list_schedules(
    robot: options.Robot = "r1",
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
    as_json: options.AsJson = False,
) -> None:
    """Show the schedules and when they make their next tasks."""
    from services.launcher.client.queue import clock, next_due, open_queue
    from services.launcher.terminal.output import print_rows
    from shared.messages.tasks import TaskRequest

    with open_queue(robot, data_dir, endpoint) as queue:
        schedules = queue.ask(TaskRequest(action="read")).schedules
    if as_json:
        typer.echo(json.dumps([schedule.model_dump(mode="json") for schedule in schedules], indent=2))
        return
    rows = [
        {
            "schedule": schedule.name,
            "cron": schedule.cron,
            "time zone": schedule.time_zone,
            "does": f"{schedule.task.kind} in {schedule.task.map}",
            "next": next_due(schedule),
            "skipped": f"{schedule.skipped}, last {clock(schedule.skipped_ns)}" if schedule.skipped else "",
        }
        for schedule in schedules
    ]
    print_rows(f"schedules of {robot}", rows)


@app.command("remove")
def remove(
    name: Name,
    robot: options.Robot = "r1",
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
) -> None:
    """Remove a schedule; tasks that it made stay."""
    from services.launcher.client.queue import open_queue
    from shared.messages.tasks import TaskRequest

    with open_queue(robot, data_dir, endpoint) as queue:
        queue.ask(TaskRequest(action="remove_schedule", name=name))
    typer.echo(f"{name}: removed")
