"""deploy/simple and the systemd unit match the service."""

import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
import yaml
from dh_grader.settings import PREFIX, Settings

ROOT = Path(__file__).parents[2]
SIMPLE = ROOT / "deploy" / "simple"
UNIT = ROOT / "deploy" / "dh-grader.service"
COMPOSE: dict[str, Any] = yaml.safe_load((SIMPLE / "compose.yaml").read_text(encoding="utf-8"))
CADDYFILE = (SIMPLE / "Caddyfile").read_text(encoding="utf-8")
GRADER, CADDY = COMPOSE["services"]["grader"], COMPOSE["services"]["caddy"]
KNOWN = {f"{PREFIX}{name.upper()}" for name in Settings.model_fields}


def test_the_two_values_are_those_that_are_filled_in() -> None:
    example = (SIMPLE / "example.env").read_text(encoding="utf-8")
    values = set(re.findall(r"^(\w+)=", example, re.MULTILINE))
    text = (SIMPLE / "compose.yaml").read_text(encoding="utf-8")
    # With `:?`, compose does not start without a value.
    assert values == set(re.findall(r"\$\{(\w+):\?", text)) == {"HOST_NAME", "SECRET"}
    assert text.count("${") == 3


def test_containers_have_no_rights_that_they_do_not_need() -> None:
    for service in (GRADER, CADDY):
        assert service["read_only"] is True
        assert service["cap_drop"] == ["ALL"]
        assert service["security_opt"] == ["no-new-privileges:true"]
    assert "cap_add" not in GRADER
    assert CADDY["cap_add"] == ["NET_BIND_SERVICE"]
    assert "ports" not in GRADER
    assert {volume.partition(":")[0] for volume in (*GRADER["volumes"], *CADDY["volumes"])} == {
        "./Caddyfile", *COMPOSE["volumes"],
    }  # fmt: skip


def test_every_setting_exists() -> None:
    assert GRADER["environment"].keys() - KNOWN == {"FORWARDED_ALLOW_IPS"}
    unit = set(re.findall(r"^Environment=(\w+)=", UNIT.read_text("utf-8"), re.MULTILINE))
    assert unit
    assert unit <= KNOWN


def test_the_database_is_in_a_volume_of_the_user_of_the_image() -> None:
    [volume] = GRADER["volumes"]
    folder = volume.partition(":")[2]
    assert GRADER["environment"]["DH_GRADER_DATABASE"].startswith(f"{folder}/")
    dockerfile = (ROOT / "Dockerfile").read_text(encoding="utf-8")
    [user, group] = re.findall(r"^USER (\d+):(\d+)", dockerfile, re.MULTILINE)[0]
    made = rf"^RUN install --directory --owner={user} --group={group} --mode=0700 {folder}$"
    assert re.search(made, dockerfile, re.MULTILINE)


def test_caddy_leads_to_the_service() -> None:
    assert CADDYFILE.startswith("{$HOST_NAME} {\n")
    port = re.findall(r"EXPOSE (\d+)", (ROOT / "Dockerfile").read_text(encoding="utf-8"))[0]
    assert f"reverse_proxy grader:{port}\n" in CADDYFILE
    assert "respond /metrics 404\n" in CADDYFILE
    # More than the service itself takes, so that its own message arrives.
    assert int(re.findall(r"max_size (\d+)KB", CADDYFILE)[0]) > 256


def test_the_unit_is_confined() -> None:
    systemd = shutil.which("systemd-analyze")
    if systemd is None:
        pytest.skip("there is no systemd here")
    command = [systemd, "security", "--offline=true", "--threshold=20", str(UNIT)]
    checked = subprocess.run(command, capture_output=True, text=True, check=False)
    if "Unknown" in checked.stderr or "unrecognized" in checked.stderr:
        pytest.skip("this systemd has no such check")
    assert checked.returncode == 0, checked.stdout[-500:] + checked.stderr
