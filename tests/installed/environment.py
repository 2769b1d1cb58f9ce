"""Build the program into a wheel and install it outside of the checkout, as a user would."""

import os
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
OLDEST = (3, 11)


def run(*command: object, cwd: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a program in a folder, without the checkout in its environment."""
    clean = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith(("PYTHON", "VIRTUAL_ENV", "DH_GRADER", "GITHUB"))
    }
    return subprocess.run(
        [str(word) for word in command],
        cwd=cwd,
        # Compiling all modules takes longer than compiling those that are used.
        env=clean | {"LC_ALL": "C.UTF-8", "PIP_NO_COMPILE": "1", **environment},
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )


def checked(*command: object, cwd: Path, **environment: str) -> str:
    """Run a program that must succeed; return its output."""
    result = run(*command, cwd=cwd, **environment)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def build(folder: Path) -> Path:
    """Build a wheel from the checkout; return its path."""
    checked(sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", folder, cwd=ROOT)
    [wheel] = folder.glob("*.whl")
    return wheel


def environment(folder: Path, python: str = sys.executable) -> Path:
    """Create a virtual environment and return its bin folder."""
    # Tests in the new environment need no network. Compiled packages need this version of Python.
    if not folder.exists():
        checked(python, "-m", "venv", "--without-pip", folder, cwd=ROOT)
    [site] = folder.glob("lib/python*/site-packages")
    (site / "borrowed.pth").write_text(sysconfig.get_path("purelib") + "\n", encoding="utf-8")
    return folder / "bin"


def install(wheel: Path, programs: Path) -> None:
    pip = (sys.executable, "-m", "pip", "--python", programs / "python", "install", "--quiet")
    checked(*pip, "--no-index", "--no-deps", "--force-reinstall", wheel, cwd=programs)


def other_pythons() -> list[str]:
    """Return the supported Pythons on this machine, except this Python's version."""
    names = [f"python3.{minor}" for minor in range(OLDEST[1], 20)]
    found = [path for name in names if (path := shutil.which(name))]
    found += map(str, Path.home().glob(".pyenv/versions/3.*/bin/python"))
    by_version: dict[str, str] = {}
    probe = "import sys, venv; print(*sys.version_info[:2]); sys.exit(sys.version_info < (3, 11))"
    for path in found:
        result = run(path, "-c", probe, cwd=ROOT)
        if result.returncode == 0:
            by_version.setdefault(result.stdout.strip(), path)
    by_version.pop(f"{sys.version_info[0]} {sys.version_info[1]}", None)
    return list(by_version.values())


def unpack(archive: Path, folder: Path) -> None:
    """Unpack a zip file, and keep the modes of its files."""
    with zipfile.ZipFile(archive) as files:
        for entry in files.infolist():
            Path(files.extract(entry, folder)).chmod(entry.external_attr >> 16)
