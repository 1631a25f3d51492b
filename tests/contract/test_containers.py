"""Images and their settings, by the few rules that matter, without an engine.

Pinning the base image by digest needs a registry to ask, so the tag names Python and Debian release instead.
"""

import re
from pathlib import Path

import pytest
import yaml

from services.launcher.compose.interpolate import interpolate

ROOT = Path(__file__).resolve().parents[2]
SERVICES = yaml.safe_load((ROOT / "docker-compose.yml").read_text(encoding="utf-8"))["services"]
DOCKERFILES = sorted((ROOT / "deploy/docker").glob("*.Dockerfile"))
BASE = "FROM python:3.11-slim-trixie"
CORE = (
    "RUN touch README.md && pip install --no-cache-dir --constraint constraints.txt . "
    "&& rm -r /usr/local/lib/python3.11/site-packages/numpy/*/tests"
)
BUILD_TOOLS = re.compile(r"\b(gcc|g\+\+|build-essential|cmake|make|git|curl|wget|python3?-dev|rustc)\b")
SECRETS = re.compile(r"^(ENV|ARG) .*(TOKEN|PASSWORD|SECRET|PRIVATE_KEY)", re.MULTILINE)


def instructions(path: Path) -> list[str]:
    """Lines of a Dockerfile without comments, continued ones joined."""
    text = re.sub(r"\\\n", " ", path.read_text(encoding="utf-8"))
    return [line for line in text.splitlines() if line.strip() and not line.startswith("#")]


def given_folders(line: str) -> set[str]:
    """Folders that an instruction gives to the image's user, a shell's `for one in ...` written out."""
    loop = re.search(r"for one in ([\w ]+);", line)
    texts = [line.replace("$one", word) for word in loop[1].split()] if loop else [line]
    given = "install --directory --owner topnav"
    return {folder for text in texts if given in text for folder in re.findall(r"(?<=[ \"])/[\w/-]+", text)}


def writable(service: dict[str, object]) -> set[str]:
    """Where the volumes that a service may write are mounted."""
    mounts = [str(mount) for mount in service.get("volumes", [])]  # type: ignore[attr-defined]
    return {mount.split(":")[1] for mount in mounts if not mount.endswith(":ro")}


def test_every_service_has_an_image_and_every_image_a_service() -> None:
    built = {ROOT / service["build"]["dockerfile"] for service in SERVICES.values()}
    assert built == set(DOCKERFILES)


@pytest.mark.parametrize("path", DOCKERFILES, ids=lambda path: path.stem)
def test_an_image_has_one_known_base_and_no_build_tools(path: Path) -> None:
    lines = instructions(path)
    assert [line for line in lines if line.startswith("FROM")] == [BASE]
    assert not any(line.startswith("ADD") for line in lines)
    for line in lines:
        assert not (line.startswith("RUN") and BUILD_TOOLS.search(line)), line
        if "apt-get install" in line:
            assert "--no-install-recommends" in line
            assert "rm -rf /var/lib/apt/lists/*" in line
        if "pip install" in line:
            assert "--no-cache-dir" in line
            assert "--constraint constraints.txt" in line
    assert not SECRETS.search(path.read_text(encoding="utf-8"))


@pytest.mark.parametrize("path", DOCKERFILES, ids=lambda path: path.stem)
def test_an_image_runs_as_a_user_of_its_own_who_owns_no_code(path: Path) -> None:
    lines = instructions(path)
    users = [line for line in lines if line.startswith("USER")]
    assert users == ["USER topnav"]
    assert any("useradd --system --uid 10001 --gid 10001 topnav" in line for line in lines)
    after = lines[lines.index("USER topnav") + 1 :]
    assert all(line.startswith("ENV") for line in after), after
    assert not any("--chown" in line or "chmod" in line for line in lines)


@pytest.mark.parametrize("path", DOCKERFILES, ids=lambda path: path.stem)
def test_nothing_is_written_outside_volumes_and_the_tmpfs(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert "HOME=/tmp" in text
    assert "PYTHONDONTWRITEBYTECODE=1" in text
    owned = {folder for line in instructions(path) for folder in given_folders(line)}
    for name, service in SERVICES.items():
        if service["build"]["dockerfile"] == str(path.relative_to(ROOT)):
            assert writable(service) <= owned, f"{name}: its image must give these folders to its user"


@pytest.mark.parametrize("name", SERVICES)
def test_a_container_can_write_and_do_next_to_nothing(name: str) -> None:
    service = SERVICES[name]
    assert service["read_only"] is True
    assert service["cap_drop"] == ["ALL"]
    assert "no-new-privileges:true" in service["security_opt"]
    assert service["tmpfs"] == ["/tmp"]
    for unwanted in ("privileged", "cap_add", "devices", "user", "pid", "ipc", "userns_mode", "volumes_from"):
        assert unwanted not in service
    assert service.get("network_mode", "none") == "none"
    mounts = [interpolate(mount, {}).split(":") for mount in service.get("volumes", [])]
    assert all(re.fullmatch(r"[\w-]+", mount[0]) for mount in mounts), "named volumes only, unless asked"
    assert [mount[2] for mount in mounts if mount[0] == "files"] in ([], ["ro"])


@pytest.mark.parametrize("name", SERVICES)
def test_a_container_is_bounded_and_watched(name: str) -> None:
    service = SERVICES[name]
    assert re.fullmatch(r"\d+[mg]", service["mem_limit"])
    assert 0 < service["pids_limit"] <= 1024
    assert "restart" in service
    if service["restart"] != "no":  # one that ends by itself has nothing to watch
        assert service["healthcheck"]["test"][0] == "CMD"


@pytest.mark.parametrize("name", ["map-store", "features"])
def test_large_temporary_files_are_kept_on_the_volume(name: str) -> None:
    """A tmpfs is memory: in /tmp an archive of 4 GB would end the map store, a large map the features."""
    text = (ROOT / f"deploy/docker/{name}.Dockerfile").read_text(encoding="utf-8")
    folder = re.search(r"TMPDIR=(\S+)", text)
    assert folder is not None
    assert folder[1] in writable(SERVICES[name])


@pytest.mark.parametrize("path", DOCKERFILES, ids=lambda path: path.stem)
def test_the_core_is_one_layer_for_all_and_no_page_is_part_of_an_image(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert CORE in [" ".join(line.split()) for line in instructions(path)]
    assert "COPY pyproject.toml constraints.txt LICENSE ./" in text
    assert "compileall" in text, "nothing can be compiled at run time"


def test_no_image_of_a_stranger_is_taken_for_ours() -> None:
    assert {service["pull_policy"] for service in SERVICES.values()} == {"build"}


def test_all_health_checks_together_take_a_twentieth_of_a_core() -> None:
    """One takes 0.07 s of processor time (`tests/unit/shared/test_health.py`)."""
    beside = ("camera", "ros", "foxglove", "signs", "fleet")  # they replace the simulator, or are asked for
    together = {name: one for name, one in SERVICES.items() if name not in beside}
    checks = [service["healthcheck"] for service in together.values() if "healthcheck" in service]
    assert sum(0.07 / float(check["interval"].removesuffix("s")) for check in checks) <= 0.05
    assert all(check["start_interval"] == "1s" for check in checks), "and a start is noticed at once"


def test_only_what_images_copy_reaches_the_builder() -> None:
    lines = (ROOT / ".dockerignore").read_text(encoding="utf-8").splitlines()
    rules = [line for line in lines if line and not line.startswith("#")]
    assert rules[0] == "*"
    allowed = {rule[1:] for rule in rules if rule.startswith("!")}
    copied = {
        source
        for path in DOCKERFILES
        for line in instructions(path)
        if line.startswith("COPY")
        for source in line.split()[1:-1]
    }
    assert all(any(one == rule or one.startswith(rule + "/") for rule in allowed) for one in copied)
    assert not allowed & {".git", ".env", "tests", "runs", "data", "experiments"}
    assert "**/__pycache__" in rules
