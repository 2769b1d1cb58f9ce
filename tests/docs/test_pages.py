"""Test the examples and links on pages of the docs."""

import contextlib
import inspect
import io
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import dh_grader
import pytest
from dh_grader import client
from dh_grader.catalogue import Exercise
from dh_grader.client import Retries
from dh_grader.expressions import LIMITS, ExpressionError, read
from dh_grader.grading.kinds import KINDS
from dh_grader.grading.reading.headers import read_header
from dh_grader.grading.report import MAX_PASTED
from dh_grader.pasting import GRID_LIMITS, GridError, read_grid, read_robot

from tests.api.serving import Served
from tests.expressions.corpus_files import ROBOT
from tests.grading.support.submitting import full_marks, handed_in, part
from tests.together import together

# --- Each example in docs/answer-kinds.md gets full marks

PAGE = (Path(__file__).parents[2] / "docs" / "answer-kinds.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```json (\S+)\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)


def test_every_block_is_an_example() -> None:
    assert len(BLOCKS) == PAGE.count("\n```") / 2


@pytest.mark.parametrize(("exercise_id", "body"), BLOCKS)
def test_an_example_gets_full_marks(
    exercise_id: str, body: str, catalogue: Mapping[str, Exercise]
) -> None:
    answers = json.loads(body)["answers"]
    report = handed_in(catalogue[exercise_id], answers)
    assert answers
    for part_id in answers:
        assert full_marks(part(report, part_id)), part(report, part_id)


def test_every_kind_has_an_entry() -> None:
    assert set(re.findall(r"^## `(\w+)`$", PAGE, re.MULTILINE)) == set(KINDS)


def test_every_code_on_the_page_exists() -> None:
    program = "\n".join(
        file.read_text(encoding="utf-8")
        for file in (Path(__file__).parents[2] / "service" / "dh_grader" / "grading").rglob("*.py")
    )
    named = {code for code in re.findall(r"`([a-z]+_[a-z_0-9]+)`", PAGE) if code not in KINDS}
    assert len(named) > 25
    assert {code for code in named if f'"{code}"' not in program} == set()


# --- The examples in docs/client.md print the shown output

CLIENT_PAGE = (Path(__file__).parents[2] / "docs" / "client.md").read_text(encoding="utf-8")
_EXAMPLE = re.compile(r"^```python\n(.*?)^```\n(.*?)^```text\n(.*?)^```$", re.DOTALL | re.MULTILINE)
_SHOWN = "http://127.0.0.1:8000"


@pytest.mark.long
def test_the_examples_print_the_shown_output(server: Served) -> None:
    examples = _EXAMPLE.findall(CLIENT_PAGE)
    assert len(examples) == CLIENT_PAGE.count("```python") == 4
    names: dict[str, Any] = {}
    for program, _, printed in examples:
        page = io.StringIO()
        with contextlib.redirect_stdout(page):
            exec(program.replace(_SHOWN, server.address), names)  # noqa: S102 - our own page
        assert page.getvalue() == printed


def test_the_page_names_every_public_name() -> None:
    assert [name for name in client.__all__ if name not in CLIENT_PAGE] == []
    for method in re.findall(r"^\| `(\w+)\(", CLIENT_PAGE, re.MULTILINE):
        assert hasattr(client.GraderClient, method)
        assert hasattr(client.AsyncGraderClient, method)


def test_the_page_has_the_default_retries() -> None:
    usual = Retries()
    assert (usual.number, usual.first_wait, usual.longest_wait) == (5, 0.5, 30.0)
    assert "up to five times more" in CLIENT_PAGE.replace("\n", " ")


# --- The program reads every example in docs/expressions.md as the page says

EXPRESSIONS_PAGE = (Path(__file__).parents[2] / "docs" / "expressions.md").read_text("utf-8")
_COLUMN = re.compile(r"(?<!\\)\|")


def rows(*heads: str) -> list[tuple[str, ...]]:
    found: list[tuple[str, ...]] = []
    inside = False
    for line in EXPRESSIONS_PAGE.split("\n"):
        cells = tuple(cell.strip() for cell in _COLUMN.split(line)[1:-1])
        if cells == heads:
            inside = True
        elif not cells:
            inside = False
        elif inside and not set(cells[0]) <= {"-"}:
            found.append(tuple(cell.strip("`").replace(r"\|", "|") for cell in cells))
    assert found
    return found


@together(("text", "meaning"), rows("You type", "It means"))
def test_a_text_has_the_shown_meaning(text: str, meaning: str) -> None:
    assert read(text, ROBOT).text() == meaning


@pytest.mark.parametrize(("text", "meaning", "note"), rows("You type", "It means", "The note"))
def test_a_text_has_the_shown_meaning_and_note(text: str, meaning: str, note: str) -> None:
    expression = read(text, ROBOT)
    assert expression.text() == meaning
    assert note in {found.code for found in expression.notes}


@pytest.mark.parametrize(("text", "_why", "repaired"), rows("You type", "Why not", "Write"))
def test_a_refused_text_has_the_shown_repair(text: str, _why: str, repaired: str) -> None:
    with pytest.raises(ExpressionError) as caught:
        read(text, ROBOT)
    assert caught.value.suggestion == repaired
    read(repaired, ROBOT)


@pytest.mark.parametrize(("text", "_why"), rows("You type", "Why not"))
def test_a_text_is_refused_without_a_repair(text: str, _why: str) -> None:
    with pytest.raises(ExpressionError) as caught:
        read(text, ROBOT)
    assert caught.value.suggestion is None


def test_no_example_but_the_noted_ones_has_a_second_reading() -> None:
    plain = [text for text, _ in rows("You type", "It means")]
    notes = {text: {note.code for note in read(text, ROBOT).notes} for text in plain}
    assert {text for text, codes in notes.items() if codes - {"joint_marker"}} == set()


def test_the_limits_are_the_ones_in_force() -> None:
    words = " ".join(EXPRESSIONS_PAGE.split())
    assert f"{LIMITS.characters:,} characters, {LIMITS.nodes:,} operations and values" in words
    assert f"{LIMITS.depth} levels" in words
    assert f"{LIMITS.tree_depth} terms" in words
    assert f"no more than {LIMITS.repaired:,} characters" in words


# --- Each example of docs/pasting.md is read or refused as the page says

PASTING_PAGE = (Path(__file__).parents[2] / "docs" / "pasting.md").read_text(encoding="utf-8")
PASTING_BLOCKS = re.findall(
    r"^```\w+ (table|matrix|links|refused) ?(\w*)\n(.*?)^```$",
    PASTING_PAGE,
    re.DOTALL | re.MULTILINE,
)
READ = [(kind, text) for kind, _, text in PASTING_BLOCKS if kind != "refused"]
REFUSED = [(code, text) for kind, code, text in PASTING_BLOCKS if kind == "refused"]

PARTS = {
    "table": ("rrrp", "table"),
    "matrix": ("planar-rrr", "pose"),
    "links": ("planar-rrr-standard", "links"),
}


def test_every_pasted_block_is_an_example() -> None:
    assert len(PASTING_BLOCKS) == PASTING_PAGE.count("\n```") / 2
    assert (len(READ), len(REFUSED)) == (30, 5)


@pytest.mark.parametrize(("kind", "text"), READ)
def test_a_pasted_example_gets_full_marks(
    kind: str, text: str, catalogue: Mapping[str, Exercise]
) -> None:
    exercise, part_id = PARTS[kind]
    report = part(handed_in(catalogue[exercise], {part_id: text}), part_id)
    assert full_marks(report), report


@pytest.mark.parametrize(("code", "text"), REFUSED)
def test_an_example_is_refused(code: str, text: str) -> None:
    with pytest.raises(GridError) as caught:
        read_robot(text) or read_grid(text)
    assert caught.value.code == code


def test_the_headers_of_the_page() -> None:
    names = {"a": "a", "α": "alpha", "d": "d", "θ": "theta", "the row's label": "label"}
    rows = re.findall(r"^\| ([^|]+) \| (`.*) \|$", PASTING_PAGE, re.MULTILINE)
    assert [name for name, _ in rows] == list(names)
    for name, spellings in rows:
        for spelling in re.findall(r"`([^`]+)`", spellings):
            header = read_header(spelling)
            assert header is not None
            assert header.column == names[name]


def test_the_limits_of_the_page() -> None:
    words = " ".join(PASTING_PAGE.split())
    assert f"{GRID_LIMITS.characters:,} characters ({MAX_PASTED:,} in all texts" in words
    assert f"{GRID_LIMITS.rows - 1} rows and a header, {GRID_LIMITS.columns} columns" in words


# --- The examples in docs/notebook.md print the shown output

NOTEBOOK_PAGE = (Path(__file__).parents[2] / "docs" / "notebook.md").read_text(encoding="utf-8")
_NOTEBOOK_EXAMPLE = re.compile(
    r"^```python\n(.*?)^```\n.*?^```text\n(.*?)^```$", re.DOTALL | re.MULTILINE
)


def test_the_notebook_examples_print_the_shown_output(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    examples = _NOTEBOOK_EXAMPLE.findall(NOTEBOOK_PAGE)
    assert len(examples) == NOTEBOOK_PAGE.count("```python") == 3
    names: dict[str, Any] = {}
    for program, printed in examples:
        page = io.StringIO()
        with contextlib.redirect_stdout(page):
            exec(program, names)  # noqa: S102 - our own page
        assert page.getvalue() == printed


def test_the_page_has_every_argument_with_its_default() -> None:
    arguments = inspect.signature(dh_grader.grade).parameters
    rows = dict(re.findall(r"^\| `(\w+)` \|.*\| ([^|]*) \|$", NOTEBOOK_PAGE, re.MULTILINE))
    assert list(rows) == list(arguments)[2:]
    for name in ("angle_unit", "language"):
        assert rows[name] == f'`"{arguments[name].default}"`'


# --- Links between pages of docs/ have existing targets

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
_CODE = re.compile(r"^```.*?^```$", re.DOTALL | re.MULTILINE)
_LINK = re.compile(r"\]\(([^)#\s]+)[^)]*\)")
_SECTION = re.compile(r"\]\(([^)#\s:]*)#([^)\s]+)\)")


def prose(page: Path) -> str:
    """Return the page without its code blocks."""
    return _CODE.sub("", page.read_text(encoding="utf-8"))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_page_names_others_by_links(page: Path) -> None:
    assert re.findall(r"`[\w/-]+\.md`", prose(page)) == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_link_leads_to_a_file(page: Path) -> None:
    targets = [target for target in _LINK.findall(prose(page)) if "://" not in target]
    assert [target for target in targets if not (page.parent / target).is_file()] == []


def anchors(page: Path) -> set[str]:
    """Return the anchors that GitHub and GitLab derive from a page's headings."""
    headings = re.findall(r"^#+ (.+)$", prose(page), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_link_to_a_section_leads_to_one(page: Path) -> None:
    assert [
        (target, section)
        for target, section in _SECTION.findall(prose(page))
        if section not in anchors(page.parent / target if target else page)
    ] == []


def test_every_page_is_linked_from_another() -> None:
    linked = {
        (page.parent / target).resolve()
        for page in PAGES
        for target in _LINK.findall(prose(page))
        if "://" not in target
    }
    assert set(PAGES) - linked == set()
