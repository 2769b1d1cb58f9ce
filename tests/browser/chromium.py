"""The Chromium that the tests drive: the machine's, Playwright's own, or that of an npm package.

``python -m tests.browser.chromium`` says which there is, and fetches the last where there is none.
"""

import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Final

import brotli
from playwright.sync_api import sync_playwright

# Of the package's own versions the one that was tried; its major number is Chromium's.
_PACKAGE: Final = "@sparticuz/chromium@153.0.0"
# Beside the environment's other programs: `make clean` takes it away.
_FOLDER: Final = Path(sys.prefix) / "chromium-153.0.0"
_PROGRAMS: Final = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")

# The package's own configuration names the folders of the machine that it is made for.
_FONTS: Final = Path("fonts.conf")
_FONT_FOLDERS: Final = """\
<?xml version="1.0"?>
<!DOCTYPE fontconfig SYSTEM "fonts.dtd">
<fontconfig>
  <dir prefix="relative">fonts</dir>
  <dir>/usr/share/fonts</dir>
  <cachedir prefix="relative">fonts-cache</cachedir>
</fontconfig>
"""

OPTIONS: Final = [
    "--no-sandbox", "--no-first-run", "--disable-sync", "--disable-quic",
    "--disable-background-networking", "--disable-component-update",
    # WebGL in software, where there is no graphics card.
    "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
    # The page itself is then drawn by the processor, as Chromium does it without a graphics card,
    # and not by a graphics card that the processor plays: that takes 50 ms a frame.
    "--disable-gpu-compositing",
    # Every name and address but this machine's leads nowhere.
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
]  # fmt: skip
ABSENT: Final = (
    "No Chromium was found, so the page was NOT TESTED in a browser. Install one (Debian: apt-get "
    "install chromium), or npm, with which `make browser` fetches one."
)


@dataclass(frozen=True)
class Chromium:
    """A program to start, and the variables that it needs."""

    program: str
    environment: dict[str, str] = field(default_factory=dict)


def find_chromium() -> Chromium | None:
    """The Chromium that is there, or None. Nothing is fetched."""
    if program := next(filter(None, map(shutil.which, _PROGRAMS)), None):
        return Chromium(program)
    with sync_playwright() as playwright:
        own = playwright.chromium.executable_path
    if Path(own).is_file():
        return Chromium(own)
    return _unpacked()


def _unpacked() -> Chromium | None:
    program = _FOLDER / "chromium"
    if not program.is_file():
        return None
    # The package is made for a machine without the libraries and fonts that a desktop has.
    libraries = [str(_FOLDER / "lib"), os.environ.get("LD_LIBRARY_PATH", "")]
    variables = {
        "LD_LIBRARY_PATH": os.pathsep.join(filter(None, libraries)),
        "FONTCONFIG_FILE": str(_FOLDER / _FONTS.name),
    }
    return Chromium(str(program), variables)


def fetch_chromium() -> Chromium | None:
    """Fetch the one of the npm package; None where that fails."""
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
    """The program with its libraries, fonts and WebGL in software, side by side."""
    (folder / _FONTS).write_text(_FONT_FOLDERS, encoding="utf-8")
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
    """Say which Chromium there is, and fetch one where there is none."""
    found = find_chromium() or fetch_chromium()
    if found is None:
        raise SystemExit(ABSENT)
    sys.stdout.write(f"Browser tests use {found.program}\n")


if __name__ == "__main__":
    main()
