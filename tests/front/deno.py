"""Check the scripts of the pages with Deno: types, linter, formatter and unit tests.

``python -m tests.front.deno`` checks everything; with ``--fix`` it formats the scripts first.
"""

import os
import subprocess
import sys
from pathlib import Path
from typing import Final

from deno import find_deno_bin

ROOT: Final = Path(__file__).parents[2]
STATIC: Final = ROOT / "service" / "dh_grader" / "web" / "static"
VENDOR: Final = STATIC / "vendor"
TYPES: Final = ROOT / "service" / "dh_grader" / "web" / "types"
TESTS: Final = Path(__file__).parent

# All settings are in one file, which editors and TypeScript's own tsc read, too.
_CONFIG: Final = ("--config", "jsconfig.json")
# What Deno remembers goes away with the environment.
_VARIABLES: Final = {
    "DENO_DIR": str(Path(sys.prefix) / "deno"),
    "DENO_NO_UPDATE_CHECK": "1",
    "NO_COLOR": "1",
}


def scripts() -> list[Path]:
    """Return all scripts of the pages except third-party scripts."""
    return sorted(file for file in STATIC.rglob("*.js") if VENDOR not in file.parents)


def deno(*arguments: str, written: str = "") -> subprocess.CompletedProcess[str]:
    """Run Deno offline in the project's root folder."""
    return subprocess.run(
        [find_deno_bin(), *arguments], cwd=ROOT, env=os.environ | _VARIABLES, check=False,
        input=written, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8",
    )  # fmt: skip


def types() -> subprocess.CompletedProcess[str]:
    """Check the types of all scripts."""
    files = [*scripts(), *sorted(TYPES.glob("*.d.ts"))]
    return deno("check", "--quiet", "--no-lock", "--no-remote", *_CONFIG, *map(str, files))


def linter() -> subprocess.CompletedProcess[str]:
    """Search the scripts and their tests for likely mistakes."""
    return deno("lint", "--quiet", *_CONFIG)


def formatter(*options: str) -> subprocess.CompletedProcess[str]:
    """Format the scripts and their tests."""
    return deno("fmt", "--quiet", *options, *_CONFIG)


def units() -> subprocess.CompletedProcess[str]:
    """Run the unit tests of the scripts."""
    return deno("test", "--no-lock", "--no-remote", "--no-check", *_CONFIG, "tests/front/units")


def main() -> None:
    if "--fix" in sys.argv[1:]:
        formatter()
    results = [formatter("--check"), linter(), types(), units()]
    wrong = [result.stdout for result in results if result.returncode]
    if wrong:
        raise SystemExit("\n".join(wrong))
    sys.stdout.write(f"All checks of {len(scripts())} scripts passed!\n")


if __name__ == "__main__":
    main()
