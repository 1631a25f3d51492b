"""The stack a command works with: one that runs already, or one of its own."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path

from services.launcher.client.address import Address, find_address
from services.launcher.client.environments import environment_of
from services.launcher.client.failure import ExperimentError, one_line_errors
from services.launcher.processes.stack_settings import Ports, located
from services.launcher.processes.state import StateFolder
from services.launcher.processes.supervisor import Launcher
from services.launcher.terminal.options import START_TIMEOUT_S
from services.launcher.terminal.progress import start_progress
from shared.bus import Bus, wait_until
from shared.messages.missions import MissionRequest
from shared.topics import MISSION

ROBOT = "r1"
JOIN_TIMEOUT_S = 15.0  # liveliness tokens arrive within a second; a loaded machine needs more
ASK_TIMEOUT_S = 10.0  # as in client/mission.py
NEEDED = frozenset({"planner", "drive", "features", "map_store"})
DISPATCH = "dispatch"
"""Not in a stack of a command's own: the robot is to do what the command says, and no task that waits."""

ROBOTS = frozenset({"simulator", "ros", "camera"})
"""Any of them is a robot, or its eyes."""


@dataclass(frozen=True)
class StackChoice:
    """What a command asks of its stack.

    Attributes:
        world, seed, profile, pipeline: None leaves the default; a running stack keeps its own.
        lockstep: None is lockstep for a stack of its own and whatever a running one has.
        endpoint: join the stack there; None joins the one that runs in data_dir, or starts one.
        ports: of a stack of its own; None takes free ones.
        secure: certificates and access rules for a stack of its own.
        timeout_s: how long the start of one of its own may take.
        ros: file of a robot in ROS 2, in place of a simulator.
        camera: URL of a camera, likewise or beside `ros`.
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
    secure: bool = False
    timeout_s: float = START_TIMEOUT_S
    ros: str | None = None
    camera: str | None = None


@dataclass(frozen=True)
class Stack:
    """A stack in use. `launcher` is None when somebody else runs it, `world` "" where nobody knows it."""

    bus: Bus
    address: Address
    gateway_url: str | None
    launcher: Launcher | None
    robot: str = ROBOT
    world: str = ""

    @property
    def endpoint(self) -> str:
        """Zenoh endpoint of the router."""
        return self.address.endpoint

    @contextmanager
    def session(self) -> Iterator["Stack"]:
        """The same stack over a bus session of its own, which ends with everything it listens to."""
        with self.address.open() as bus:
            _require_services(bus, self.endpoint)
            yield replace(self, bus=bus)


@contextmanager
def open_stack(choice: StackChoice) -> Iterator[Stack]:
    """Join or start a stack and close what was opened.

    Raises:
        ExperimentError: the running stack lacks a service or cannot be what was asked for; or what services
            and HTTP reported while it was in use.
        LaunchError: the own one does not come up.
    """
    with one_line_errors(), _opened(choice) as stack:
        yield stack


@contextmanager
def _opened(choice: StackChoice) -> Iterator[Stack]:
    running = StateFolder(choice.data_dir.resolve()).read()
    address = find_address(choice.endpoint, choice.data_dir)
    if address is not None:
        _refuse_settings(choice)
        own_folder = running is not None and address.endpoint == running.endpoint
        url, world = (running.gateway_url, running.world) if running and own_folder else (None, "")
        with address.open() as bus:
            _require_services(bus, address.endpoint)
            yield Stack(bus, address, url, None, world=world)
        return
    with ExitStack() as opened:
        with start_progress() as told:
            launcher = opened.enter_context(_launcher(choice, told))
        own = Address(launcher.endpoint, launcher.certs)
        with own.open() as bus:
            _require_services(bus, own.endpoint)
            _end_left_mission(bus)
            yield Stack(bus, own, launcher.gateway_url, launcher)


def other_world(stack: Stack, world: str) -> str:
    """A warning where a stack that was joined runs another world than the one that figures are judged in."""
    if not stack.world or located(world) == stack.world:
        return ""
    return (
        f"this stack runs in {stack.world}, not in {world}: true positions are judged on the wrong plan; "
        f"say --world {stack.world}, or stop it ('topnav down')"
    )


def _launcher(choice: StackChoice, told: Callable[[str], None]) -> Launcher:
    place = environment_of(choice.world)
    environment = {**place.variables, **choice.environment}
    if choice.pipeline is not None:
        environment.setdefault("FEATURES_PIPELINE", choice.pipeline)
    return Launcher(
        data_dir=choice.data_dir,
        world=choice.world,
        lockstep=True if choice.lockstep is None else choice.lockstep,
        seed=choice.seed,
        profile=place.profile(choice.profile),
        ports=choice.ports,
        environment=environment,
        secure=choice.secure,
        without=[DISPATCH],
        timeout_s=choice.timeout_s,
        told=told,
        ros=choice.ros,
        camera=choice.camera,
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
    if not wait_until(lambda: not _missing(set(bus.alive())), JOIN_TIMEOUT_S, period_s=0.1):
        missing = ", ".join(_missing(set(bus.alive())))
        raise ExperimentError(f"no living {missing} at {endpoint}: see 'topnav status'")


def _missing(alive: set[str]) -> list[str]:
    return sorted(NEEDED - alive) + ([] if alive & ROBOTS else [f"robot ({', '.join(sorted(ROBOTS))})"])
