"""The stack a command works with: one that runs already, or one of its own."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path

from experiments.environments import environment_of
from experiments.failure import ExperimentError
from services.launcher.stack_settings import Ports
from services.launcher.state import StateFolder
from services.launcher.supervisor import Launcher
from shared.bus import Bus, open_bus, wait_until
from shared.messages import MissionRequest
from shared.topics import MISSION

ROBOT = "r1"
JOIN_TIMEOUT_S = 15.0
ASK_TIMEOUT_S = 10.0
NEEDED = frozenset({"planner", "drive", "features", "map_store", "simulator"})


@dataclass(frozen=True)
class StackChoice:
    """What a command asks of its stack.

    Attributes:
        world, seed, profile, pipeline: None leaves the default; a running stack keeps its own.
        lockstep: None is lockstep for a stack of its own and whatever a running one has.
        endpoint: join the stack there; None joins the one that runs in data_dir, or starts one.
        ports: of a stack of its own; None takes free ones.
    """

    data_dir: Path
    world: str | None = None
    seed: int | None = None
    lockstep: bool | None = None
    profile: str | None = None
    pipeline: str | None = None
    endpoint: str | None = None
    ports: Ports | None = None
    environment: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Stack:
    """A stack in use. `launcher` is None when somebody else runs it."""

    bus: Bus
    endpoint: str
    gateway_url: str | None
    launcher: Launcher | None
    robot: str = ROBOT

    @contextmanager
    def session(self) -> Iterator["Stack"]:
        """The same stack over a bus session of its own, which ends with everything it listens to."""
        with open_bus(self.endpoint) as bus:
            _require_services(bus, self.endpoint)
            yield replace(self, bus=bus)


@contextmanager
def open_stack(choice: StackChoice) -> Iterator[Stack]:
    """Join or start a stack and close what was opened.

    Raises:
        ExperimentError: the running stack lacks a service or cannot be what was asked for.
        LaunchError: the own one does not come up.
    """
    running = StateFolder(choice.data_dir.resolve()).read()
    if choice.endpoint is not None or running is not None:
        _refuse_settings(choice)
        endpoint = choice.endpoint or (running.endpoint if running else "")
        url = running.gateway_url if running and endpoint == running.endpoint else None
        with open_bus(endpoint) as bus:
            _require_services(bus, endpoint)
            yield Stack(bus, endpoint, url, None)
        return
    with _launcher(choice) as launcher, open_bus(launcher.endpoint) as bus:
        _require_services(bus, launcher.endpoint)
        _end_left_mission(bus)
        yield Stack(bus, launcher.endpoint, launcher.gateway_url, launcher)


def _launcher(choice: StackChoice) -> Launcher:
    place = environment_of(choice.world)
    environment = {**place.variables, **choice.environment}
    pipeline = choice.pipeline or place.pipeline
    if pipeline is not None:
        environment.setdefault("FEATURES_PIPELINE", pipeline)
    return Launcher(
        data_dir=choice.data_dir,
        world=choice.world,
        lockstep=True if choice.lockstep is None else choice.lockstep,
        seed=choice.seed,
        profile=place.profile(choice.profile),
        ports=choice.ports,
        environment=environment,
    )


def _refuse_settings(choice: StackChoice) -> None:
    given = [name for name in ("profile", "pipeline") if getattr(choice, name) is not None]
    if given:
        raise ExperimentError(
            f"--{given[0]} cannot change a stack that runs: stop it ('topnav down'), or start it with that "
            f"{given[0]} and leave the option out"
        )


def _end_left_mission(bus: Bus) -> None:
    """End the mission of a command that was killed: the planner takes it up again when it starts."""
    status = bus.ask(MISSION, MissionRequest(action="status"), ASK_TIMEOUT_S, robot=ROBOT)
    if status.state in ("running", "paused"):
        bus.ask(MISSION, MissionRequest(action="cancel"), ASK_TIMEOUT_S, robot=ROBOT)


def _require_services(bus: Bus, endpoint: str) -> None:
    if not wait_until(lambda: set(bus.alive()) >= NEEDED, JOIN_TIMEOUT_S, period_s=0.1):
        missing = sorted(NEEDED - set(bus.alive()))
        raise ExperimentError(f"no living {', '.join(missing)} at {endpoint}: see 'topnav status'")
