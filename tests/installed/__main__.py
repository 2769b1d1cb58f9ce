"""Install the built wheel with all its dependencies, and grade with it: ``make wheel``."""

# Install it with pip on each supported Python of this machine, with pipx on the current one, and in
# a fresh clone with the commands of the README. This needs the package index.

import sys
import tempfile
from pathlib import Path

from tests.docs.test_readme import COMMANDS
from tests.installed.environment import ROOT, build, checked, other_pythons, run

SUBMISSION = ROOT / "docs" / "examples" / "stanford-arm.json"
POINTS = "8.67 / 32 points"


def report(program: Path, folder: Path) -> str:
    graded = run(program, "grade", SUBMISSION, "--exercise", "stanford-arm", cwd=folder)
    assert graded.returncode == 1, graded.stderr
    assert POINTS in graded.stdout
    return checked(program, "--version", cwd=folder).strip()


def newcomer(folder: Path) -> str:
    checked("git", "clone", "--quiet", ROOT, folder, cwd=ROOT)
    for command in COMMANDS[:2]:
        checked(*command.split(), cwd=folder)
    return report(folder / ".venv" / "bin" / "dh-grader", folder)


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        wheel = build(folder)
        for i, python in enumerate([sys.executable, *other_pythons()]):
            place = folder / str(i)
            checked(python, "-m", "venv", place, cwd=folder)
            checked(place / "bin" / "pip", "install", "--quiet", wheel, cwd=folder)
            size = sum(file.stat().st_size for file in place.rglob("*") if file.is_file())
            print(f"{python}: {report(place / 'bin' / 'dh-grader', folder)}, {size >> 20} MB")
        pipx = folder / "pipx"
        checked(sys.executable, "-m", "venv", pipx, cwd=folder)
        checked(pipx / "bin" / "pip", "install", "--quiet", "pipx", cwd=folder)
        homes = {"PIPX_HOME": str(folder / "home"), "PIPX_BIN_DIR": str(folder / "programs")}
        checked(pipx / "bin" / "pipx", "install", wheel, cwd=folder, **homes)
        print(f"pipx: {report(folder / 'programs' / 'dh-grader', folder)}")
        print(f"README in a fresh clone: {newcomer(folder / 'clone')}")


if __name__ == "__main__":
    main()
