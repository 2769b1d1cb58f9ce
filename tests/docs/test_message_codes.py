"""docs/messages.md lists exactly the message codes of the program."""

# Its tables of slips are made from the records (`tests/docs/misconception_records.py`).

import json
import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.expressions import LIMITS, ExpressionError, read
from dh_grader.grading import FeedbackLevel
from dh_grader.grading.reading import preview_pasted
from dh_grader.grading.reading.table import MAX_ROWS
from dh_grader.grading.report import MAX_SYMBOLS
from dh_grader.pasting import GRID_LIMITS

from tests.docs.codes import CodeUse, HiddenCodeError, codes_in, sources
from tests.expressions.corpus_files import ROBOT
from tests.grading.support.submitting import all_codes, as_data, handed_in, part
from tests.together import together

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "messages.md").read_text(encoding="utf-8")

UNREAD = "A formula that cannot be read"
NOTED = "A formula that is read, with a note"
PASTED_UNREAD = "A pasted table or matrix that cannot be read"
PASTED_NOTED = "A pasted table or matrix that is read, with a note"


class Line(NamedTuple):
    """A line of a table of message codes."""

    section: str
    code: str
    example: tuple[str, ...]


def lines(page: str) -> list[Line]:
    """Return the lines of all tables of message codes."""
    found: list[Line] = []
    section, heads = "", ""
    for line in page.split("\n"):
        if heading := re.fullmatch(r"##+ (.+)", line):
            section = heading[1]
        cells = [cell.strip() for cell in line.split("|")[1:-1]]
        heads = (heads or cells[0]) if cells else ""
        if heads == "Code" and (code := re.fullmatch(r"`(\w+)`", cells[0])):
            example = tuple(cell.strip("`") for cell in cells[2:])
            found.append(Line(section, code[1], example if any(example) else ()))
    return found


LINES = lines(PAGE)


# --- the page and the program


@cache
def program() -> Sequence[CodeUse]:
    """Return every use of a message code in the program."""
    # Three folders are left out: `attempts` only counts the codes of reports, the codes in
    # `translations` name languages, and a standard defines the codes in `lti/handed_files`.
    telling = {
        file: text
        for file, text in sources(ROOT / "service" / "dh_grader").items()
        if not file.startswith(("store/", "lti/handed_files.py", "translations/"))
    }
    return codes_in(telling)


@pytest.mark.long
def test_every_code_of_the_program_is_on_the_page() -> None:
    assert {use.code for use in program()} - {line.code for line in LINES} == set()


@pytest.mark.long
def test_every_code_on_the_page_exists() -> None:
    assert {line.code for line in LINES} - {use.code for use in program()} == set()


def test_a_section_lists_a_code_once() -> None:
    times = Counter((line.section, line.code) for line in LINES)
    assert [place for place, count in times.items() if count > 1] == []


def test_a_line_of_the_page_without_its_example() -> None:
    page = "## A\n| Code | It |\n|---|---|\n| `one` | x |\n\n| No | `two` |\n| `three` | y |\n"
    assert lines(page) == [Line("A", "one", ())]


# --- the examples


def codes_of(exercise: Exercise, part_id: str, answer: object) -> tuple[set[str], set[str]]:
    """Return the codes of the messages on an answer."""
    full, hints, verdicts, score = (
        all_codes(part(handed_in(exercise, {part_id: answer}, feedback=level), part_id))
        for level in FeedbackLevel
    )
    assert full == hints
    assert verdicts == score
    return full, score


def examples(*sections: str) -> Callable[[Callable[..., None]], Callable[..., None]]:
    chosen = [line for line in LINES if line.section in sections and line.example]
    return together("line", chosen)


@examples(UNREAD)
def test_a_formula_is_not_read(line: Line) -> None:
    with pytest.raises(ExpressionError) as caught:
        read(line.example[0], ROBOT)
    assert caught.value.code == line.code


@examples(NOTED)
def test_a_formula_is_read_with_a_note(line: Line) -> None:
    assert line.code in {note.code for note in read(line.example[0], ROBOT).notes}


@pytest.mark.long
@examples(PASTED_UNREAD, PASTED_NOTED)
def test_a_pasted_text_has_its_code(line: Line, catalogue: Mapping[str, Exercise]) -> None:
    exercise, text = catalogue["planar-rr"], line.example[0].replace(" ↵ ", "\n")
    found: set[str] = set()
    for part_id in ("table", "links", "pose"):
        pasted = preview_pasted(text, exercise, part_id)
        found |= {note.code for note in pasted.notes}
        found |= {pasted.problem.code} if pasted.problem else codes_of(exercise, part_id, text)[1]
    assert line.code in found


def test_a_text_that_is_no_grid_has_another_code_in_a_report(
    catalogue: Mapping[str, Exercise],
) -> None:
    [line] = [line for line in LINES if line.code == "no_grid"]
    full, score = codes_of(catalogue["planar-rr"], "pose", line.example[0])
    assert full == score == {"wrong_shape"}


def test_most_codes_have_an_example() -> None:
    assert len({line.code for line in LINES if line.example}) > 120


# --- other statements of the page


def test_the_message_on_the_page_is_in_the_report(catalogue: Mapping[str, Exercise]) -> None:
    [block] = re.findall(r"^```json\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)
    shown = json.loads(block)
    body = json.loads((ROOT / "docs" / "examples" / "stanford-arm.json").read_text("utf-8"))
    report = as_data(handed_in(catalogue["stanford-arm"], body["answers"]))
    messages = [
        {name: value for name, value in message.items() if value is not None}
        for row in report["parts"][0]["rows"]
        for cell in row["cells"]
        for message in cell["feedback"]
    ]
    assert shown in json.loads(json.dumps(messages))


def test_the_limits_of_the_page() -> None:
    for limit in (
        f"more than {LIMITS.characters:,} characters",
        f"more than {LIMITS.nodes:,} operations and values",
        f"more than {LIMITS.depth} levels deep",
        f"more than {GRID_LIMITS.characters:,} characters",
        f"more than {GRID_LIMITS.rows - 1} rows and a header",
        f"more than {GRID_LIMITS.columns} columns",
        f"more than {MAX_SYMBOLS:,} names, numbers and signs",
        f"a table of more than {MAX_ROWS} rows",
    ):
        assert limit in PAGE


def test_links_within_the_page_have_targets() -> None:
    headings = re.findall(r"^##+ (.+)$", PAGE, re.MULTILINE)
    anchors = {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}
    links = set(re.findall(r"\]\(#([\w-]+)\)", PAGE))
    assert len(links) > 3
    assert links - anchors == set()


# --- finding the codes


CARRIER = "class Finding:\n    code: str\n    look: str\n"
ERROR = "class E(Exception):\n    def __init__(self, code: str, span: int) -> None: ...\n"


@pytest.mark.parametrize(
    ("text", "codes"),
    [
        ('Finding("one", "x")', {"one"}),
        ('Finding(hint="x", code="one")', {"one"}),
        ('module.Finding("one", "x")', {"one"}),
        ('raise E("one", 0)', {"one"}),
        ('class F(E): ...\nclass G(F): ...\nraise G("one", 0)', {"one"}),
        ('f = lambda: Finding("one", "x")', {"one"}),
        ('Finding("one" if a else "two", "x")', {"one", "two"}),
        ('ONE = "one"\nFinding(ONE, "x")', {"one"}),
        ('def f(a):\n    c = "one" if a else "two"\n    return Finding(c, "")', {"one", "two"}),
        ('def f(a):\n    c = "one"\n    if a: c = "two"\n    Finding(c, "")', {"one", "two"}),
        ('def f(e):\n    return Finding("one" if e.code == "two" else e.code, "x")', {"one"}),
        ('def f(code, look):\n    return Finding(code, look)\nf("one", "x")', {"one"}),
        ('class A:\n    def f(self, code): Finding(code, "")\nA().f("one")', {"one"}),
        ('replace(finding, code="one")', {"one"}),
        ('other("one", "x")', set()),
        ("Finding(finding.code, finding.hint)", set()),
    ],
)
def test_codes_are_found(text: str, codes: set[str]) -> None:
    assert {use.code for use in codes_in({"a.py": f"{CARRIER}{ERROR}{text}\n"})} == codes


def test_codes_are_found_across_files() -> None:
    files = {
        "carrier.py": f'{CARRIER}ONE = "one"\ndef info(code): return Finding(code, "")\n',
        "a.py": 'from carrier import Finding, ONE\nFinding(ONE, "x")\n',
        "b.py": 'from carrier import info\ninfo("two")\n',
        "c.py": 'def info(text): ...\ninfo("three")\n',
    }
    assert {(use.code, use.file, use.line) for use in codes_in(files)} == {
        ("one", "a.py", 2),
        ("two", "b.py", 2),
    }


@pytest.mark.parametrize(
    "text",
    [
        'Finding(f"{a}_sign", "x")',
        'for code in ("one", "two"):\n    Finding(code, "x")',
        'def f(name):\n    return Finding(name, "x")',
        'Finding(CODES[0], "x")',
        "Finding(*both)",
        "Finding(**both)",
    ],
)
def test_a_code_that_is_not_written_out_is_refused(text: str) -> None:
    with pytest.raises(HiddenCodeError, match=r"a\.py:\d+: not written out: "):
        codes_in({"a.py": f"{CARRIER}{text}\n"})
