"""From a Compose service to a local process: host names, volumes, Python and health check replaced."""

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from services.launcher.compose.compose_file import Service

CERTIFICATE_VARIABLE = "TOPNAV_CERTS"
LIVELINESS_TEST = ("CMD", "python", "-m", "shared.health")
UNCHECKED_READY_AFTER_S = 0.5  # a command that cannot run ends sooner


@dataclass(frozen=True)
class ProcessSpec:
    """All that is needed to run one service on this machine.

    Attributes:
        name: service name of the Compose file.
        command: words of the command line.
        environment: variables on top of the launcher's own.
        data_folders: what is a volume in a container.
        alive_as: liveliness token that says the service is ready, or None.
        check: health command to run where there is no token, or None.
        check_interval_s: pause between two health commands.
        ready_after_s: how long it must have run to count as healthy; for services without a health check.
        needs: service name -> whether it must be healthy, not just started.
        restart: start it again when it ends.
        stop_grace_s: time between SIGTERM and SIGKILL.
    """

    name: str
    command: tuple[str, ...]
    environment: Mapping[str, str]
    data_folders: tuple[Path, ...]
    alive_as: str | None
    check: tuple[str, ...] | None
    check_interval_s: float
    ready_after_s: float
    needs: Mapping[str, bool]
    restart: bool
    stop_grace_s: float


@dataclass(frozen=True)
class LocalMachine:
    """Where local processes find Python and keep what containers keep in volumes.

    Attributes:
        python: interpreter of all services.
        data_dir: folder of the volumes.
        root: of the Compose file, from which the folders that it mounts are counted.
        certs: folder of all certificates; None runs without, whatever volumes the Compose file has for them.
    """

    python: str
    data_dir: Path
    certs: Path | None = None
    root: Path = Path()


def local_process(name: str, service: Service, hosts: Collection[str], machine: LocalMachine) -> ProcessSpec:
    """Translate one service.

    Args:
        name: its name.
        service: its entry in the Compose file.
        hosts: all service names; as host names they mean this machine.
        machine: Python and data folder of this machine.
    """
    own_certs = service.environment.get(CERTIFICATE_VARIABLE)
    volumes = [v for v in service.volumes if v.split(":")[1] != own_certs]
    mounts = _mounts(volumes, machine)
    environment = {key: _local_value(value, hosts, mounts) for key, value in service.environment.items()}
    if own_certs is not None:
        environment[CERTIFICATE_VARIABLE] = certificate_folder(machine.certs, name)
    test = service.healthcheck.test if service.healthcheck else ()
    by_token = test[: len(LIVELINESS_TEST)] == LIVELINESS_TEST
    return ProcessSpec(
        name=name,
        command=_with_python(service.command, machine.python),
        environment=environment,
        data_folders=tuple(machine.data_dir / v.split(":")[0] for v in volumes if not _is_folder(v)),
        alive_as=test[len(LIVELINESS_TEST)] if by_token else None,
        check=None if by_token or not test or test[0] == "NONE" else _check_command(test, machine.python),
        check_interval_s=service.healthcheck.interval if service.healthcheck else 0.0,
        ready_after_s=0.0 if test else UNCHECKED_READY_AFTER_S,
        needs={other: need.condition == "service_healthy" for other, need in service.depends_on.items()},
        restart=service.restart != "no",
        stop_grace_s=service.stop_grace_period,
    )


def certificate_folder(certs: Path | None, service: str) -> str:
    """A service's own certificate, the only one it is told of; "" without certificates."""
    return str(certs / service.replace("-", "_")) if certs else ""


def _with_python(command: tuple[str, ...], python: str) -> tuple[str, ...]:
    return (python, *command[1:]) if command[0] == "python" else command


def _check_command(test: tuple[str, ...], python: str) -> tuple[str, ...]:
    if test[0] == "CMD-SHELL":
        return ("/bin/sh", "-c", *test[1:])
    return _with_python(test[1:], python)


def _mounts(volumes: Sequence[str], machine: LocalMachine) -> dict[str, Path]:
    """Where each path of the container is: of a volume below the data folder, of a mounted folder itself."""
    mounts = {}
    for volume in volumes:
        source, target = volume.split(":")[:2]
        mounts[target] = (
            machine.root / Path(source).expanduser() if _is_folder(volume) else machine.data_dir / source
        )
    return mounts


def _is_folder(volume: str) -> bool:
    """Whether a folder of the machine is mounted, by Compose's rule, and not a named volume."""
    return volume.startswith((".", "/", "~"))


def _local_value(value: str, hosts: Collection[str], mounts: Mapping[str, Path]) -> str:
    """Point service host names ("tcp/router:7447") at loopback and volume paths at the data folder.

    A path in a URL is written as URLs have it: a folder named "a?b" or "a%20b" is no other one.
    """
    names = "|".join(re.escape(host) for host in hosts)
    value = re.sub(rf"(?<=[/@])(?:{names})(?=:\d)", "127.0.0.1", value)
    for target, folder in mounts.items():
        value = value.replace(target, quote(str(folder)) if "://" in value else str(folder))
    return value
