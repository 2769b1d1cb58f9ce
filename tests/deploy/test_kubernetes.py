"""The Kubernetes manifests match their schemas, the settings and the image."""

# If kubectl is installed, it builds the overlays as well. The tests need no cluster.

import re
import shutil
import subprocess
import tomllib
from pathlib import Path
from typing import Any

import kubernetes_validate
import pytest
import yaml
from dh_grader.cli import program
from dh_grader.cli.running import shard_of
from dh_grader.settings import PREFIX, Settings
from typer.testing import CliRunner

from tests.deploy.manifests import FILES as ALL_FILES
from tests.deploy.manifests import FOLDER, OVERLAYS, ROOT, documents, objects, pods, the

# The oldest and the newest version for which there is a schema and all kinds exist.
VERSIONS = ("1.31", "1.37")
MANIFESTS = [file for file in ALL_FILES if file.name != "kustomization.yaml"]
PODS = dict(pods())
IMAGE = (ROOT / "Dockerfile").read_text(encoding="utf-8").rpartition("\nFROM ")[2]
each_pod = pytest.mark.parametrize("name", PODS)


def container(name: str) -> dict[str, Any]:
    [found] = PODS[name]["spec"]["containers"]
    return dict(found)


def check(document: dict[str, Any]) -> None:
    for version in VERSIONS:
        kubernetes_validate.validate(document, version, strict=True)


@pytest.mark.parametrize("file", MANIFESTS, ids=lambda file: file.relative_to(FOLDER).as_posix())
def test_a_manifest_fits_the_schemas(file: Path) -> None:
    found = documents(file)
    assert found
    for document in found:
        check(document)


def test_the_schemas_refuse_a_misspelt_key() -> None:
    deployment = the("Deployment")
    deployment["spec"]["replica"] = 2
    with pytest.raises(kubernetes_validate.ValidationError):
        check(deployment)


@pytest.mark.sampled(3)
@pytest.mark.parametrize("overlay", OVERLAYS, ids=lambda overlay: overlay.name)
def test_kubectl_builds_an_overlay(overlay: Path) -> None:
    kubectl = shutil.which("kubectl")
    if kubectl is None:
        pytest.skip("there is no kubectl here")
    command = [kubectl, "kustomize", str(overlay)]
    built = subprocess.run(command, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr
    found = list(yaml.safe_load_all(built.stdout))
    kinds = [each["kind"] for each in found]
    assert ("PodDisruptionBudget" in kinds) is (overlay.name == "replicated")
    assert ("HorizontalPodAutoscaler" in kinds) is (overlay.name == "replicated")
    for document in found:
        check(document)
        assert overlay.name == "base" or document["metadata"]["namespace"] == "dh-grader"


def test_an_overlay_lists_files_that_exist_and_leaves_none_out() -> None:
    listed = set()
    for overlay in OVERLAYS:
        [content] = documents(overlay / "kustomization.yaml")
        for resource in content["resources"]:
            target = (overlay / resource).resolve()
            listed.add(target)
            assert target.is_file() or (target / "kustomization.yaml").is_file(), resource
    assert set(MANIFESTS) - listed == set()


def test_overlays_take_the_image_of_this_version() -> None:
    version = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["version"]
    for overlay in OVERLAYS:
        [content] = documents(overlay / "kustomization.yaml")
        if overlay.name != "base":
            [image] = content["images"]
            assert (image["name"], str(image["newTag"])) == ("dh-grader", version)


@each_pod
def test_a_pod_has_no_rights_that_it_does_not_need(name: str) -> None:
    pod = PODS[name]["spec"]
    [user] = re.findall(r"^USER (\d+):", IMAGE, re.MULTILINE)
    context = pod["securityContext"]
    assert context["runAsNonRoot"] is True
    assert context["runAsUser"] == context["runAsGroup"] == int(user) > 0
    assert context["seccompProfile"] == {"type": "RuntimeDefault"}
    assert pod["automountServiceAccountToken"] is False
    assert not {"hostNetwork", "hostPID", "hostIPC"} & pod.keys()
    assert container(name)["securityContext"] == {
        "readOnlyRootFilesystem": True,
        "allowPrivilegeEscalation": False,
        "capabilities": {"drop": ["ALL"]},
    }
    assert not [volume for volume in pod["volumes"] if "hostPath" in volume]
    assert {"mountPath": "/tmp", "name": "tmp"} in container(name)["volumeMounts"]
    assert "memory" in container(name)["resources"]["limits"]


def test_every_setting_exists_and_none_of_them_is_secret() -> None:
    known = {f"{PREFIX}{name.upper()}" for name in Settings.model_fields}
    config = the("ConfigMap")["data"]
    variables = [variable for name in PODS for variable in container(name).get("env", [])]
    patched = re.findall(r"/data/(\w+)", (FOLDER / "replicated/kustomization.yaml").read_text())
    assert patched
    names = {*config, *patched, *(variable["name"] for variable in variables)}
    assert names - known == {"FORWARDED_ALLOW_IPS"}
    secret = {"DH_GRADER_DATABASE", "DH_GRADER_SECRET", "DH_GRADER_KEY"}
    assert not secret & {*config, *patched}
    assert all("secretKeyRef" in variable["valueFrom"] for variable in variables)
    Settings(**{
        key.removeprefix(PREFIX).lower(): value
        for key, value in config.items() if key.startswith(PREFIX)
    })  # fmt: skip


def test_ports_and_labels_lead_from_the_ingress_to_the_image() -> None:
    [port] = container("grader")["ports"]
    assert f"EXPOSE {port['containerPort']}" in IMAGE
    assert f"DH_GRADER_PORT={port['containerPort']}" in IMAGE
    service = the("Service")["spec"]
    assert [each["targetPort"] for each in service["ports"]] == [port["name"]]
    labels = PODS["grader"]["metadata"]["labels"]
    deployment = the("Deployment")["spec"]
    budget, scaler = the("PodDisruptionBudget")["spec"], the("HorizontalPodAutoscaler")["spec"]
    assert service["selector"] == labels == deployment["selector"]["matchLabels"]
    assert budget["selector"]["matchLabels"] == labels
    assert scaler["scaleTargetRef"]["name"] == the("Deployment")["metadata"]["name"]
    [rule] = the("Ingress")["spec"]["rules"]
    backends = {path["path"]: path["backend"]["service"] for path in rule["http"]["paths"]}
    assert backends["/"] == {"name": "grader", "port": {"name": "http"}}
    # Services with a selector have replicas.
    assert "selector" not in the("Service", backends["/metrics"]["name"])["spec"]
    policy = the("NetworkPolicy")["spec"]
    assert policy["policyTypes"] == ["Ingress", "Egress"]
    [ingress] = policy["ingress"]
    assert ingress["ports"] == [{"protocol": "TCP", "port": port["containerPort"]}]
    [selected] = policy["podSelector"]["matchExpressions"]
    names = {pod["metadata"]["labels"]["app.kubernetes.io/name"] for pod in PODS.values()}
    assert set(selected["values"]) == names


def test_probes_have_different_values_and_do_not_ask_the_database() -> None:
    probes = [container("grader")[f"{kind}Probe"] for kind in ("startup", "readiness", "liveness")]
    assert all(probe["httpGet"] == {"path": "/healthz", "port": "http"} for probe in probes)
    seconds = [probe["periodSeconds"] * probe["failureThreshold"] for probe in probes]
    startup, readiness, liveness = seconds
    # A replica leaves the service long before it is killed.
    assert readiness < startup
    assert 5 * readiness < liveness


def test_a_replica_is_replaced_without_downtime() -> None:
    deployment = the("Deployment")["spec"]
    assert deployment["strategy"]["rollingUpdate"] == {"maxSurge": 1, "maxUnavailable": 0}
    [wait] = container("grader")["lifecycle"]["preStop"]["exec"]["command"][1:]
    # The service ends within ten seconds after the signal.
    assert PODS["grader"]["spec"]["terminationGracePeriodSeconds"] >= int(wait) + 10
    assert the("HorizontalPodAutoscaler")["spec"]["minReplicas"] >= 2
    assert the("PodDisruptionBudget")["spec"]["maxUnavailable"] == 1


def test_the_commands_of_jobs_exist() -> None:
    commands = {
        name: [*container(name)["command"], *container(name).get("args", [])]
        for name in PODS
        if name != "grader"
    }
    assert len(commands) == 3
    for name, words in commands.items():
        if words[0] == "sh":
            words = re.sub(r"\\\n", " ", words[-1]).partition("dh-grader ")[2].split()
        else:
            words = words[1:]
        shown = CliRunner().invoke(program, [*words[: 1 + (words[0] == "attempts")], "--help"])
        assert shown.exit_code == 0, name


def test_the_indexed_job_grades_every_shard() -> None:
    [job] = [each for each in objects("Job") if each["spec"].get("completionMode") == "Indexed"]
    [script] = container(job["metadata"]["name"])["args"]
    count = job["spec"]["completions"]
    assert f'--shard "$shard/{count}"' in script
    [offset] = re.findall(r"shard=\$\(\(JOB_COMPLETION_INDEX \+ (\d)\)\)", script)
    assert [shard_of(f"{i + int(offset)}/{count}").number for i in range(count)] == [
        *range(1, count + 1)
    ]
