"""Reading Compose files."""

import pytest

from services.launcher.compose.compose_file import Dependency, load_compose, seconds_from_duration
from tests.yaml_bomb import BOMB


def write(tmp_path, text):
    path = tmp_path / "docker-compose.yml"
    path.write_text(text, encoding="utf-8")
    return path


def test_both_forms_of_environment_and_dependencies_mean_the_same(tmp_path):
    path = write(
        tmp_path,
        """
services:
  a: {command: [x]}
  b: {command: [y], environment: {N: 1, F: true, S: "${V:-d}"}, depends_on: {a: {condition: service_started}}}
  c: {command: [y], environment: [N=1, F=true, S=d], depends_on: [a]}
""",
    )
    services = load_compose(path, {}).services
    assert services["b"].environment == services["c"].environment == {"N": "1", "F": "true", "S": "d"}
    assert services["b"].depends_on == services["c"].depends_on == {"a": Dependency()}


def test_health_check_durations_become_seconds(tmp_path):
    path = write(
        tmp_path,
        "services: {a: {command: [x], healthcheck: {test: [CMD, y], interval: 1m30s, timeout: 500ms}}}",
    )
    healthcheck = load_compose(path, {}).services["a"].healthcheck
    assert healthcheck is not None
    assert (healthcheck.interval, healthcheck.timeout) == (90.0, 0.5)


@pytest.mark.parametrize("text", ["5", "soon", "5 s", "5s!", "-1s"])
def test_a_bad_duration_is_refused(text):
    with pytest.raises(ValueError, match="a duration looks like"):
        seconds_from_duration(text)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("services: {a: {command: python -m x}}", "must be a list of words"),
        ("services: {a: {command: []}}", "at least 1"),
        ("services: {a: {image: x}}", "command"),
        ("services: {a: {command: [x], depends_on: {b: {condition: service_perfect}}}}", "service_perfect"),
        ("volumes: {}", "key 'services'"),
    ],
)
def test_what_the_launcher_cannot_run_is_refused_with_the_field(tmp_path, text, message):
    with pytest.raises(ValueError, match=message):
        load_compose(write(tmp_path, text), {})


@pytest.mark.parametrize(
    ("text", "told"),
    [
        pytest.param(BOMB, "at most 200000 values", id="references that multiply"),
        pytest.param("a: &a [*a]", "refers to what it is a part of", id="a reference to itself"),
        pytest.param("[" * 100_000, "deep|not valid YAML", id="deep nesting"),
        pytest.param("services: {a: {command: [x]}", "not valid YAML", id="cut short"),
        pytest.param("a: !!python/object/apply:os.getcwd []", "not valid YAML", id="code"),
        pytest.param("services: {a: {}, a: {}}", "is there twice", id="a service twice"),
        pytest.param("x" * 2_100_000, "at most 2000000 bytes", id="too long"),
        pytest.param("services: {a: {command: [x], depends_on: [[b]]}}", "depends_on", id="a list as name"),
    ],
)
def test_traps_of_yaml_are_refused_and_name_the_file_or_the_field(tmp_path, text, told):
    with pytest.raises(ValueError, match=told):
        load_compose(write(tmp_path, text), {})
