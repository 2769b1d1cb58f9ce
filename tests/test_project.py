"""Test the project's lock files, image, continuous integration and wheel."""

import importlib.metadata
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tomllib
import zipfile
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parent.parent
LOCKS = ("requirements.lock", "requirements-build.lock", "requirements-dev.lock")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def read(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def logical_lines(text: str) -> list[str]:
    """Return the lines without comments; join continued lines."""
    lines = text.replace("\\\n", " ").splitlines()
    return [line for line in lines if line.strip() and not line.lstrip().startswith("#")]


def pins(lock: str) -> list[Requirement]:
    return [Requirement(line.split("--hash=")[0]) for line in logical_lines(read(lock))]


def copied_into_image() -> list[str]:
    """Return the paths that the Dockerfile copies from the checkout."""
    copies = [line.split() for line in logical_lines(read("Dockerfile")) if line.startswith("COPY")]
    return [
        source for _, *sources, _ in copies if "--from=builder" not in sources for source in sources
    ]


@pytest.mark.parametrize("lock", LOCKS)
def test_a_lock_holds_only_pinned_requirements_with_hashes(lock: str) -> None:
    lines = logical_lines(read(lock))
    assert lines
    for line in lines:
        assert re.match(r"[a-z0-9-]+(\[[a-z0-9,-]+\])?==\S+ ", line), line
        assert re.search(r" --hash=sha256:[0-9a-f]{64}", line), line


@pytest.mark.parametrize("lock", LOCKS)
def test_a_lock_names_no_download_address(lock: str) -> None:
    assert "://" not in read(lock)


def test_the_runtime_lock_satisfies_the_declared_dependencies() -> None:
    locked = pins("requirements.lock")
    for wanted in map(Requirement, PROJECT["project"]["dependencies"]):
        versions = [
            specifier.version
            for pin in locked
            if canonicalize_name(pin.name) == canonicalize_name(wanted.name)
            for specifier in pin.specifier
        ]
        assert versions, f"{wanted.name} is not locked: run `make lock`"
        assert all(wanted.specifier.contains(version) for version in versions), wanted


@pytest.mark.parametrize("lock", LOCKS)
def test_a_lock_names_the_extras_that_locked_packages_ask_for(lock: str) -> None:
    # If a lock with hashes pins only `name`, pip looks at newer releases for `name[extra]`.
    locked: dict[str, set[str]] = {}
    for pin in pins(lock):
        locked.setdefault(canonicalize_name(pin.name), set()).update(pin.extras)
    asked: list[tuple[str, Requirement]] = []
    for name, extras in locked.items():
        try:
            lines = importlib.metadata.requires(name) or []
        except importlib.metadata.PackageNotFoundError:  # of another platform
            continue
        asked += [
            (name, wanted)
            for wanted in map(Requirement, lines)
            if wanted.extras
            and (
                wanted.marker is None
                or any(wanted.marker.evaluate({"extra": extra}) for extra in ("", *extras))
            )
        ]
    for name, wanted in asked:
        assert wanted.extras <= locked[canonicalize_name(wanted.name)], f"{name} needs {wanted}"


def test_the_development_lock_repeats_the_pins_of_the_others() -> None:
    development = {str(pin) for pin in pins("requirements-dev.lock")}
    for lock in ("requirements.lock", "requirements-build.lock"):
        assert {str(pin) for pin in pins(lock)} <= development


def test_the_version_is_stated_in_pyproject_only() -> None:
    version = PROJECT["project"]["version"]
    assert importlib.metadata.version("dh-grader") == version
    stated = re.compile(rf"""["']{re.escape(version)}["']|__version__\s*=\s*["']""")
    repeats = [
        path
        for path in (ROOT / "service" / "dh_grader").rglob("*.py")
        if stated.search(path.read_text("utf-8"))
    ]
    assert repeats == []


def test_a_wheel_contains_the_program_and_the_catalogue(tmp_path: Path) -> None:
    build = [sys.executable, "-m", "hatchling", "build", "--target", "wheel", "-d", str(tmp_path)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    [wheel] = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        carried = set(archive.namelist())
    exercises = {
        f"dh_grader/_exercises/{path.relative_to(ROOT / 'exercises').as_posix()}"
        for path in (ROOT / "exercises").rglob("*.toml")
    }
    program = {
        path.relative_to(ROOT / "service").as_posix()
        for path in (ROOT / "service" / "dh_grader").rglob("*")
        if path.is_file() and "__pycache__" not in path.parts and path.suffix != ".mo"
    }
    # Of the translations, a wheel has the compiled catalogues only.
    texts = {name for name in program if name.endswith(".po")}
    compiled = {f"{name.removesuffix('.po')}.mo" for name in texts}
    assert exercises
    assert compiled
    assert exercises | program - texts | compiled <= carried
    assert not texts & carried
    licences = {name.partition("/licenses/")[2] for name in carried if "/licenses/" in name}
    assert licences == {"LICENSE", "NOTICE"}
    assert not [name for name in carried if name.startswith(("tests/", "exercises/"))]


@pytest.mark.skipif(sys.platform == "win32", reason="hadolint is not published for Windows")
@pytest.mark.parametrize(
    "dockerfile", ["Dockerfile", "service/dh_grader/bundles/templates/prairielearn/Dockerfile"]
)
def test_hadolint_finds_nothing_in_a_dockerfile(dockerfile: str) -> None:
    hadolint = shutil.which("hadolint", path=sysconfig.get_path("scripts"))
    assert hadolint, "hadolint belongs to requirements-dev.lock: run `make install`"
    command = [hadolint, "--no-color", str(ROOT / dockerfile)]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (result.returncode, result.stdout) == (0, "")


def test_files_that_the_dockerfile_copies_exist_and_are_not_ignored() -> None:
    sources = copied_into_image()
    assert {"service", "exercises", "requirements.lock"} <= set(sources)
    assert [source for source in sources if not (ROOT / source).exists()] == []
    let_through = {line[1:] for line in read(".dockerignore").splitlines() if line.startswith("!")}
    assert let_through == set(sources)


@pytest.mark.parametrize(
    "file",
    [
        "Dockerfile",
        "service/dh_grader/bundles/templates/prairielearn/Dockerfile",
        "compose.yaml",
        "deploy/simple/compose.yaml",
    ],
)
def test_every_external_image_is_named_by_its_digest(file: str) -> None:
    images = re.findall(r"^ *(?:FROM|image:) (\S+)", read(file), re.MULTILINE)
    of_others = [image for image in images if image != "dh-grader"]
    assert of_others
    for image in of_others:
        assert re.fullmatch(r"[a-z]+:[\w.-]+@sha256:[0-9a-f]{64}", image), image
    # Both stages of one image have one base.
    assert len({image.partition("@")[0] for image in of_others}) == len(set(of_others))


@pytest.mark.parametrize(
    "file",
    [
        "docs/ci/github.yml",
        "action.yml",
        ".github/workflows/release.yml",
        ".github/workflows/test.yml",
    ],
)
def test_every_action_is_named_by_its_commit(file: str) -> None:
    actions = re.findall(r"uses: (.+)", read(file))
    assert actions
    for action in actions:
        assert re.fullmatch(r"[\w/-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+", action), action


def test_the_image_runs_as_a_numbered_user_and_has_a_health_check() -> None:
    final_stage = logical_lines(read("Dockerfile").rpartition("\nFROM ")[2])
    [user] = [line for line in final_stage if line.startswith("USER ")]
    assert re.fullmatch(r"USER [1-9]\d*:[1-9]\d*", user)
    # tests/server/test_alive.py runs the command of the health check.
    assert len([line for line in final_stage if line.startswith("HEALTHCHECK ")]) == 1


def test_continuous_integration_runs_make_test() -> None:
    assert "make test" in " ".join(logical_lines(read(".ci/run")))
    assert "set -euo pipefail" in logical_lines(read(".ci/run"))
    assert sys.platform == "win32" or os.access(ROOT / ".ci" / "run", os.X_OK)


@pytest.mark.skipif(os.name == "nt" or shutil.which("git") is None, reason="needs bash and git")
@pytest.mark.parametrize(
    ("tests", "fails"),
    [(":", False), ("echo x >> changed; echo x > cache/x", False), ("echo x > left", True)],
    ids=["clean", "ignored", "left"],
)
def test_continuous_integration_fails_if_tests_leave_a_file(
    tests: str, fails: bool, tmp_path: Path
) -> None:
    # Files in the clone that were changed before the tests do not count.
    clone, programs = tmp_path / "clone", tmp_path / "programs"
    (clone / ".ci").mkdir(parents=True)
    shutil.copy(ROOT / ".ci" / "run", clone / ".ci" / "run")
    (clone / "cache").mkdir()
    (clone / ".gitignore").write_text("cache/\n", encoding="utf-8")
    (clone / "changed").touch()
    subprocess.run(["git", "init", "--quiet"], cwd=clone, check=True)
    programs.mkdir()
    make = programs / "make"
    make.write_text(f'#!/bin/sh\n[ "$1" != test ] || {{ {tests}; }}\n', encoding="utf-8")
    make.chmod(0o755)
    path = f"{programs}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        [clone / ".ci" / "run"], env={**os.environ, "PATH": path}, capture_output=True, check=False
    )
    assert done.returncode == fails, done.stderr
    assert (b"left" in done.stderr) is fails
