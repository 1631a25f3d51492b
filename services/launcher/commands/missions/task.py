"""`topnav task`: the queue of a robot that runs: add, list, move, cancel."""

import getpass
import json
import uuid
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer(name="task", no_args_is_help=True, help="Tasks that wait for a robot that runs.")

TaskId = Annotated[str, typer.Argument(help="As 'topnav task list' shows it.")]
NewId = Annotated[str, typer.Option("--id", help="Of your choice: added again, it is not added twice.")]
Ended = Annotated[int, typer.Option(min=0, max=200, help="Show so many that ended as well.")]
Priority = Annotated[int, typer.Option(min=0, max=9, help="Higher first; of the same, older first.")]
Whose = Annotated[str, typer.Option("--robot", help="Name of a robot; any: whichever is free and nearest.")]
NewPriority = Annotated[int, typer.Argument(min=0, max=9, help="Higher first.")]


@app.command("add")
def add(
    kind: options.Kind,
    map_name: options.MapName = "flat",
    given: options.Given = None,
    priority: Priority = 4,
    task_id: NewId = "",
    seed: options.Seed = 0,
    max_steps: options.MaxSteps = 20_000,
    robot: Whose = "r1",
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
) -> None:
    """Put a mission of any kind into the queue."""
    from services.launcher.client.queue import open_queue
    from shared.messages.tasks import Task, TaskRequest

    parameters = dict(options.named_value(text) for text in given or [])
    with open_queue(robot, data_dir, endpoint) as queue:
        task = Task(
            task_id=task_id or f"t-{uuid.uuid4().hex[:12]}",
            robot=robot,
            kind=kind,
            map=map_name,
            parameters=parameters,
            priority=priority,
            seed=seed,
            max_steps=max_steps,
            by=getpass.getuser()[:64],
        )
        queue.check(task)
        reply = queue.ask(TaskRequest(action="add", task=task))
    before = [one.task_id for one in reply.tasks].index(task.task_id) if reply.task in reply.tasks else 0
    typer.echo(f"{task.task_id}: {kind} in {map_name}, {before} before it")


@app.command("list")
def list_tasks(
    ended: Ended = 5,
    robot: Whose = "r1",
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
    as_json: options.AsJson = False,
) -> None:
    """Show what runs and waits, in the order in which it begins, then what ended last."""
    from services.launcher.client.queue import clock, open_queue
    from services.launcher.terminal.output import print_rows
    from shared.messages.tasks import TaskRequest

    with open_queue(robot, data_dir, endpoint) as queue:
        reply = queue.ask(TaskRequest(action="read", ended=ended))
    tasks = [*reply.tasks, *reply.ended]
    if as_json:
        typer.echo(json.dumps([task.model_dump(mode="json") for task in tasks], indent=2))
        return
    rows = [
        {
            "task": task.task_id,
            "robot": task.robot,
            "does": f"{task.kind} in {task.map}",
            "priority": task.priority,
            "state": f"{task.state} {task.failure}".strip(),
            "since": clock(task.ended_ns or task.started_ns or task.created_ns),
            "reason": task.reason[:80],
        }
        for task in tasks
    ]
    print_rows(f"tasks of {robot}", rows)


@app.command("cancel")
def cancel(
    task_id: TaskId,
    robot: Whose = "r1",
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
) -> None:
    """Take a task out of the queue; one that runs ends with its mission."""
    from services.launcher.client.queue import open_queue

    with open_queue(robot, data_dir, endpoint) as queue:
        before = queue.cancel(task_id).state
    typer.echo(f"{task_id}: cancelled{' while it ran' if before == 'running' else ''}")


@app.command("priority")
def prioritize(
    task_id: TaskId,
    priority: NewPriority,
    robot: Whose = "r1",
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
) -> None:
    """Give a task that waits another priority, 0 to 9."""
    from services.launcher.client.queue import open_queue
    from shared.messages.tasks import TaskRequest

    with open_queue(robot, data_dir, endpoint) as queue:
        queue.ask(TaskRequest(action="prioritize", task_id=task_id, priority=priority))
    typer.echo(f"{task_id}: priority {priority}")
