"""Test what all formats have in common."""

import io
import re
import unicodedata
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.formats import FORMAT_NAMES, documents, report_format, terminal
from dh_grader.formats.class_page import (
    WRITTEN,
    feedback_zip,
    is_document,
    is_earlier_output,
    is_output,
)
from dh_grader.formats.documents import HTML
from dh_grader.formats.graded import (
    GradedSubmission,
    ReportFormat,
    UnusableSettingError,
    report_in,
    with_texts,
)
from dh_grader.formats.texts import distinct_names
from dh_grader.grading import (
    Correction,
    Feedback,
    FeedbackLevel,
    LittleWorth,
    Place,
    Severity,
    Submission,
    grade,
)
from dh_grader.submissions.files import MAX_START, all_handed_in
from dh_grader.translations import ENGLISH, LANGUAGES, say

from tests.formats.class_of_seven import class_of_seven
from tests.formats.submissions import ROWS, cases, document, graded, setting
from tests.formats.test_worksheets import BLACKBOARD, CANVAS, WORDS, moodle
from tests.submissions.handins.answers import PARTS, right
from tests.submissions.handins.files import KINDS
from tests.together import together
from tests.translations.german import german

# --- Test every report format

SINGLE = {"gradescope", "classroom50", "prairielearn"}
FOR_STUDENTS = {*SINGLE, "html", "junit", "markdown", "github"}


def test_each_format_is_listed() -> None:
    defined = {
        name.lower()
        for module in (documents, terminal)
        for name, value in vars(module).items()
        if isinstance(value, ReportFormat)
    }
    assert set(FORMAT_NAMES) == defined
    assert {"text", "json", "html", "csv"} | SINGLE <= set(FORMAT_NAMES)


def test_documents_for_platforms_contain_one_submission() -> None:
    assert {name for name in FORMAT_NAMES if report_format(name).is_single} == SINGLE
    right, empty = cases()["right"], cases()["empty"]
    for name in SINGLE:
        with pytest.raises(UnusableSettingError, match="one submission"):
            document(name, right, empty)
        with pytest.raises(UnusableSettingError, match="one submission"):
            document(name)


def test_the_formats_for_students_are_known() -> None:
    assert {name for name in FORMAT_NAMES if report_format(name).for_students} == FOR_STUDENTS


def commands(line: str) -> Iterator[str]:
    if line.lstrip().startswith("::"):
        yield line
    yield from re.findall(r"##(?:vso|teamcity|\w*)\[", line)


@pytest.mark.long
@together("case", cases())
@together("name", sorted(FORMAT_NAMES))
def test_no_output_has_commands_or_control_characters(name: str, case: str) -> None:
    printed = document(name, cases()[case])
    if name != "text" or case != "unusable":  # its problem is on standard error
        assert printed.endswith("\n")
    assert printed == document(name, cases()[case])
    kinds = ("Cc", "Cs") if name in ("json", "jsonl") else ("Cc", "Cs", "Cf", "Cn")
    assert {c for c in printed if unicodedata.category(c) in kinds} <= {"\n", "\r"}
    assert "\r" not in printed.replace("\r\n", "")
    if name != "github":
        assert [found for line in re.split("[\r\n]", printed) for found in commands(line)] == []


@pytest.mark.parametrize("name", ["json", "jsonl", "csv", "gradebook", "junit", "text", "html"])
def test_submissions_are_written_while_later_ones_are_graded(name: str) -> None:
    taken = 0

    def many() -> Iterator[GradedSubmission]:
        nonlocal taken
        for i in range(50):
            taken = i
            yield graded({}, f"{i}.json")

    ahead = 0
    for written, _ in enumerate(report_format(name).pieces(many(), setting())):
        ahead = max(ahead, taken - written)
    assert taken == 49
    # The format text waits for nine submissions: then each gets only one line.
    assert ahead <= (8 if name == "text" else 1)


def test_parts_with_the_same_name_get_distinct_names() -> None:
    distinct = distinct_names()
    assert [distinct(name) for name in ("A", "A (2)", "A", "A", "B\n", "B\r")] == [
        "A", "A (2)", "A (3)", "A (4)", "B\ufffd", "B\ufffd (2)",
    ]  # fmt: skip


def test_the_page_on_formats_names_every_format() -> None:
    page = (Path(__file__).parents[2] / "docs" / "formats.md").read_text(encoding="utf-8")
    table = page.partition("| format |")[2].partition("\n\n")[0]
    assert {name for name in FORMAT_NAMES if f"`{name}`" in table} == set(FORMAT_NAMES)
    assert {name for name in FORMAT_NAMES if f"--format {name}" in page} == set(FORMAT_NAMES)


# --- Test the report formats for students in a language other than English

GERMAN = german({
    "{points} points": "{points} Punkte",
    "{points} points, {score}.": "{points} Punkte, {score}.",
    "{share} is needed to pass.": "Zum Bestehen braucht es {share}.",
    "{verdict}: the pass mark is {share}.": "{verdict}: zum Bestehen braucht es {share}.",
    "Counted with your own earlier answer.": "Mit Ihrer eigenen Antwort gerechnet.",
    "No file": "Keine Datei",
    "%(files)s for %(exercise)s, version %(version)s, graded by DH Grader %(grader)s":
        "%(files)s zu %(exercise)s, Fassung %(version)s, bewertet von DH Grader %(grader)s",
    "Not graded": "Nicht bewertet",
    "Not passed": "Nicht bestanden",
    "Nothing was handed in.": "Es wurde nichts abgegeben.",
    "Total for {exercise}: ": "Summe für {exercise}: ",
    "correct": "richtig",
    "incorrect": "falsch",
    "missing": "fehlt",
    "partial": "teils richtig",
    "passed": "bestanden",
    "points": "Punkte",
    "row": "Zeile",
    "row {row}": "Zeile {row}",
    "score": "Ergebnis",
    "submission": "Abgabe",
    "unreadable": "unlesbar",
    "… and {count} more": "… und {count} weitere",
})  # fmt: skip


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("text", ["Summe für planar-rrr: 0 / 16 Punkte, 0 %", "Nicht bestanden: zum Bestehen br"]),
        ("markdown", ["| Abgabe | Punkte | Ergebnis | bestanden |", ":** fehlt, 0 / 8 Punkte"]),
        ("html", ['<html lang="de">', ">Nicht bewertet<",
                  "</span>teils richtig</li>", "folder/anna.json zu planar-rrr, Fassung "]),
        ("gradescope", ["0 / 16 Punkte, 0 %."]),
        ("junit", ['message="fehlt, 0 / 8 Punkte"', ">0 / 8 Punkte\n"]),
        ("github", ["Zum Bestehen braucht es 80 %25.", "title=Nicht bestanden"]),
        ("classroom50", []),
    ],
)  # fmt: skip
def test_a_report_is_told_in_german(name: str, told: list[str]) -> None:
    found = document(name, graded({}), language=GERMAN)
    for each in (*told, "Es wurde nichts abgegeben."):
        assert each in found
    for english in ("Nothing was", " points", "assed:", "missing,"):
        assert english not in found


def test_a_table_is_told_in_german() -> None:
    submission = graded({"table": {"rows": [*ROWS[:3], {**ROWS[3], "a": "0"}]}})
    shown = document("html", submission, language=GERMAN)
    assert '<th scope="col">Zeile</th>' in shown
    assert '<th scope="col">Punkte</th>' in shown
    assert '<td class="incorrect"><div class="cell"><span class="sign" title="falsch">' in shown
    markdown = document("markdown", submission, language=GERMAN)
    assert "| Zeile | a | alpha | d | theta | Punkte |" in markdown
    text = document("text", submission, language=GERMAN)
    assert "✓ richtig   ~ teils richtig" in text or "✓ richtig   ✗ falsch" in text


# --- Reports are translated into the reader's language

TOLD_REPORT_WORDS = {
    "Joint {joint} slides.": "Gelenk {joint} gleitet.",
    "Exchange {cells}.": "Vertausche {cells}.",
    "{first} and {last}": "{first} und {last}",
    "no answer": "keine Antwort",
    "row {row} is worth little": "Zeile {row} ist wenig wert",
}


def test_every_text_for_people_is_told(catalogue: Mapping[str, Exercise]) -> None:
    cells = say("{first} and {last}", first="a", last="d")
    in_words = Correction(say("Exchange {cells}.", cells=cells))
    formula = Correction("pi/2", r"\frac{\pi}{2}")
    message = Feedback(
        "slip",
        Severity.ERROR,
        say("Joint {joint} slides.", joint=3),
        places=(Place("1", "a", in_words), Place("2", "a", formula)),
        correction=in_words,
    )
    submission = Submission({"table": "0 0 0 q1\n0 0 0 q1"}, feedback=FeedbackLevel.VERDICTS)
    report = grade(catalogue["planar-rr"], submission)
    part, *more = report.parts
    assert part.rows
    cell = replace(part.rows[0].cells[0], feedback=(message,))
    row = replace(part.rows[0], feedback=(message,), cells=(cell, *part.rows[0].cells[1:]))
    worth = LittleWorth(("1",), 0.5, say("row {row} is worth little", row=1))
    lost = (replace(part.lost[0], message=say("no answer")),)
    part = replace(part, rows=(row,), feedback=(message,), lost=lost, little_worth=worth)
    told = report_in(replace(report, parts=(part, *more)), german(TOLD_REPORT_WORDS)).parts[0]

    [shown_row] = told.rows
    for shown in (told.feedback, shown_row.feedback, shown_row.cells[0].feedback):
        assert shown[0].message == "Gelenk 3 gleitet."
        assert shown[0].correction == Correction("Vertausche a und d.")
        assert shown[0].places is not None
        assert [place.correction for place in shown[0].places] == [
            Correction("Vertausche a und d."),
            formula,
        ]
    assert told.lost[0].message == "keine Antwort"
    assert told.little_worth is not None
    assert told.little_worth.message == "Zeile 1 ist wenig wert"


def test_english_returns_the_same_report(catalogue: Mapping[str, Exercise]) -> None:
    report = grade(catalogue["planar-rr"], Submission({"table": "0 0 0 q1\n0 0 0 q1"}))
    assert report_in(report, ENGLISH) is report
    assert with_texts(report, str) == report


# --- The program recognises its own documents, and nothing that students hand in


@pytest.mark.long
@together("name", sorted(FORMAT_NAMES))
@together("case", cases())
def test_every_document_of_every_format_is_recognised(name: str, case: str) -> None:
    written = document(name, cases()[case])
    # The text report on an unusable file is empty: its problem is on standard error.
    assert not written or is_document(written.encode(errors="replace")[:MAX_START])


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_documents_of_a_class_are_recognised_in_every_language(language: str) -> None:
    own = setting(language=LANGUAGES[language])
    for name in FORMAT_NAMES:
        if not report_format(name).is_single:
            for submissions in (class_of_seven(), class_of_seven() * 2):
                pieces = report_format(name).pieces(submissions, own)
                assert is_document(b"".join(pieces)[:MAX_START]), name


def left_out(folder: Path) -> tuple[Sequence[str], Sequence[str]]:
    """Return the names of the entries that are left out, and the learners."""
    outputs: list[str] = []
    found = all_handed_in([folder], is_output=is_output, outputs=outputs)
    learners = [each.learner for each in found]
    return sorted(Path(path).name for path in outputs), learners


def write_all(folder: Path) -> list[str]:
    """Write all outputs and worksheets into a folder; return the names of its entries."""
    own = setting()
    for name in FORMAT_NAMES:
        given = class_of_seven()[:1] if report_format(name).is_single else class_of_seven()
        content = b"".join(report_format(name).pieces(given, own))
        (folder / f"out-{name}").write_bytes(content)
    (folder / "feedback.zip").write_bytes(
        b"".join(feedback_zip(class_of_seven(), own, HTML.pieces))
    )
    assert HTML.folder is not None
    with zipfile.ZipFile(folder / "all.zip", "w") as archive:
        for each in HTML.folder(class_of_seven(), own):
            content = b"".join(each.pieces)
            for path in (folder / "class" / each.path, folder / "pages" / Path(each.path).name):
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(content)
            archive.writestr(each.path, content)
    (folder / "pages" / "index.html").rename(folder / "overview.html")
    for i, words in enumerate(WORDS.values()):
        (folder / f"Grades {i}.csv").write_bytes(moodle(words))
    (folder / "Canvas.csv").write_text(CANVAS, encoding="utf-8")
    (folder / "gc_HW1.xls").write_bytes(BLACKBOARD.encode("utf-16"))
    return sorted(path.name for path in folder.iterdir())


def test_all_outputs_and_worksheets_in_the_folder_of_a_class_are_left_out(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    names = write_all(tmp_path / "in")
    (tmp_path / "in" / "anna.csv").write_text("a, alpha, d, theta\n0, 0, 0, q1\n", encoding="utf-8")
    assert left_out(tmp_path / "in") == (names, ["anna"])
    # The tutor packs the folder, and unpacks it elsewhere.
    with zipfile.ZipFile(tmp_path / "again.zip", "w") as archive:
        for path in (tmp_path / "in").rglob("*"):
            archive.write(path, f"in/{path.relative_to(tmp_path / 'in')}")
    assert left_out(tmp_path / "again.zip") == (names, ["anna"])


def test_what_a_run_has_written_into_the_folder_of_a_student_leaves_the_student(
    tmp_path: Path,
) -> None:
    (tmp_path / "anna").mkdir()
    (tmp_path / "anna" / "table.csv").write_text("0", encoding="utf-8")
    (tmp_path / "anna" / "page.html").write_text("0", encoding="utf-8")
    (tmp_path / "anna" / WRITTEN).write_text("page.html\n", encoding="utf-8")
    assert left_out(tmp_path) == ([], ["anna"])


@pytest.mark.long
def test_no_hand_in_of_a_student_is_taken_for_an_output(tmp_path: Path) -> None:
    rng = np.random.default_rng(4)
    count = 0
    for exercise, parts in PARTS.items():
        for part in parts:
            answer = right(exercise, part)
            for kind in KINDS:
                made = kind.make(answer, rng)
                if not made.target:
                    (tmp_path / f"s{count}{made.ending}").write_bytes(made.content)
                    count += 1
    assert count > 500
    names, learners = left_out(tmp_path)
    assert names == []
    assert len(learners) == count


@pytest.mark.parametrize(
    "content", [b"a;b\n1;2\n", b"PK\x03\x04", b"# notes\n\nanswers", b"{}", b"[]", b"\xff\xfe"]
)
def test_a_file_of_somebody_else_is_no_earlier_output(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "file"
    file.write_bytes(content)
    assert not is_earlier_output(file)
    file.write_bytes(b"")
    assert is_earlier_output(file)


def test_a_worksheet_is_no_earlier_output(tmp_path: Path) -> None:
    file = tmp_path / "Grades.csv"
    file.write_bytes(moodle(WORDS["en"]))
    assert not is_earlier_output(file)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("Ada_1_assignsubmission_file_/table.csv", "0")
    file.write_bytes(packed.getvalue())
    assert not is_earlier_output(file)
