"""In which order the processes start."""

from collections.abc import Collection, Mapping
from graphlib import CycleError, TopologicalSorter

from services.launcher.compose.compose_file import Dependency, Service

REAL = {"TOPNAV_CAMERA": "camera", "TOPNAV_ROS": "ros"}
"""Variables that name a real camera and a robot in ROS, and the profile of what runs then."""
BESIDE = {"TOPNAV_FOXGLOVE": "foxglove", "TOPNAV_SIGNS": "signs", "TOPNAV_FLEET": "fleet"}
"""Variables that ask for more, and the profile of what runs then beside all else."""
SIMULATOR = ("-m", "simulator")
"""Command of the process that is camera and robot otherwise; a robot's own under that name is kept."""


def active_services(
    services: Mapping[str, Service], profiles: Collection[str] = (), only: Collection[str] | None = None
) -> dict[str, Service]:
    """Keep the services without a profile or with a chosen one; `only` keeps these and what they need.

    A dependency that is not required counts only where it runs.

    Raises:
        ValueError: `only` names a service that the file lacks.
    """
    chosen = {n: s for n, s in services.items() if not s.profiles or set(s.profiles) & set(profiles)}
    if only is None:
        return _without_absent(chosen)
    wanted, queue = set[str](), list(only)
    while queue:
        name = queue.pop()
        if name not in services:
            raise ValueError(f"no service {name!r}; there are {sorted(services)}")
        if name not in wanted:
            wanted.add(name)
            needs = services[name].depends_on.items()
            queue.extend(other for other, need in needs if need.required or other in chosen)
    return _without_absent({name: service for name, service in services.items() if name in wanted})


def with_chosen(services: Mapping[str, Service], variables: Mapping[str, str]) -> dict[str, Service]:
    """Where a variable of REAL or BESIDE is set, what is of its profile is in the stack.

    The simulator is not in it where one of REAL is.
    """
    real = {profile for variable, profile in REAL.items() if variables.get(variable)}
    chosen = real | {profile for variable, profile in BESIDE.items() if variables.get(variable)}
    kept = {
        name: service for name, service in services.items() if not real or service.command[1:3] != SIMULATOR
    }
    return {
        name: service.model_copy(update={"profiles": ()}) if chosen & set(service.profiles) else service
        for name, service in kept.items()
    }


def _without_absent(services: Mapping[str, Service]) -> dict[str, Service]:
    """Drop the dependencies that are not required and do not run."""

    def needs(service: Service) -> dict[str, Dependency]:
        return {n: need for n, need in service.depends_on.items() if need.required or n in services}

    return {n: s.model_copy(update={"depends_on": needs(s)}) for n, s in services.items()}


def start_stages(services: Mapping[str, Service]) -> list[list[str]]:
    """Group the services so that each stage needs only earlier ones; order within a stage is the file's.

    Raises:
        ValueError: a dependency that is not there, or a cycle.
    """
    for name, service in services.items():
        missing = sorted(set(service.depends_on) - set(services))
        if missing:
            raise ValueError(f"{name} depends on {missing}, which will not run; there are {sorted(services)}")
    sorter = TopologicalSorter({name: service.depends_on.keys() for name, service in services.items()})
    try:
        sorter.prepare()
    except CycleError as error:
        raise ValueError(f"services depend on each other in a circle: {' -> '.join(error.args[1])}") from None
    rank = {name: index for index, name in enumerate(services)}
    stages = []
    while sorter.is_active():
        stage = sorted(sorter.get_ready(), key=rank.__getitem__)
        stages.append(stage)
        sorter.done(*stage)
    return stages
