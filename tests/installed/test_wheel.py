"""The wheel works in a separate environment."""

import asyncio
import json
import zipfile
from importlib.metadata import version
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.app import create
from dh_grader.bundles import own_wheel

from tests.formats.submissions import POSE, ROWS
from tests.installed.environment import (
    checked,
    environment,
    install,
    other_pythons,
    run,
)

WRONG = {"table": {"rows": [ROWS[0], {**ROWS[1], "alpha": "pi/2"}, *ROWS[2:]]}, "pose": POSE}


@pytest.mark.long
def test_the_program_is_the_installed_one(programs: Path, tmp_path: Path) -> None:
    assert checked(programs / "dh-grader", "--version", cwd=tmp_path).split() == [
        "dh-grader", version("dh-grader"),
    ]  # fmt: skip
    ask = "import dh_grader; print(dh_grader.__file__)"
    file = Path(checked(programs / "python", "-c", ask, cwd=tmp_path).strip())
    assert file.is_relative_to(programs.parent)
    assert file.with_name("py.typed").is_file()


async def posted(body: dict[str, Any]) -> Any:
    """Return the report that the service sends for a request body."""
    transport = httpx.ASGITransport(create())
    async with httpx.AsyncClient(transport=transport, base_url="http://service") as client:
        return (await client.post("/v1/exercises/planar-rrr/grade", json=body)).json()


@pytest.mark.long
def test_a_submission_gets_the_same_points_from_wheel_and_http(
    programs: Path, tmp_path: Path
) -> None:
    (tmp_path / "wrong.json").write_text(json.dumps({"answers": WRONG}), encoding="utf-8")
    options = (
        "grade",
        "wrong.json",
        "--exercise",
        "planar-rrr",
        "--format",
        "json",
        "--pass-mark",
        "1",
    )
    from_wheel = run(programs / "dh-grader", *options, cwd=tmp_path)
    assert from_wheel.returncode == 1, from_wheel.stderr
    [graded] = json.loads(from_wheel.stdout)
    over_http = asyncio.run(posted({"answers": WRONG}))
    assert 0 < graded["report"]["points"] < graded["report"]["max_points"]
    for figure in ("points", "max_points", "score", "version", "grader"):
        assert graded["report"][figure] == over_http[figure]


@pytest.mark.long
def test_the_wheel_holds_the_templates_of_reports_and_pages(programs: Path, tmp_path: Path) -> None:
    (tmp_path / "wrong.json").write_text(json.dumps({"answers": WRONG}), encoding="utf-8")
    options = ("grade", "wrong.json", "--exercise", "planar-rrr", "--format", "html")
    report = run(programs / "dh-grader", *options, cwd=tmp_path)
    assert report.stdout.startswith("<!doctype html>"), report.stderr
    ask = (
        "from dh_grader.web.pages import load_assets; from dh_grader.web.pages import play_page;"
        "from dh_grader.translations import ENGLISH;"
        "print(play_page(load_assets(), ENGLISH).decode())"
    )
    assert "<dh-play>" in checked(programs / "python", "-c", ask, cwd=tmp_path)


@pytest.mark.campaign
def test_every_other_python_installs_and_starts_it(wheel: Path, tmp_path: Path) -> None:
    for i, python in enumerate(other_pythons()):
        programs = environment(tmp_path / f"environment{i}", python)
        install(wheel, programs)
        # Grading needs packages compiled for that Python, which only `make wheel` installs.
        assert "dh-grader" in checked(
            programs / "dh-grader", "--help", cwd=tmp_path, PYTHONDONTWRITEBYTECODE="1"
        )


def contents(wheel: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(wheel) as archive:
        return {
            name: archive.read(name)
            for name in archive.namelist()
            if not name.endswith(("/WHEEL", "/RECORD"))
        }


@pytest.mark.long
def test_the_program_rebuilds_its_own_wheel(wheel: Path, programs: Path, tmp_path: Path) -> None:
    make = (
        "import pathlib, dh_grader.bundles as own; made = own.own_wheel();"
        "pathlib.Path(made.name).write_bytes(made.content)"
    )
    checked(programs / "python", "-c", make, cwd=tmp_path)
    built = contents(wheel)
    assert contents(tmp_path / wheel.name) == built
    # A checkout makes it as well; its metadata may be older than pyproject.toml.
    (tmp_path / "checkout").write_bytes(own_wheel().content)
    from_checkout = contents(tmp_path / "checkout")
    assert from_checkout.keys() == built.keys()
    assert [
        name
        for name, content in built.items()
        if name.startswith("dh_grader/") and from_checkout[name] != content
    ] == []
