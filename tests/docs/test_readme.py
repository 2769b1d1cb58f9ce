"""Test README and CONTRIBUTING."""

import html
import re
from collections.abc import Iterator
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import pytest
from dh_grader.cli import program
from typer.testing import CliRunner

from tests.docs.walkthrough import blocks
from tests.shipped import shipped_exercises

# --- The README is one page, and names only targets that exist

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "README.md").read_text(encoding="utf-8")
COMMANDS = [
    line.removeprefix("$ ")
    for block in blocks(PAGE)
    for line in block.text.splitlines()
    if line.startswith("$ ")
]


def test_the_readme_is_one_page() -> None:
    assert len(PAGE.splitlines()) <= 100
    assert len(PAGE.split()) <= 650


def test_the_readme_has_the_number_of_exercises() -> None:
    assert f" {len(shipped_exercises())} exercises" in " ".join(PAGE.split())


@pytest.mark.long
def test_the_size_of_the_packages_is_true() -> None:
    lock = (ROOT / "requirements.lock").read_text(encoding="utf-8")
    size = 0
    for name in set(re.findall(r"^([\w.-]+)==", lock, re.MULTILINE)):
        # Some packages are only for other platforms.
        with suppress(PackageNotFoundError):
            files = [Path(str(each.locate())) for each in distribution(name).files or ()]
            size += sum(each.stat().st_size for each in files if each.is_file())
    # Compiled packages and byte code differ between platforms and versions of Python.
    megabytes = pytest.approx(size / 1e6, rel=0.2)
    for page in ("deployment", "performance"):
        text = (ROOT / f"docs/{page}.md").read_text(encoding="utf-8")
        told, *_ = re.findall(r"about (\d+) MB[ ,]", text)
        assert int(told) == megabytes
    # The program, pip and the blocks of the disk add 20 % to the packages.
    [told] = re.findall(r"about (\d+) MB", PAGE)
    assert int(told) / 1.2 == megabytes


def test_the_commands_of_the_installation_are_first() -> None:
    # `make wheel` runs these commands in a fresh clone; see tests/installed.
    install = ["python3 -m venv .venv", ".venv/bin/pip install .", ".venv/bin/dh-grader serve"]
    assert COMMANDS[:3] == install


def test_the_picture_shows_the_output_of_the_command(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    [command] = [each for each in COMMANDS if " grade " in each]
    result = CliRunner().invoke(program, command.split()[1:])
    assert result.exit_code == 1
    [picture] = re.findall(r"\]\((docs/\S+\.svg)\)", PAGE)
    drawn = re.findall(r"<text[^>]*>(.*?)</text>", (ROOT / picture).read_text(encoding="utf-8"))
    shown = "".join("".join(map(html.unescape, drawn)).split())
    printed = ["".join(line.split()) for line in result.output.splitlines()]
    assert len(printed) > 10
    assert [line for line in printed if line not in shown] == []


def test_the_targets_of_the_readme_exist() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for target in re.findall(r"make (\w+)", " ".join(re.findall(r"`[^`]+`", PAGE) + COMMANDS)):
        assert re.search(rf"^{target}:", makefile, re.MULTILINE), target


# --- CONTRIBUTING.md and its pages name only files, functions and targets that exist

SERVICE = ROOT / "service" / "dh_grader"
CONTRIBUTING_PAGE = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
PAGES = {
    "CONTRIBUTING.md": CONTRIBUTING_PAGE,
    **{
        name: (ROOT / "docs" / name).read_text(encoding="utf-8")
        for name in ("recipes.md", "campaigns.md", "front-end.md")
    },
}
# The folders to which paths on the pages are relative.
STARTS = (ROOT, SERVICE, SERVICE / "expressions", SERVICE / "web" / "static")


def exists(path: str) -> bool:
    return any((start / path).exists() for start in STARTS)


def on_the_map() -> Iterator[Path]:
    above: list[tuple[int, Path]] = []
    chart = CONTRIBUTING_PAGE[
        CONTRIBUTING_PAGE.index("## The map") : CONTRIBUTING_PAGE.index("Where is …?")
    ]
    for indent, names in re.findall(r"^    ( *)((?:\w+(?:/|\.py)(?: +|$))+)", chart, re.MULTILINE):
        above = [(depth, path) for depth, path in above if depth < len(indent)]
        inside = above[-1][1] if above else ROOT
        paths = [inside / name for name in names.split()]
        above.append((len(indent), paths[-1]))
        yield from paths


def test_the_page_is_read_in_ten_minutes() -> None:
    assert len(CONTRIBUTING_PAGE) <= 15_000


def test_the_first_screen_has_the_commands_and_the_way_of_an_answer() -> None:
    first = CONTRIBUTING_PAGE.splitlines()[:32]
    commands = [line.partition("#")[0].strip() for line in first if line.startswith("$ ")]
    assert commands == [
        "$ make install", "$ . .venv/bin/activate", "$ make run", "$ make test",
    ]  # fmt: skip
    steps = [line.split(maxsplit=1) for line in first if re.match(r"    \d", line)]
    assert [int(number) for number, _ in steps] == list(range(1, 11))
    for _, step in steps:
        paths = re.findall(r"(?<!\S)((?:\w+/)*[\w*]+(?:\.py|/))", step)
        assert paths, step
        for path in paths:
            # A folder may be inside of the folder that the line names first.
            found = [*SERVICE.glob(path), *(SERVICE / "grading").glob(path)]
            assert found, path


def test_the_map_shows_existing_files_and_every_package() -> None:
    shown = list(on_the_map())
    assert [path for path in shown if not path.exists()] == []
    packages = {file.parent for file in SERVICE.glob("*/__init__.py")}
    assert packages - set(shown) == set()


def test_what_a_newcomer_looks_for_is_where_the_page_says() -> None:
    table = CONTRIBUTING_PAGE[
        CONTRIBUTING_PAGE.index("Where is …?") : CONTRIBUTING_PAGE.index(
            "## Rules of the structure"
        )
    ]
    rows = re.findall(r"^\| ([^|]+) \| ([^|]+) \|$", table, re.MULTILINE)[1:]
    assert len(rows) >= 8
    for asked, answer in rows:
        words = re.findall(r"`([^`]+)`", answer)
        files = [SERVICE / word for word in words if word.endswith(".py")]
        names = [word for word in words if re.fullmatch(r"\w+", word)]
        inside = [file if file.is_file() else files[0].parent / file.name for file in files]
        assert all(file.is_file() for file in inside), asked
        texts = [file.read_text(encoding="utf-8") for file in inside]
        for name in names:
            assert any(re.search(rf"\b{name}\b", text) for text in texts), f"{asked}: {name}"


def test_the_route_of_the_table_is_in_its_function() -> None:
    text = (SERVICE / "api" / "grading.py").read_text(encoding="utf-8")
    routes = text[text.index("def practice_routes") :]
    routes = routes[: routes.index("\ndef ")]
    assert 'prefix="/v1/practice"' in routes
    assert '"/next"' in routes


@pytest.mark.parametrize("name", PAGES)
def test_the_files_of_a_page_exist(name: str) -> None:
    named = re.findall(r"`((?:[\w.-]+/)+(?:[\w-]+\.\w+)?)`", PAGES[name])
    assert len(named) > 2
    assert [path for path in named if not exists(path)] == []


@pytest.mark.parametrize("name", PAGES)
def test_the_targets_of_a_page_exist(name: str) -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    targets = set(re.findall(r"^([a-z]+):", makefile, re.MULTILINE))
    assert set(re.findall(r"make ([a-z]+)\b", PAGES[name])) <= targets
