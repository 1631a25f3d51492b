"""docker-compose.yml: valid, the same for Docker and for the launcher, and in step with the services."""

import importlib
import importlib.util
import json
import os
import re
import sys

import pytest
import yaml
from jsonschema import Draft201909Validator

from services.launcher.compose.compose_file import COMPOSE_FILE, load_compose
from services.launcher.compose.interpolate import interpolate_tree
from services.launcher.compose.local import LocalMachine, local_process
from services.launcher.processes.stack_settings import Ports, StackSettings
from shared.certificates.holders import AUTHORITY, everyone
from tests.contract import service_settings
from tests.contract.service_settings import MODULES, settings_class

RAW = yaml.safe_load(COMPOSE_FILE.read_text(encoding="utf-8"))
TOKENS = yaml.safe_load(COMPOSE_FILE.with_name("deploy").joinpath("compose.tokens.yml").read_text("utf-8"))
EVERYTHING = RAW["services"]
SERVICES = {name: service for name, service in EVERYTHING.items() if service.get("profiles") != ["secure"]}
VARIABLE = re.compile(r"\$\{(\w+)")


@pytest.fixture
def schema(repository):
    text = (repository / "tests/contract/vendor/compose-spec.json").read_text(encoding="utf-8")
    schema = json.loads(text)
    # Docker Compose 2.20 brought `required`, which the published package of the schema does not have yet.
    depends_on = schema["definitions"]["service"]["properties"]["depends_on"]["oneOf"][1]
    (need,) = depends_on["patternProperties"].values()
    need["properties"]["required"] = {"type": "boolean"}
    # The same of 2.21 and `start_interval`.
    schema["definitions"]["healthcheck"]["properties"]["start_interval"] = {"type": "string"}
    return schema


@pytest.fixture
def stack(tmp_path):
    return StackSettings(
        tmp_path,
        world="apartment",
        lockstep=True,
        seed=5,
        ports=Ports(17447, 18000, 18001),
        camera="osc://192.168.1.1",
        ros="deploy/robots/omni.yaml",
        foxglove=18765,
        fleet=True,
    )


@pytest.fixture
def specs(stack):
    services = load_compose(COMPOSE_FILE, stack.variables({})).services
    machine = LocalMachine(sys.executable, stack.data_dir)
    return {name: local_process(name, services[name], services, machine) for name in SERVICES}


def test_the_file_follows_the_compose_specification(schema):
    errors = [
        f"{error.json_path}: {error.message}" for error in Draft201909Validator(schema).iter_errors(RAW)
    ]
    assert errors == []


def test_the_overlay_with_tokens_gives_the_gateway_a_folder_to_read_and_nothing_else(schema):
    assert list(Draft201909Validator(schema).iter_errors(TOKENS)) == []
    ((name, gateway),) = TOKENS["services"].items()
    assert (name, gateway.keys()) == ("gateway", {"environment", "volumes"})
    (mount,) = gateway["volumes"]
    source, target, mode = interpolate_tree(mount, {"TOPNAV_TOKENS_DIR": "./tokens"}).split(":")
    assert (source, mode) == ("./tokens", "ro")
    ((variable, file),) = gateway["environment"].items()
    assert file == f"{target}/tokens.json"
    assert variable in SERVICES["gateway"]["environment"], (
        "it takes the place of a path that no container has"
    )
    with pytest.raises(ValueError, match="TOPNAV_TOKENS_DIR"):
        interpolate_tree(mount, {})


def test_the_schema_would_notice_a_misspelt_key(schema):
    broken = {"services": {"a": {"command": ["x"], "enviroment": {}}}}
    assert not Draft201909Validator(schema).is_valid(broken)


def test_every_process_of_the_architecture_is_there():
    assert set(SERVICES) == {
        "router", "map-store", "simulator", "camera", "ros", "features", "signs", "planner", "drive",
        "dispatch", "fleet", "gateway", "foxglove",
    }  # fmt: skip


@pytest.mark.parametrize("name", SERVICES)
def test_docker_and_the_launcher_start_the_same_command(name, specs):
    assert specs[name].command == (sys.executable, *SERVICES[name]["command"][1:])
    assert SERVICES[name]["command"][0] == "python"


@pytest.mark.parametrize("name", SERVICES)
def test_docker_and_the_launcher_give_the_same_environment_up_to_host_names_and_volumes(name, specs, stack):
    ours = dict(specs[name].environment)
    dockers = interpolate_tree(SERVICES[name]["environment"], stack.variables({}))
    assert ours.keys() == dockers.keys()
    assert ours.pop("TOPNAV_CERTS") == ""  # filled by nobody without --secure
    assert dockers.pop("TOPNAV_CERTS") == "/run/topnav/certs"
    for key, value in dockers.items():
        local = re.sub(
            r"//map-store:|tcp/router:", lambda m: m[0][:4].replace("//ma", "//") + "127.0.0.1:", value
        )
        local = local.replace("/var/lib/topnav", str(stack.data_dir))
        assert ours[key] == local, key


@pytest.mark.parametrize("name", SERVICES)
def test_the_launcher_watches_the_token_that_dockers_health_check_asks_for(name, specs):
    test = SERVICES[name]["healthcheck"]["test"]
    assert test[:4] == ["CMD", "python", "-m", "shared.health"]
    assert specs[name].alive_as == test[4] == name.replace("-", "_")
    assert importlib.util.find_spec("shared.health")


@pytest.mark.parametrize("name", SERVICES)
def test_each_command_names_a_module_that_is_there(name):
    module = SERVICES[name]["command"][2]
    spec = importlib.util.find_spec(module)
    assert spec is not None
    if spec.submodule_search_locations is not None:
        assert importlib.util.find_spec(f"{module}.__main__") is not None


@pytest.mark.parametrize("name", MODULES)
def test_every_variable_of_a_service_is_one_of_its_settings(name, specs, monkeypatch):
    kind = settings_class(name)
    for variable in [v for v in os.environ if v.startswith(kind.model_config["env_prefix"])]:
        monkeypatch.delenv(variable)
    for variable, value in specs[name].environment.items():
        monkeypatch.setenv(variable, value)
    settings = kind.from_environment()
    assert settings.endpoint == "tcp/127.0.0.1:17447"


def test_every_other_setting_reaches_its_container_where_somebody_sets_it():
    assert service_settings.FILE.read_text(encoding="utf-8") == service_settings.text(), (
        "write it anew: python -m tests.contract.service_settings"
    )
    passing = yaml.safe_load(service_settings.FILE.read_text(encoding="utf-8"))["services"]
    for name in passing:
        assert SERVICES[name]["extends"] == {"file": "deploy/compose.settings.yml", "service": name}


def test_certificates_and_what_is_real_belong_to_profiles_and_no_service_needs_the_certificates():
    assert {name: s["profiles"] for name, s in EVERYTHING.items() if "profiles" in s} == {
        "certs": ["secure"],
        "camera": ["camera"],
        "ros": ["ros"],
        "foxglove": ["foxglove"],
        "signs": ["signs"],
        "fleet": ["fleet"],
    }
    for name, service in SERVICES.items():
        need = service["depends_on"]["certs"]
        assert need == {"condition": "service_completed_successfully", "required": False}, name


def test_each_service_mounts_its_own_certificate_only_and_nobody_the_authority():
    filled = dict(volume.split(":") for volume in EVERYTHING["certs"]["volumes"])
    assert set(filled) >= {f"certs-{name}" for name in SERVICES}
    holders = {holder.name for holder in everyone("r1")} | {AUTHORITY}
    assert set(filled.values()) == {f"/certs/{name}" for name in holders}
    for name, service in SERVICES.items():
        mounted = [volume for volume in service["volumes"] if volume.startswith("certs-")]
        assert mounted == [f"certs-{name}:/run/topnav/certs:ro"]
        assert filled[f"certs-{name}"] == f"/certs/{name.replace('-', '_')}"


def test_the_certificates_are_made_without_network_by_the_user_of_the_services(repository):
    assert EVERYTHING["certs"]["network_mode"] == "none"
    text = (repository / EVERYTHING["certs"]["build"]["dockerfile"]).read_text(encoding="utf-8")
    made = re.search(r"for one in ([^;]+); do", text.replace("\\\n", " "))
    assert made is not None
    assert set(made[1].split()) == {holder.name for holder in everyone("r1")} | {AUTHORITY}
    assert "COPY shared shared" in text
    for name, service in EVERYTHING.items():
        file = (repository / service["build"]["dockerfile"]).read_text(encoding="utf-8")
        assert "--uid 10001" in file, name


@pytest.mark.parametrize("name", EVERYTHING)
def test_every_container_is_bounded_and_has_no_more_rights_than_it_needs(name):
    service = EVERYTHING[name]
    assert service["mem_limit"]
    assert service["pids_limit"] <= 512
    assert "cpus" in service or service["cpu_shares"] < 1024
    assert service["read_only"] is True
    assert service["cap_drop"] == ["ALL"]
    assert service["security_opt"] == ["no-new-privileges:true"]


def test_a_secured_stack_gives_each_process_its_own_certificate_and_endpoints_that_need_one(tmp_path):
    stack = StackSettings(tmp_path, ports=Ports(17447, 18000, 18001), secure=True)
    services = load_compose(COMPOSE_FILE, stack.variables({})).services
    machine = LocalMachine(sys.executable, tmp_path, stack.certs)
    for name in SERVICES:
        spec = local_process(name, services[name], services, machine)
        assert spec.environment["TOPNAV_CERTS"] == str(tmp_path / "certs" / name.replace("-", "_"))
        assert spec.environment["TOPNAV_ENDPOINT"] == "tls/127.0.0.1:17447"
        assert not [folder for folder in spec.data_folders if "certs" in folder.name]
    assert services["router"].environment["TOPNAV_ROUTER_LISTEN"] == "tls/127.0.0.1:17447"


def test_choices_reach_the_services(specs):
    assert specs["simulator"].environment["SIMULATOR_LOCKSTEP"] == "true"
    assert specs["simulator"].environment["SIMULATOR_SEED"] == "5"
    assert specs["gateway"].environment["GATEWAY_PORT"] == "18000"
    assert specs["gateway"].environment["GATEWAY_MAP_STORE_URL"] == "http://127.0.0.1:18001"
    assert specs["router"].environment["TOPNAV_ROUTER_LISTEN"] == "tcp/127.0.0.1:17447"
    assert specs["foxglove"].environment["FOXGLOVE_LIVE_PORT"] == "18765"
    assert specs["foxglove"].environment["FOXGLOVE_LIVE_HOST"] == "127.0.0.1"


def test_docker_publishes_gateway_and_live_view_only_and_on_loopback_and_needs_nothing_to_start():
    assert [name for name, service in SERVICES.items() if "ports" in service] == ["gateway", "foxglove"]
    assert SERVICES["foxglove"]["ports"][0].startswith("127.0.0.1:"), "it asks for no password"
    assert SERVICES["gateway"]["ports"][0].startswith("${TOPNAV_PUBLISH:-127.0.0.1}:")
    services = load_compose(COMPOSE_FILE, {}).services
    gateway, map_store = services["gateway"].environment, services["map-store"].environment
    assert gateway["GATEWAY_TOKEN"] == map_store["MAP_STORE_TOKEN"] == ""
    assert gateway["GATEWAY_TOKEN_FILE"] == map_store["MAP_STORE_TOKEN_FILE"], "made at the first start"


def test_the_example_means_to_docker_compose_what_it_means_to_the_launcher(repository):
    """Compose takes all that follows a sign of equality, and more of it than python-dotenv does."""
    for line in (repository / ".env.example").read_text(encoding="utf-8").splitlines():
        assert not line or line.startswith("#") or re.fullmatch(r"\w+=[\w.,:/-]*", line), line


@pytest.mark.parametrize("name", ["learned", "gpu"])
def test_networks_are_installed_where_an_overlay_asks_for_them(schema, repository, name):
    overlay = yaml.safe_load((repository / f"deploy/compose.{name}.yml").read_text(encoding="utf-8"))
    assert list(Draft201909Validator(schema).iter_errors(overlay)) == []
    ((service, features),) = overlay["services"].items()
    assert (service, features["build"]["args"]["LEARNED"]) == ("features", "1")
    assert features["image"] != SERVICES["features"]["image"]


def test_the_example_environment_names_what_the_file_reads(repository):
    text = (repository / ".env.example").read_text(encoding="utf-8")
    documented = set(re.findall(r"^#? ?(\w+)=", text, flags=re.MULTILINE))
    read = set(VARIABLE.findall(json.dumps([RAW, TOKENS]))) - {"TOPNAV_BIND", "TOPNAV_DATABASE_URL"}
    assert documented - {"COMPOSE_PROJECT_NAME"} == read


@pytest.mark.parametrize("name", SERVICES)
def test_each_image_installs_one_extra_and_carries_one_services_code(name, repository):
    build = SERVICES[name]["build"]
    text = (repository / build["dockerfile"]).read_text(encoding="utf-8")
    assert "FROM python:3.11-slim-trixie" in text
    extras = {
        "router": [],
        "map-store": ["map-store,postgres"],
        "features": ["features", "learned"],  # the second where it is asked for
    }.get(name, [name])
    assert re.findall(r"\.\[([\w,-]+)\]", text) == extras
    assert "ENTRYPOINT" not in text
    assert "CMD" not in text
    package = "/".join(SERVICES[name]["command"][2].split(".")[:2]).removesuffix("/router")
    assert re.search(rf"^COPY {package} {package}$", text, flags=re.MULTILINE)
    copied = set(re.findall(r"^COPY (services/\w+|simulator) ", text, flags=re.MULTILINE))
    assert copied <= {package}
    for source in re.findall(r"^COPY (.+) \S+$", text, flags=re.MULTILINE):
        assert all((repository / one).exists() for one in source.split())
