"""deploy/k8s: valid by the schemas of Kubernetes, closed, and the same processes as docker-compose.yml.

The files are checked as they are; where kubectl is installed both overlays are put together as well, without
a cluster, and checked once more.
"""

import os
import re
import shutil
import subprocess
from pathlib import Path

import kubernetes_validate
import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "deploy/k8s"
COMPOSE = yaml.safe_load((ROOT / "docker-compose.yml").read_text(encoding="utf-8"))["services"]
SERVICES = {"router", "map-store", "features", "planner", "drive", "dispatch", "fleet", "gateway"}
VERSIONS = ("1.29", "1.33")
"""Of Kubernetes: an old one that is still met, and one of those in service."""
OVERLAYS = ("open", "secure")
ELSEWHERE = {"SIMULATOR", "TOPNAV_ROBOT", "TOPNAV_ROBOTS", "TOPNAV_CERTS"}
"""Variables that an overlay or the API gives, where Compose writes a value."""
NOT_SET = {
    "DRIVE_SEED",
    "FEATURES_EXTRACTOR",
    "GATEWAY_TOKENS_FILE",
    "GATEWAY_TOKEN_FILE",
    "MAP_STORE_TOKENS_FILE",
    "MAP_STORE_TOKEN_FILE",
    "PLANNER_MISSIONS_FOLDER",
    "PLANNER_PROFILE_FILE",
    "TOPNAV_DOWNLOAD_WEIGHTS",
    "TOPNAV_NON_COMMERCIAL",
}
"""Empty or chance by default in Compose, or for a secret that nobody chose, which a cluster has: left out."""
MADE_SECRET = "/var/lib/topnav/token"
"""Where Compose keeps that."""


def manifests():
    """Every document that is an object of Kubernetes itself, with the file it stands in."""
    for path in sorted(FOLDER.rglob("*.yaml")):
        if path.name != "kustomization.yaml" and "certificates" not in path.parts:
            for document in yaml.safe_load_all(path.read_text(encoding="utf-8")):
                yield path, document


MANIFESTS = [
    (path, one) for path, one in manifests() if not one["apiVersion"].startswith("postgresql.cnpg.io")
]
DEPLOYMENTS = {one["metadata"]["name"]: one for _, one in MANIFESTS if one["kind"] == "Deployment"}
NAMES = [f"{path.relative_to(FOLDER)}:{one['kind']}/{one['metadata']['name']}" for path, one in MANIFESTS]


def rendered(overlay):
    """The objects of an overlay as kubectl would apply them; it asks no cluster for that."""
    kubectl = shutil.which("kubectl")
    if kubectl is None:
        pytest.skip("kubectl puts the overlays together, and it is not installed")
    done = subprocess.run(
        [kubectl, "kustomize", str(FOLDER / overlay)],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "KUBECONFIG": os.devnull},
    )
    assert done.returncode == 0, done.stderr
    assert "deprecated" not in done.stderr.lower(), done.stderr
    return list(yaml.safe_load_all(done.stdout))


def container(deployment):
    (only,) = deployment["spec"]["template"]["spec"]["containers"]
    return only


def variables(deployment):
    """Value of each variable; None where it comes from somewhere else."""
    return {one["name"]: one.get("value") for one in container(deployment)["env"]}


def pods(deployment):
    return deployment["spec"]["template"]["spec"]


def bytes_of(text):
    number, unit = re.fullmatch(r"(\d+)([mgMG])i?", text).groups()
    return int(number) * {"m": 2**20, "g": 2**30}[unit.lower()]


def cpus_of(text):
    return float(text[:-1]) / 1000 if text.endswith("m") else float(text)


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("document", [one for _, one in MANIFESTS], ids=NAMES)
def test_an_object_follows_the_schema_of_its_kind(document, version):
    kubernetes_validate.validate(document, version, strict=True)


def test_the_schema_would_notice_a_misspelt_key():
    broken = {**DEPLOYMENTS["router"], "spec": {**DEPLOYMENTS["router"]["spec"], "replicsa": 2}}
    with pytest.raises(kubernetes_validate.ValidationError):
        kubernetes_validate.validate(broken, VERSIONS[0], strict=True)


def test_every_file_is_a_resource_or_a_patch_of_its_folder():
    for path in sorted(FOLDER.rglob("kustomization.yaml")):
        found = yaml.safe_load(path.read_text(encoding="utf-8"))
        named = [*found.get("resources", []), *found.get("components", [])]
        named += [patch["path"] for patch in found.get("patches", []) if "path" in patch]
        for name in named:
            assert (path.parent / name).exists(), f"{path}: {name}"
        files = {one.name for one in path.parent.glob("*.yaml")} - {"kustomization.yaml"}
        assert files <= set(named), path


def test_all_processes_but_those_that_are_with_the_robot_are_there():
    with_the_robot = {"simulator", "camera", "ros", "signs", "foxglove"}
    assert set(DEPLOYMENTS) == SERVICES == set(COMPOSE) - with_the_robot - {"certs"}


@pytest.mark.parametrize("name", sorted(SERVICES))
def test_image_command_health_and_variables_are_those_of_the_compose_file(name):
    ours, theirs = container(DEPLOYMENTS[name]), COMPOSE[name]
    assert ours["image"] == theirs["image"]
    assert ours["command"] == theirs["command"]
    health = theirs["healthcheck"]["test"][1:]
    assert ours["livenessProbe"]["exec"]["command"] == ours["startupProbe"]["exec"]["command"] == health
    asked = name in {one["metadata"]["name"] for _, one in MANIFESTS if one["kind"] == "Service"}
    assert ("readinessProbe" in ours) == asked  # a Service sends nobody to a pod that is not ready
    wanted = set(theirs["environment"]) - NOT_SET - ELSEWHERE
    assert set(variables(DEPLOYMENTS[name])) - ELSEWHERE == wanted


@pytest.mark.parametrize("name", sorted(SERVICES))
def test_limits_are_those_of_the_compose_file_and_requests_are_below(name):
    limits, requests = (container(DEPLOYMENTS[name])["resources"][kind] for kind in ("limits", "requests"))
    assert bytes_of(limits["memory"]) == bytes_of(COMPOSE[name]["mem_limit"])
    if "cpus" in COMPOSE[name]:
        assert cpus_of(limits["cpu"]) == COMPOSE[name]["cpus"]
    assert bytes_of(requests["memory"]) <= bytes_of(limits["memory"])
    assert 0 < cpus_of(requests["cpu"]) <= cpus_of(limits["cpu"])


@pytest.mark.parametrize("name", sorted(SERVICES))
def test_a_pod_can_do_next_to_nothing(name, repository):
    pod, box = pods(DEPLOYMENTS[name]), container(DEPLOYMENTS[name])
    assert pod["securityContext"] == {
        "runAsNonRoot": True,
        "runAsUser": 10001,
        "runAsGroup": 10001,
        "fsGroup": 10001,
        "seccompProfile": {"type": "RuntimeDefault"},
    }
    assert box["securityContext"] == {
        "allowPrivilegeEscalation": False,
        "readOnlyRootFilesystem": True,
        "capabilities": {"drop": ["ALL"]},
    }
    assert pod["automountServiceAccountToken"] is False
    for unwanted in ("hostNetwork", "hostPID", "hostIPC", "initContainers"):
        assert unwanted not in pod
    assert not any("hostPath" in volume for volume in pod["volumes"])
    dockerfile = (repository / COMPOSE[name]["build"]["dockerfile"]).read_text(encoding="utf-8")
    assert f"--uid {pod['securityContext']['runAsUser']} " in dockerfile


@pytest.mark.parametrize("name", sorted(SERVICES))
def test_kubernetes_adds_no_variables_that_look_like_settings(name):
    """For a Service map-store it would set MAP_STORE_PORT=tcp://..., and the map store would not start."""
    assert pods(DEPLOYMENTS[name])["enableServiceLinks"] is False


@pytest.mark.parametrize("name", sorted(SERVICES))
def test_what_is_written_outlives_a_container_where_it_does_in_compose(name):
    pod = pods(DEPLOYMENTS[name])
    mounted = {mount["mountPath"] for mount in container(DEPLOYMENTS[name])["volumeMounts"]}
    volumes = [mount.split(":")[1] for mount in COMPOSE[name].get("volumes", []) if not mount.endswith(":ro")]
    assert mounted == {"/tmp", *volumes} - {MADE_SECRET}
    assert {mount["name"] for mount in container(DEPLOYMENTS[name])["volumeMounts"]} == {
        volume["name"] for volume in pod["volumes"]
    }
    claims = [volume["persistentVolumeClaim"]["claimName"] for volume in pod["volumes"] if len(volume) == 2
              and "persistentVolumeClaim" in volume]  # fmt: skip
    assert claims == {"drive": ["drive-state"], "gateway": ["runs"]}.get(name, [])


def test_one_robot_has_one_planner_and_one_drive_also_while_they_are_replaced():
    for name in ("planner", "drive", "features"):
        assert DEPLOYMENTS[name]["spec"]["replicas"] == 1
        assert DEPLOYMENTS[name]["spec"]["strategy"] == {"type": "Recreate"}


def test_services_lead_to_the_ports_that_the_processes_are_told_to_serve():
    services = {one["metadata"]["name"]: one for _, one in MANIFESTS if one["kind"] == "Service"}
    ports = {name: service["spec"]["ports"][0]["port"] for name, service in services.items()}
    assert variables(DEPLOYMENTS["router"])["TOPNAV_ROUTER_LISTEN"] == f"tcp/0.0.0.0:{ports['router']}"
    assert variables(DEPLOYMENTS["map-store"])["MAP_STORE_PORT"] == str(ports["map-store"])
    assert variables(DEPLOYMENTS["gateway"])["GATEWAY_PORT"] == str(ports["gateway"])
    assert (
        variables(DEPLOYMENTS["gateway"])["GATEWAY_MAP_STORE_URL"] == f"http://map-store:{ports['map-store']}"
    )
    for name, service in services.items():
        assert service["spec"]["selector"] == DEPLOYMENTS[name]["spec"]["selector"]["matchLabels"]
        assert container(DEPLOYMENTS[name])["ports"][0]["containerPort"] == ports[name]
    for name, deployment in DEPLOYMENTS.items():
        assert variables(deployment)["TOPNAV_ENDPOINT"] == f"tcp/{router_host(name)}:{ports['router']}"


def router_host(name):
    """Where a pod finds the router: itself by loopback, as its Service leads nowhere until it is ready."""
    return "127.0.0.1" if name == "router" else "router"


def test_no_secret_is_kept_here_and_secrets_come_from_secrets():
    for path in FOLDER.rglob("*.yaml"):
        text = path.read_text(encoding="utf-8")
        assert "kind: Secret" not in text
        assert not re.search(r"secretGenerator|PRIVATE KEY|postgres(ql)?://\w+:", text)
    for deployment in DEPLOYMENTS.values():
        for variable in container(deployment)["env"]:
            if re.search(r"TOKEN|DATABASE_URL", variable["name"]):
                assert set(variable) == {"name", "valueFrom"}
                assert set(variable["valueFrom"]) == {"secretKeyRef"}


@pytest.mark.parametrize("overlay", OVERLAYS)
def test_an_overlay_is_put_together_from_valid_objects_with_names_of_their_own(overlay):
    objects = rendered(overlay)
    names = [(one["kind"], one["metadata"]["name"]) for one in objects]
    assert len(set(names)) == len(names)
    for one in objects:
        kubernetes_validate.validate(one, VERSIONS[0], strict=True)
        assert one["kind"] == "Namespace" or one["metadata"]["namespace"] == "topnav"
    claims = {one["metadata"]["name"] for one in objects if one["kind"] == "PersistentVolumeClaim"}
    used = {
        volume["persistentVolumeClaim"]["claimName"]
        for one in objects if one["kind"] == "Deployment"
        for volume in pods(one)["volumes"] if "persistentVolumeClaim" in volume
    }  # fmt: skip
    assert used == claims


@pytest.mark.parametrize("overlay", OVERLAYS)
def test_every_robot_of_an_overlay_has_a_planner_a_drive_and_one_feature_service(overlay):
    deployments = [one for one in rendered(overlay) if one["kind"] == "Deployment"]

    def of(name):
        return [one for one in deployments if container(one)["image"] == COMPOSE[name]["image"]]

    def robots(name):
        found = [one["spec"]["template"]["metadata"]["labels"]["topnav.dev/robot"] for one in of(name)]
        for one, robot in zip(of(name), found, strict=True):
            assert one["spec"]["selector"]["matchLabels"]["topnav.dev/robot"] == robot
        return sorted(found)

    shards = [
        one["spec"]["template"]["metadata"]["annotations"]["topnav.dev/robots"] for one in of("features")
    ]
    assert sorted(",".join(shards).split(",")) == robots("planner") == robots("drive") == ["r1", "r2"]
    selectors = [tuple(sorted(one["spec"]["selector"]["matchLabels"].items())) for one in deployments]
    assert len(set(selectors)) == len(deployments)


def test_on_the_secured_bus_every_pod_has_a_certificate_and_only_its_own():
    objects = rendered("secure")
    deployments = [one for one in objects if one["kind"] == "Deployment"]
    secrets = []
    for one in deployments:
        assert variables(one)["TOPNAV_ENDPOINT"] == f"tls/{router_host(one['metadata']['name'])}:7447"
        (mount,) = [m for m in container(one)["volumeMounts"] if m["name"] == "certs"]
        assert mount == {"name": "certs", "mountPath": variables(one)["TOPNAV_CERTS"], "readOnly": True}
        (secret,) = [v["secret"] for v in pods(one)["volumes"] if v["name"] == "certs"]
        assert secret["defaultMode"] == 0o440
        labels = one["spec"]["template"]["metadata"]["labels"]
        robot = labels.get("topnav.dev/robot")
        wanted = f"certs-{labels['app.kubernetes.io/name']}" + (f".{robot}" if robot else "")
        assert secret["secretName"] == wanted
        secrets.append(secret["secretName"])
    assert len(set(secrets)) == len(deployments)
    (router,) = [one for one in deployments if one["metadata"]["name"] == "router"]
    assert variables(router)["TOPNAV_ROUTER_LISTEN"] == "tls/0.0.0.0:7447"
    assert variables(router)["TOPNAV_ROBOTS"] == "r1,r2"


def test_on_the_open_bus_nobody_outside_reaches_the_router():
    (service,) = [o for o in rendered("open") if o["kind"] == "Service" and o["metadata"]["name"] == "router"]
    assert "type" not in service["spec"]


def test_nothing_is_reached_that_no_policy_names():
    policies = {one["metadata"]["name"]: one["spec"] for path, one in MANIFESTS
                if one["kind"] == "NetworkPolicy" and path.parent.name == "base"}  # fmt: skip
    assert policies["deny"] == {"podSelector": {}, "policyTypes": ["Ingress", "Egress"]}
    open_ended = [
        name for name, spec in policies.items() for rule in spec.get("ingress", []) if "from" not in rule
    ]
    assert open_ended == []


def test_the_page_makes_every_secret_that_is_asked_for():
    page = (FOLDER / "README.md").read_text(encoding="utf-8")
    text = "".join(path.read_text(encoding="utf-8") for path in FOLDER.rglob("*.yaml"))
    asked = set(re.findall(r"secretKeyRef: {name: ([\w-]+)|secretName: ([\w.-]+)", text))
    for name in {one or other for one, other in asked}:
        robot = name.partition(".")[2] or "none"
        assert (
            f"secret generic {name} " in page
            or f"secret {name} " in page
            or f"secret certs-$s.{robot}" in page
        )
    robots = set(re.findall(r"secretName: certs-\w+\.(\w+)", text))
    assert robots == {"r1", "r2"}
