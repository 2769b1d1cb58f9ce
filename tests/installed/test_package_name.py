"""The wheel has one package, and works beside anything that is called ``service``."""

import json
import zipfile
from pathlib import Path

import pytest

from tests.installed.environment import checked, environment, install, run

TABLE = "a, alpha, d, theta\na1, 0, 0, q1\na2, 0, 0, q2\n"
GRADE = ("grade", "anna.csv", "--exercise", "planar-rr", "--part", "table", "--format", "json")
# What breaks a program that imports `service` by this name.
FOREIGN = "raise ImportError('this is the service of somebody else')\n"
SERVES = """
import asyncio
from dh_grader.app import app

async def ask():
    sent = []
    async def receive():
        return {"type": "http.request", "body": b"", "more_body": False}
    async def send(message):
        sent.append(message)
    scope = {
        "type": "http", "http_version": "1.1", "method": "GET", "path": "/healthz",
        "raw_path": b"/healthz", "query_string": b"", "headers": [(b"host", b"127.0.0.1")],
        "scheme": "http", "server": ("127.0.0.1", 80), "client": ("127.0.0.1", 1),
    }
    await app(scope, receive, send)
    print(sent[0]["status"])

asyncio.run(ask())
"""
FACE = "import dh_grader; print(dh_grader.grade('planar-rr', {}).max_points)"


def other_wheel(folder: Path) -> Path:
    """Return a wheel of another project, whose package is called ``service``."""
    wheel = folder / "service-1.0-py3-none-any.whl"
    info = "service-1.0.dist-info"
    contents = {
        "service/__init__.py": "OWNER = 'somebody else'\n",
        f"{info}/METADATA": "Metadata-Version: 2.1\nName: service\nVersion: 1.0\n",
        f"{info}/WHEEL": "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\n"
        "Tag: py3-none-any\n",
    }
    with zipfile.ZipFile(wheel, "w") as archive:
        for name, text in contents.items():
            archive.writestr(name, text)
        record = "".join(f"{name},,\n" for name in [*contents, f"{info}/RECORD"])
        archive.writestr(f"{info}/RECORD", record)
    return wheel


def grades_and_serves(programs: Path, folder: Path) -> None:
    """Use the command, the module, the service and the face in a folder."""
    (folder / "anna.csv").write_text(TABLE, encoding="utf-8")
    for program in ((programs / "dh-grader",), (programs / "python", "-m", "dh_grader")):
        graded = run(*program, *GRADE, cwd=folder)
        assert graded.returncode == 0, graded.stderr
        assert json.loads(graded.stdout)[0]["report"]["points"] == 4
    assert checked(programs / "python", "-c", SERVES, cwd=folder).split() == ["200"]
    assert checked(programs / "python", "-c", FACE, cwd=folder).split() == ["17.0"]


@pytest.mark.long
def test_the_wheel_has_one_package(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        tops = {name.partition("/")[0] for name in archive.namelist()}
    [info] = [name for name in tops if name.endswith(".dist-info")]
    assert tops == {"dh_grader", info}


@pytest.mark.long
def test_the_wheel_works_beside_a_package_that_is_called_service(
    wheel: Path, tmp_path: Path
) -> None:
    programs = environment(tmp_path / "environment")
    install(wheel, programs)
    install(other_wheel(tmp_path), programs)
    ask = "import service; print(service.OWNER)"
    assert checked(programs / "python", "-c", ask, cwd=tmp_path).strip() == "somebody else"
    grades_and_serves(programs, tmp_path)
    # In the other order, too: neither removes a file of the other.
    install(wheel, programs)
    assert checked(programs / "python", "-c", ask, cwd=tmp_path).strip() == "somebody else"
    grades_and_serves(programs, tmp_path)


@pytest.mark.long
@pytest.mark.parametrize("name", ["service.py", "service/__init__.py", "service/app.py"])
def test_a_file_or_folder_of_the_user_does_no_harm(
    name: str, programs: Path, tmp_path: Path
) -> None:
    own = tmp_path / name
    own.parent.mkdir(exist_ok=True)
    own.write_text(FOREIGN, encoding="utf-8")
    grades_and_serves(programs, tmp_path)
