"""Check the settings in compose.yaml, and that its containers have minimal rights."""

# If a container engine is installed, its `compose` reads the file. tests/load runs the same
# services without containers (two replicas, PostgreSQL, nginx with the same configuration).

import re
import subprocess
from pathlib import Path
from typing import Any

import pytest
import yaml
from dh_grader.settings import PREFIX, Settings

ROOT = Path(__file__).parent.parent
COMPOSE: dict[str, Any] = yaml.safe_load((ROOT / "compose.yaml").read_text(encoding="utf-8"))
SERVICES: dict[str, dict[str, Any]] = COMPOSE["services"]
REPLICAS = [name for name in SERVICES if name.startswith("grader-")]
each = pytest.mark.parametrize("name", SERVICES)


@each
def test_a_container_runs_without_root_and_writes_only_to_named_volumes(name: str) -> None:
    service = SERVICES[name]
    assert service["read_only"] is True
    assert re.fullmatch(r"[1-9]\d*:[1-9]\d*", service["user"])
    assert service["cap_drop"] == ["ALL"]
    assert service["security_opt"] == ["no-new-privileges:true"]
    assert "privileged" not in service
    volumes = [volume for volume in service.get("volumes", []) if not volume.endswith(":ro")]
    assert volumes == (["attempts:/var/lib/postgresql/data"] if name == "postgres" else [])


@each
def test_a_container_has_a_health_check(name: str) -> None:
    # The image of the service has a check of its own: tests/test_project.py.
    assert "healthcheck" in SERVICES[name] or SERVICES[name]["image"] == "dh-grader"
    for other, wanted in SERVICES[name].get("depends_on", {}).items():
        assert other in SERVICES
        assert wanted == {"condition": "service_healthy"}


def test_every_setting_exists_and_none_of_them_is_secret() -> None:
    assert len(REPLICAS) == 2
    names = [name for replica in REPLICAS for name in SERVICES[replica]["environment"]]
    settings = {f"{PREFIX}{name.upper()}" for name in Settings.model_fields}
    assert {name for name in names if name not in settings} == {"FORWARDED_ALLOW_IPS"}
    values = [
        str(value)
        for service in SERVICES.values()
        for value in service.get("environment", {}).values()
    ]
    assert not [value for value in values if re.search(r"://[^/@]*:[^/@]*@", value)]
    assert not [name for service in SERVICES.values() for name in service.get("environment", {})
                if name.endswith("PASSWORD")]  # fmt: skip


def test_only_the_proxy_publishes_ports_and_it_knows_every_replica() -> None:
    assert [name for name, service in SERVICES.items() if "ports" in service] == ["proxy"]
    assert COMPOSE["networks"]["inside"] == {"internal": True}
    assert {name for name in SERVICES if "outside" in SERVICES[name]["networks"]} == {"proxy"}
    proxy = (ROOT / "deploy" / "nginx.conf").read_text(encoding="utf-8")
    assert re.findall(r"server ([\w-]+):8000;", proxy) == REPLICAS


def test_a_container_engine_accepts_the_file() -> None:
    command = ["docker", "compose", "--file", str(ROOT / "compose.yaml"), "config", "--quiet"]
    try:
        found = subprocess.run(["docker", "compose", "version"], capture_output=True, check=False)
    except OSError:
        pytest.skip("there is no docker here")
    if found.returncode:
        pytest.skip("docker has no compose here")
    read = subprocess.run(command, capture_output=True, text=True, check=False)
    assert read.returncode == 0, read.stderr
