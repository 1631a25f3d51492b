"""`Launcher`: the processes of docker-compose.yml on this machine, for the shell, experiments and tests.

with Launcher(world="apartment", lockstep=True, seed=1, data_dir=folder) as stack:
    stack.endpoint, stack.gateway_url
    stack.kill("planner")
    stack.wait_healthy("planner", timeout_s=5.0)
"""

import logging
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Collection, Mapping
from functools import partial
from pathlib import Path
from typing import Self

from services.launcher.compose.compose_file import COMPOSE_FILE, load_compose
from services.launcher.compose.local import LocalMachine, ProcessSpec, certificate_folder, local_process
from services.launcher.compose.plan import active_services, start_stages, with_chosen
from services.launcher.processes.free_ports import HOST
from services.launcher.processes.health import CommandHealth, Health, Liveliness, always_ready
from services.launcher.processes.loop import SupervisorLoop
from services.launcher.processes.preparing import OPERATOR, prepare
from services.launcher.processes.process import ChildProcess, rotate
from services.launcher.processes.restart import RestartPolicy
from services.launcher.processes.runner import ServiceRunner
from services.launcher.processes.stack_settings import Ports, StackSettings
from services.launcher.processes.state import ServiceStatus, StackState, StateFolder
from services.launcher.processes.wait import LaunchError, require_healthy
from shared.access.credentials import secured_url
from shared.access.rules import robot_names

log = logging.getLogger(__name__)

WORLD = "SIMULATOR_WORLD"
"""Variable of the simulator that names its world."""


class Launcher:
    """A running stack. As a context manager it starts everything, waits until all is healthy, and stops all.

    Args:
        data_dir: maps, logs and state live here; one stack per folder.
        world, lockstep, seed, profile: see StackSettings; None leaves the Compose file's default.
        ports: default: free ones, so that stacks run side by side.
        environment: set in every service last of all.
        secure: certificates, mTLS and access rules on the bus.
        camera: URL of a real camera, and ros: file of a robot in ROS 2, in place of the simulator.
        foxglove: port of the live view for Foxglove; None leaves it out.
        signs: signs are read as well.
        fleet: hand out tasks for whichever robot, too.
        only: run these services and what they depend on.
        without: leave these services out.
        variables: what the Compose file interpolates, and services are told beside what it says; by default
            this process's environment.
        compose_file: which processes there are.
        timeout_s: how long the start may take.
        policy: back-off of restarts.
        watch: called from another thread with every change of status.
        told: called about once a second while the start is waited for, with what it waits for.
    """

    def __init__(
        self,
        data_dir: Path | str,
        world: str | None = None,
        lockstep: bool | None = None,
        seed: int | None = None,
        profile: str | None = None,
        ports: Ports | None = None,
        environment: Mapping[str, str] | None = None,
        only: Collection[str] | None = None,
        without: Collection[str] = (),
        variables: Mapping[str, str] | None = None,
        compose_file: Path = COMPOSE_FILE,
        timeout_s: float = 300.0,
        policy: RestartPolicy | None = None,
        watch: Callable[[Mapping[str, ServiceStatus]], None] | None = None,
        secure: bool = False,
        camera: str | None = None,
        ros: str | None = None,
        foxglove: int | None = None,
        signs: bool = False,
        fleet: bool = False,
        told: Callable[[str], None] | None = None,
    ) -> None:
        folder = Path(data_dir).resolve()
        ports, environment = ports or Ports.free(), dict(environment or {})
        self.settings = StackSettings(
            folder,
            world,
            lockstep,
            seed,
            profile,
            ports,
            environment,
            secure,
            camera,
            ros,
            foxglove,
            signs,
            fleet,
        )
        self._root, self._timeout_s, self._watch = compose_file.resolve().parent, timeout_s, watch
        self._told = told
        self._state = StateFolder(folder)
        self._started = ""
        self._liveliness = Liveliness()
        self._variables = dict(variables or {})
        specs = self._specs(compose_file, variables, only, without)
        self._world = next((spec.environment[WORLD] for spec in specs if WORLD in spec.environment), "")
        self._checks: list[CommandHealth] = []
        policy = policy or RestartPolicy()
        runners = {spec.name: ServiceRunner(spec, self._health(spec), self._spawn, policy) for spec in specs}
        self._uses_bus = any(spec.alive_as for spec in specs)
        self._loop = SupervisorLoop(runners, self._stages, self._changed, self._beat)

    @property
    def endpoint(self) -> str:
        """Zenoh endpoint of the router."""
        return self.settings.endpoint

    @property
    def certs(self) -> Path | None:
        """Certificate of the shell on a secured stack, None on an open one."""
        folder = certificate_folder(self.settings.certs, OPERATOR)
        return Path(folder) if folder else None

    @property
    def gateway_url(self) -> str:
        """Base URL of the gateway."""
        return f"http://{HOST}:{self.settings.ports.gateway}"

    @property
    def map_store_url(self) -> str:
        """Base URL of the map store."""
        url = f"http://{HOST}:{self.settings.ports.map_store}"
        return secured_url(url) if self.settings.secure else url

    @property
    def logs(self) -> Path:
        """Folder with one log file per service."""
        return self._state.logs

    def start(self, wait: bool = True) -> None:
        """Start everything and wait until all is healthy.

        Raises:
            AlreadyRunningError: the data folder belongs to a running stack.
            LaunchError: a service keeps crashing or is not healthy in time; everything is stopped again.
            CertificatesError: a certificate has expired or does not fit.
        """
        self._state.acquire()
        self._started = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())
        try:
            if self.settings.certs:
                prepare(self.settings.certs, self._robots)
            self._loop.start()
            if self._uses_bus:
                self._liveliness.open(self.endpoint, self.certs)
            if wait:
                self.wait_all_healthy(self._timeout_s)
        except BaseException:
            self.stop()
            raise

    def stop(self) -> None:
        """Stop all services in the reverse of the start order."""
        self._loop.stop()
        self._liveliness.close()
        for check in self._checks:
            check.close()
        self._state.release()

    def __enter__(self) -> Self:
        """Start."""
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Stop."""
        self.stop()

    @property
    def running(self) -> bool:
        """Whether anybody still looks after the services."""
        return self._loop.running

    def status(self) -> dict[str, ServiceStatus]:
        """Describe every service as of now."""
        return self._loop.status()

    def pid(self, service: str) -> int | None:
        """Return the process id of a service, None while it is down."""
        child = self._loop.child(service)
        return child.pid if child else None

    def kill(self, service: str, number: signal.Signals = signal.SIGKILL) -> int:
        """Send a signal to a service's process group; returns its pid.

        Raises:
            LaunchError: it is not running.
        """
        child = self._loop.child(service)
        if child is None:
            raise LaunchError(f"{service} is not running, it is {self.status()[service].state.value}")
        child.send(number)
        return child.pid

    def wait_healthy(self, service: str, timeout_s: float, other_than: int | None = None) -> None:
        """Wait until a service is healthy, with another pid than `other_than` when given.

        Raises:
            LaunchError: not in time; says the state and the last log line.
        """
        require_healthy(self.status, [service], timeout_s, self.logs, other_than)

    def wait_all_healthy(self, timeout_s: float, stop: threading.Event | None = None) -> None:
        """Wait until every service is healthy or `stop` is set.

        Raises:
            LaunchError: not in time; at once for a service that keeps ending.
        """
        require_healthy(self.status, list(self.status()), timeout_s, self.logs, stop=stop, told=self._told)

    def _specs(
        self,
        compose_file: Path,
        variables: Mapping[str, str] | None,
        only: Collection[str] | None,
        without: Collection[str],
    ) -> list[ProcessSpec]:
        given = self.settings.variables(variables)
        self._robots = robot_names(given)
        compose = load_compose(compose_file, given)
        kept = {name: one for name, one in compose.services.items() if name not in without}
        services = active_services(with_chosen(kept, given), only=only)
        self._stages = start_stages(services)
        machine = LocalMachine(sys.executable, self.settings.data_dir, self.settings.certs, self._root)
        return [local_process(name, service, compose.services, machine) for name, service in services.items()]

    def _health(self, spec: ProcessSpec) -> Health:
        if spec.alive_as:
            return partial(self._liveliness.alive, spec.alive_as)
        if not spec.check:
            return always_ready
        check = CommandHealth(spec.check, self._environment(spec), self._root, spec.check_interval_s)
        self._checks.append(check)
        return check

    def _environment(self, spec: ProcessSpec) -> dict[str, str]:
        own = {**spec.environment, **self.settings.environment, "PYTHONPATH": str(self._root)}
        return {**os.environ, **self._variables, **own}

    def _spawn(self, spec: ProcessSpec) -> ChildProcess:
        for folder in spec.data_folders:
            folder.mkdir(parents=True, exist_ok=True)
        return ChildProcess(
            spec.command, self._environment(spec), self.logs / f"{spec.name}.jsonl", self._root
        )

    def _beat(self) -> None:
        self._state.beat()
        for log_path in self.logs.glob("*.jsonl"):
            rotate(log_path)

    def _changed(self, services: Mapping[str, ServiceStatus]) -> None:
        self._state.write(
            StackState(
                launcher_pid=os.getpid(),
                started=self._started,
                endpoint=self.endpoint,
                gateway_url=self.gateway_url,
                map_store_url=self.map_store_url,
                logs=str(self.logs),
                certs=self.certs,
                world=self._world,
                services=dict(services),
            )
        )
        if self._watch:
            self._watch(services)
