"""Convert files by LibreOffice, many at once: each start takes seconds."""

import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path

from tests.submissions.handins.files import Made

PROGRAM = shutil.which("soffice")
_SECONDS = 600
# The libraries of its programs, beside the program that starts them.
_LIBRARIES = {"Calc": "*sclo.*", "Writer": "*swlo.*", "Math": "*smlo.*"}


def is_installed(program: str) -> bool:
    """True if LibreOffice is there with this program: "Calc", "Writer" or "Math"."""
    if PROGRAM is None:
        return False
    folder = Path(PROGRAM).resolve().parent
    return any(folder.parent.glob(f"*/{_LIBRARIES[program]}"))


def converted(files: Mapping[int, Made], folder: Path) -> dict[int, Made]:
    """Return the files as LibreOffice writes them in their target formats."""
    found: dict[int, Made] = {}
    for target in sorted({each.target for each in files.values()}):
        own = {i: each for i, each in files.items() if each.target == target}
        ending = target.partition(":")[0]
        sources, written = folder / f"to-{ending}", folder / ending
        sources.mkdir(parents=True)
        for i, each in own.items():
            (sources / f"{i}{each.ending}").write_bytes(each.content)
        _convert(target, sorted(sources.iterdir()), written, folder / "profile")
        for i in own:
            found[i] = Made((written / f"{i}.{ending}").read_bytes(), f".{ending}")
    return found


def _convert(target: str, sources: list[Path], written: Path, profile: Path) -> None:
    assert PROGRAM is not None
    command = [
        PROGRAM, "--headless", "--norestore", f"-env:UserInstallation={profile.as_uri()}",
        "--convert-to", target, "--outdir", str(written), *map(str, sources),
    ]  # fmt: skip
    done = subprocess.run(command, capture_output=True, timeout=_SECONDS, check=False)
    assert done.returncode == 0, done.stderr
