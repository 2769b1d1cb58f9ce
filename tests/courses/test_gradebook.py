"""Test the gradebook, and its workbook."""

import io
import re
import tempfile
import zipfile
from collections.abc import Mapping
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path
from typing import Any
from xml.etree import ElementTree
from zoneinfo import ZoneInfo

import pytest
from dh_grader.access import Scope, new_key_text
from dh_grader.access.key_ring import add_key
from dh_grader.catalogue import Exercise
from dh_grader.cli import program
from dh_grader.contract.courses import Gradebook, GradebookFormat, NewLearner
from dh_grader.courses import roll
from dh_grader.courses.gradebook import gradebook, gradebook_workbook, written_gradebook
from dh_grader.store.tables import assignments
from sqlalchemy import Connection, event, select
from typer.testing import CliRunner

from tests.access.kept_services import SECRET
from tests.courses.conftest import NOW, Class, days
from tests.store.databases import KINDS
from tests.store.recorded import NO_TWIST, new_attempt, recorded_all

# --- The gradebook has the best points of each learner, and its database query uses an index

# The gradebook of ``fill``: 12 of 24 points are 5 of 10, 18 of 24 are 3 of 4, and 1 of 1 is 4 of 4.
POINTS = {"ada": [5.0, 3.0], "grace": [0.0, 4.0]}


def fill(class_: Class, catalogue: Mapping[str, Exercise]) -> None:
    """Record attempts in two assignments; some of them are in no place of the gradebook."""
    class_.assign()
    class_.assign(id="second", exercises=[{"exercise": "scara", "points": 4}])
    numbered = select(assignments.c.id, assignments.c.number)
    number_of = {row.id: row.number for row in class_.do(lambda it: it.execute(numbered).all())}
    recorded_all(
        class_.store,
        [
            new_attempt(
                catalogue[exercise], learner, NO_TWIST, ordinal, hours, assignment=number_of[name],
                points=points, max_points=most,
            )
            for exercise, learner, ordinal, hours, name, points, most in (
                ("scara", "ada", 1, 0, "homework", 12.0, 24.0),
                ("scara", "ada", 2, 1, "homework", 6.0, 24.0),
                ("scara", "ada", 3, 2, "second", 18.0, 24.0),
                # Without points to earn, the share is 0.
                ("scara", "grace", 1, 3, "homework", 0.0, 0.0),
                ("scara", "grace", 2, 4, "second", 1.0, 1.0),
                # The exercise has left the assignment, and the learner has left the course.
                ("planar-rr", "ada", 1, 5, "homework", 24.0, 24.0),
                ("scara", "linus", 1, 6, "homework", 24.0, 24.0),
            )
        ],
    )  # fmt: skip


@pytest.mark.parametrize("class_", KINDS, indirect=True)
def test_the_best_share_counts_for_learners_and_exercises_of_the_course(
    class_: Class, catalogue: Mapping[str, Exercise]
) -> None:
    fill(class_, catalogue)
    book: Gradebook = class_.do(lambda it: gradebook(it, "robots"))
    assert book.course == "robots"
    assert [(each.assignment, each.points) for each in book.columns] == [
        ("homework", 10.0),
        ("second", 4.0),
    ]
    assert {row.learner: row.points for row in book.rows} == POINTS
    assert [row.total for row in book.rows] == [8.0, 4.0]
    second: Gradebook = class_.do(lambda it: gradebook(it, "robots", "second"))
    assert [row.points for row in second.rows] == [[3.0], [4.0]]


WRITTEN: Mapping[GradebookFormat, list[str]] = {
    "canvas": [
        "Student,ID,SIS User ID,SIS Login ID,Section,homework scara,second scara",
        "    Points Possible,,,,,10,4",
        "Ada,,,ada,,5,3",
        "Grace,,,grace,,0,4",
    ],
    "moodle": [
        "ID number,Full name,Email address,homework scara,second scara",
        "ada,Ada,,5,3",
        "grace,Grace,,0,4",
    ],
    "csv": [
        "learner,name,email,homework scara,second scara,total",
        "ada,Ada,,5,3,8",
        "grace,Grace,,0,4,4",
    ],
}


def test_each_format_has_its_own_columns(class_: Class, catalogue: Mapping[str, Exercise]) -> None:
    fill(class_, catalogue)
    book: Gradebook = class_.do(lambda it: gradebook(it, "robots"))
    for form, expected in WRITTEN.items():
        written = b"".join(written_gradebook(book, form)).decode()
        assert written.splitlines() == expected, form


@pytest.mark.parametrize("class_", ["postgresql"], indirect=True)
def test_postgresql_neither_sorts_nor_hashes_the_attempts(class_: Class) -> None:
    class_.assign()
    class_.assign(id="second")

    def plan(connection: Connection) -> str:
        asked: list[tuple[str, Any]] = []

        @event.listens_for(connection, "before_cursor_execute")
        def note(*given: Any) -> None:
            asked.append((given[2], given[3]))

        gradebook(connection, "robots")
        [(statement, values)] = [each for each in asked if "array_agg" in each[0]]
        lines = connection.exec_driver_sql(f"EXPLAIN {statement}", values).scalars()
        return "\n".join(lines)

    told = class_.do(plan)
    assert "Index Only Scan using ix_attempts_assignment" in told
    assert "Sort" not in told
    assert "Hash" not in told


# --- Read the gradebook's workbook with the standard library

_NAMES = {
    "m": "http://schemas.openxmlformats.org/spreadsheetml/2006/main",
    "r": "http://schemas.openxmlformats.org/officeDocument/2006/relationships",
}
FORMULA = '=HYPERLINK("https://evil.example";"Grade")'


def sheets(content: bytes) -> dict[str, list[list[str | float | None]]]:
    """Return the cells of each sheet of a workbook."""
    with zipfile.ZipFile(io.BytesIO(content)) as file:
        parts = {name: ElementTree.fromstring(file.read(name)) for name in file.namelist()}
    texts = ["".join(each.itertext()) for each in parts["xl/sharedStrings.xml"]]
    named = parts["xl/workbook.xml"].iterfind(".//m:sheet", _NAMES)
    assert not any("externalLink" in name for name in parts)
    found = {}
    for i, sheet in enumerate(named, start=1):
        part = parts[f"xl/worksheets/sheet{i}.xml"]
        for hostile in ("f", "hyperlink", "dataValidation"):
            assert part.find(f".//m:{hostile}", _NAMES) is None
        rows = part.iterfind(".//m:row", _NAMES)
        found[sheet.attrib["name"]] = [_row(row, texts) for row in rows]
        # A row without cells is not in the file.
        places = [int(row.attrib["r"]) for row in part.iterfind(".//m:row", _NAMES)]
        assert places == list(range(1, len(places) + 1))
    return found


def _row(row: ElementTree.Element, texts: list[str]) -> list[str | float | None]:
    cells: dict[int, str | float] = {}
    for cell in row.iterfind("m:c", _NAMES):
        place = 0
        for letter in re.sub("[0-9]", "", cell.attrib["r"]):
            place = 26 * place + ord(letter) - ord("A") + 1
        value = float(cell.findtext("m:v", namespaces=_NAMES) or "nan")
        cells[place - 1] = texts[int(value)] if cell.get("t") == "s" else value
    return [cells.get(i) for i in range(max(cells) + 1)]


def as_tutor(class_: Class, course: str | None = "robots") -> Class:
    text, until = new_key_text(), NOW + timedelta(days=1)
    digest = SECRET.key_digest(text)
    class_.do(lambda it: add_key(it, "", digest, {Scope.TUTOR}, None, NOW, until, course))
    return replace(class_, keys={**class_.keys, "tutor": text})


@pytest.fixture
def graded(class_: Class) -> Any:
    class_.assign(due=days(1))
    for key in "ab":
        assert class_.hand_in(key).status_code == 201
    new = [NewLearner(learner="grace", name=FORMULA), NewLearner(learner="+1", name="\u202eX")]
    class_.do(partial(roll.add_learners, course_id="robots", new=new))
    return as_tutor(class_)


def test_the_workbook_has_points_and_hand_ins_and_no_formula(graded: Class) -> None:
    answer = graded.ask("GET", "/v1/courses/robots/gradebook?format=xlsx", "tutor")
    assert answer.headers["content-type"].endswith("spreadsheetml.sheet")
    assert answer.headers["content-disposition"].endswith('filename="gradebook-robots.xlsx"')
    assert answer.headers["cache-control"] == "no-store"
    found = sheets(answer.content)
    earned = graded.own()["earned"]
    title = "homework scara"
    assert found["Points"] == [
        ["learner", "name", "email", title, "total"],
        ["grace", FORMULA, None, None, 0.0],
        ["ada", "Ada", None, earned, earned],
        ["+1", "\ufffdX", None, None, 0.0],
    ]
    head, *rows = found["Hand-ins"]
    assert head == ["learner", "name", "email", title, f"{title}, last hand-in"]
    assert [row[3:4] for row in rows] == [[], [2.0], []]
    # A workbook counts the days since 1899-12-30, here on the clocks of Berlin.
    now = datetime.now(ZoneInfo("Europe/Berlin")).replace(tzinfo=UTC)
    last = (now - datetime(1899, 12, 30, tzinfo=UTC)).total_seconds() / 86400
    assert rows[1][4] == pytest.approx(last, abs=0.01, rel=0)


def test_the_workbook_of_one_assignment_has_no_hand_ins_of_another(
    class_: Class, catalogue: Mapping[str, Exercise]
) -> None:
    fill(class_, catalogue)

    def told(only: str | None) -> dict[str, list[list[str | float | None]]]:
        return sheets(class_.do(lambda it: gradebook_workbook(it, "robots", only)))

    def days_at(hour: int) -> float:
        # The clocks of Berlin are an hour ahead in November. Day 0 is 1899-12-30.
        return (
            datetime(2026, 11, 22, 13 + hour, tzinfo=UTC) - datetime(1899, 12, 30, tzinfo=UTC)
        ) / timedelta(days=1)

    def near(*rows: list[float]) -> list[Any]:
        return [pytest.approx(row, abs=1e-6, rel=0) for row in rows]

    both, second = told(None), told("second")
    assert [row[3:] for row in both["Points"][1:]] == near([5, 3, 8], [0, 4, 4])
    assert [row[3:] for row in second["Points"][1:]] == near([3, 3], [4, 4])
    # Hand-ins: for each column the number and the last time.
    assert [row[3:] for row in both["Hand-ins"][1:]] == near(
        [2, days_at(1), 1, days_at(2)], [1, days_at(3), 1, days_at(4)]
    )
    assert [row[3:] for row in second["Hand-ins"][1:]] == near([1, days_at(2)], [1, days_at(4)])


def test_the_titles_and_the_learners_stay_in_view(class_: Class) -> None:
    content = class_.do(lambda it: gradebook_workbook(it, "robots"))
    with zipfile.ZipFile(io.BytesIO(content)) as file:
        for name in ("sheet1", "sheet2"):
            sheet = ElementTree.fromstring(file.read(f"xl/worksheets/{name}.xml"))
            pane = sheet.find(".//m:pane", _NAMES)
            assert pane is not None
            # One row of titles, and the learner's name, full name and address.
            assert (pane.attrib["ySplit"], pane.attrib["xSplit"]) == ("1", "3")


def test_the_workbook_is_laid_out_to_be_read(
    class_: Class, catalogue: Mapping[str, Exercise], monkeypatch: pytest.MonkeyPatch
) -> None:
    # Without a disk for temporary files, as in a container that may only read.
    monkeypatch.setattr(tempfile, "tempdir", "/nowhere")
    fill(class_, catalogue)
    content = class_.do(lambda it: gradebook_workbook(it, "robots"))
    texts = sheets(content)
    with zipfile.ZipFile(io.BytesIO(content)) as file:
        styles = ElementTree.fromstring(file.read("xl/styles.xml"))
        numbers = {each.attrib["numFmtId"]: each.attrib["formatCode"]
                   for each in styles.iterfind(".//m:numFmt", _NAMES)}  # fmt: skip
        is_bold = [font.find("m:b", _NAMES) is not None for font in
                   styles.iterfind("m:fonts/m:font", _NAMES)]  # fmt: skip
        formats = list(styles.iterfind("m:cellXfs/m:xf", _NAMES))
        for i, (name, rows) in enumerate(texts.items(), start=1):
            sheet = ElementTree.fromstring(file.read(f"xl/worksheets/sheet{i}.xml"))
            head, *others = (
                [formats[int(cell.get("s", "0"))] for cell in row.iterfind("m:c", _NAMES)]
                for row in sheet.iterfind(".//m:row", _NAMES)
            )
            assert all(is_bold[int(each.attrib["fontId"])] for each in head)
            told = [[numbers.get(each.attrib["numFmtId"]) for each in row] for row in others]
            # Two assignments, each with a number and a time.
            times = [None, "yyyy-mm-dd hh:mm"] * 2 if name == "Hand-ins" else [None] * 3
            assert told == [[None, None, *times]] * 2
            # Each title fits into its column; the names of persons have more room.
            columns = [
                (int(each.attrib["min"]), int(each.attrib["max"]), float(each.attrib["width"]))
                for each in sheet.iterfind("m:cols/m:col", _NAMES)
            ]
            widths = [width for first, last, width in columns for _ in range(first, last + 1)]
            assert len(widths) == len(rows[0])
            assert all(
                max(12, len(str(text))) <= width < max(32, len(str(text)) + 1)
                for text, width in zip(rows[0], widths, strict=True)
            )
            assert widths[0] < widths[1] < widths[2]


def test_only_tutors_of_the_course_get_the_workbook(graded: Class) -> None:
    other = as_tutor(graded, "others")
    path = "/v1/courses/robots/gradebook?format=xlsx"
    assert [graded.ask("GET", path, by).status_code for by in ("ada", "tutor")] == [403, 200]
    assert other.ask("GET", path, "tutor").status_code == 403


def test_the_command_writes_the_workbook_of_an_assignment(
    graded: Class, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DH_GRADER_DATABASE", str(graded.store.engine.url.database))
    file = tmp_path / "grades.xlsx"
    words = ["courses", "gradebook", "robots", "--format", "xlsx", "--output", str(file)]
    assert CliRunner().invoke(program, [*words, "--assignment", "homework"]).exit_code == 0
    assert sheets(file.read_bytes())["Points"][2][:2] == ["ada", "Ada"]
    assert CliRunner().invoke(program, [*words, "--assignment", "none"]).exit_code == 2
