"""CONTRIBUTING.md lists every package, and names only files and targets that exist."""

import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
SERVICE = ROOT / "service" / "dh_grader"
PAGE = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
# The folders to which paths on the page are relative.
STARTS = (ROOT, SERVICE, SERVICE / "expressions", SERVICE / "grading", SERVICE / "web" / "static")


def on_the_map() -> Iterator[Path]:
    above: list[tuple[int, Path]] = []
    chart = PAGE[PAGE.index("## The map") : PAGE.index("## Five recipes")]
    for indent, names in re.findall(r"^    ( *)((?:\w+(?:/|\.py) +)+)", chart, re.MULTILINE):
        above = [(depth, path) for depth, path in above if depth < len(indent)]
        inside = above[-1][1] if above else ROOT
        paths = [inside / name for name in names.split()]
        above.append((len(indent), paths[-1]))
        yield from paths


def test_the_map_shows_existing_files_and_every_package() -> None:
    shown = list(on_the_map())
    assert [path for path in shown if not path.exists()] == []
    packages = {file.parent for file in SERVICE.glob("*/__init__.py")}
    assert packages - set(shown) == set()


def test_the_files_of_the_page_exist() -> None:
    named = re.findall(r"`((?:[\w.-]+/)+(?:[\w-]+\.\w+)?)`", PAGE)
    assert len(named) > 20
    assert [n for n in named if not any((start / n).exists() for start in STARTS)] == []


def test_the_targets_of_the_page_exist() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    targets = set(re.findall(r"^([a-z]+):", makefile, re.MULTILINE))
    assert set(re.findall(r"make ([a-z]+)\b", PAGE)) <= targets
