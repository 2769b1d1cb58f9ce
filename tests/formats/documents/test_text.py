"""Test the report for a terminal."""

# The tests build reports by hand, without grading.

import io

import pytest
from dh_grader.formats.terminal import write
from dh_grader.formats.texts import points, visible
from dh_grader.grading import (
    CellReport,
    Correction,
    Feedback,
    FeedbackLevel,
    PartReport,
    Place,
    ReadEntry,
    Report,
    RowReport,
    Severity,
    Verdict,
)
from rich.console import Console

from tests.formats.submissions import cases, document

V = Verdict
WRONG_TWIST = Feedback(
    "sign",
    Severity.ERROR,
    "Wrong sign.",
    correction=Correction("-90°", r"-90^{\circ}"),
    values={"q1": 0.5, "yours": 2.0, "expected": -2.0},
)
ROUNDED = Feedback("rounded", Severity.INFO, "Rounded.")
EMPTY = Feedback("missing", Severity.ERROR, "Nothing here.", (Place("2", "a"), Place("2", "alpha")))


def report(*parts: PartReport, gradable: bool = True) -> Report:
    return Report("arm", "v1", "1.0", FeedbackLevel.FULL, gradable, 2.5, 8.0, 0.3125, parts)


def part(*rows: RowReport, feedback: tuple[Feedback, ...] = ()) -> PartReport:
    return PartReport("table", "dh_table", V.PARTIAL, 2.5, 4.0, False, rows, feedback)


TABLE = part(
    RowReport(
        "1", V.PARTIAL, 1.5, 2.0,
        (
            CellReport("a", V.CORRECT),
            CellReport("alpha", V.INCORRECT, (WRONG_TWIST,)),
            CellReport("d", V.CORRECT, (ROUNDED,)),
            CellReport("theta", V.UNREADABLE),
        ),
    ),
    RowReport(
        "2", V.MISSING, 0.0, 2.0,
        (
            CellReport("a", V.MISSING), CellReport("alpha", V.MISSING),
            CellReport("d", V.CORRECT), CellReport("theta", V.CORRECT),
        ),
    ),
    feedback=(EMPTY,),
)  # fmt: skip


def text(report: Report, *, width: int = 80, colour: bool = False, encoding: str = "utf-8") -> str:
    raw = io.BytesIO()
    stream = io.TextIOWrapper(raw, encoding=encoding, write_through=True)
    console = Console(
        file=stream, width=width, force_terminal=colour, no_color=not colour, legacy_windows=False
    )
    write(report, console)
    return raw.getvalue().decode(encoding)


def line(page: str, beginning: str) -> str:
    [found] = [each for each in page.splitlines() if each.strip().startswith(beginning)]
    return found


def test_each_row_is_a_line_of_marks_with_its_points() -> None:
    page = text(report(TABLE))
    assert line(page, "table (dh_table)").split() == [
        "table",
        "(dh_table):",
        "partial,",
        "2.5",
        "/",
        "4",
        "points",
    ]
    assert line(page, "row  a").split() == ["row", "a", "alpha", "d", "theta", "points"]
    assert line(page, "1 ").split() == ["1", "✓", "✗", "✓", "?", "1.5", "/", "2"]
    assert line(page, "2 ").split() == ["2", "–", "–", "✓", "✓", "0", "/", "2"]
    assert line(page, "Total").strip() == "Total for arm: 2.5 / 8 points, 31.2 %"


def test_messages_are_below_with_place_and_counterexample() -> None:
    page = text(report(TABLE))
    assert line(page, "✗ row 1 alpha:").strip() == (
        "✗ row 1 alpha: Wrong sign. It should be -90°. (with q1 = 0.5, yours gives 2.0,"
    )
    assert line(page, "info row 1 d:").strip() == "info row 1 d: Rounded."
    assert "not -2.0)" in page
    assert page.index("2    –") < page.index("Wrong sign.")


def test_a_message_has_the_mark_and_the_names_of_its_places() -> None:
    assert line(text(report(TABLE)), "– row 2").strip() == "– row 2 a, alpha: Nothing here."


def said(*places: Place, correction: Correction | None = None) -> str:
    cells = tuple(CellReport(str(j), V.INCORRECT) for j in (1, 2, 3))
    rows = [RowReport(label, V.INCORRECT, 0, 1, cells) for label in ("1", "2", "3")]
    message = Feedback("x", Severity.ERROR, "Bad.", places, correction=correction)
    return line(text(report(part(*rows, feedback=(message,)))), "✗ row").strip()


def cells_of(row: str, *columns: int) -> list[Place]:
    return [Place(row, str(j)) for j in columns]


def test_places_are_grouped_in_few_words() -> None:
    assert said(*cells_of("3", 1, 2)) == "✗ row 3 columns 1, 2: Bad."
    assert said(*cells_of("1", 2), *cells_of("3", 2)) == "✗ rows 1, 3 column 2: Bad."
    assert said(*cells_of("1", 1, 2, 3), *cells_of("2", 1, 2, 3)) == "✗ rows 1, 2: Bad."
    assert said(*cells_of("1", 1, 2, 3), Place("2", "1")) == "✗ row 1; row 2 column 1: Bad."
    assert said(Place("2")) == "✗ row 2: Bad."


def test_each_place_has_its_correction() -> None:
    one, other = Correction("1", "1"), Correction("0", "0")
    places = [Place("1", "1", one), Place("2", "2", one), Place("3", "3", other)]
    message = Feedback("x", Severity.ERROR, "Bad.", tuple(places))
    page = " ".join(text(report(part(*TABLE.rows, feedback=(message,)))).split())
    assert "Bad. row 1 column 1; row 2 column 2: It should be 1. row 3 column 3: It" in page
    assert said(Place("1"), correction=Correction("Exchange a and d.")) == (
        "✗ row 1: Bad. Exchange a and d."
    )


def test_a_repair_is_offered_only_once() -> None:
    for asked in ("Bad.", "Bad. Did you mean q1?"):
        unread = Feedback("x", Severity.ERROR, asked, suggestion="q1")
        assert text(report(part(feedback=(unread,)))).count("Did you mean q1?") == 1


def test_entries_are_shown_as_they_were_read() -> None:
    cells = (CellReport("a", V.CORRECT, read=ReadEntry("l1", "l_{1}")), CellReport("d", V.MISSING))
    page = text(report(part(RowReport("1", V.PARTIAL, 1, 2, cells))))
    assert line(page, "read").split() == ["read", "a", "d"]
    assert line(page, "1     l1").split() == ["1", "l1"]


def test_a_part_that_was_not_handed_in_says_so() -> None:
    missing = PartReport("pose", "transform", V.MISSING, 0, 4, False, ())
    page = text(report(missing, gradable=False))
    assert "pose (transform): missing, 0 / 4 points" in page
    assert "– Nothing was handed in." in page
    assert "It is not answered." in page


@pytest.mark.parametrize("width", [40, 80, 200])
def test_no_line_is_wider_than_the_terminal_or_than_reads_well(width: int) -> None:
    long = Feedback("x", Severity.ERROR, "A word and another. " * 20, (Place("1", "a"),))
    page = text(report(part(*TABLE.rows, feedback=(long,))), width=width)
    assert max(len(each) for each in page.splitlines()) <= min(width, 100)


def test_colours_are_only_used_on_request() -> None:
    assert "\x1b[" not in text(report(TABLE))
    assert "\x1b[" in text(report(TABLE), colour=True)


def test_an_encoding_without_the_marks_gets_ascii() -> None:
    page = text(report(TABLE), encoding="cp1252")
    assert line(page, "1 ").split() == ["1", "+", "x", "+", "?", "1.5", "/", "2"]


def test_student_text_is_neither_terminal_control_nor_markup() -> None:
    hostile = Feedback("x", Severity.ERROR, "[red]\x1b[2J\x07[/red] \u202e\r")
    page = text(report(part(*TABLE.rows, feedback=(hostile,))))
    assert "[red]\ufffd[2J\ufffd[/red] \ufffd\ufffd" in page
    assert visible("θ₁ + 1") == "θ₁ + 1"


def test_points_are_written_short() -> None:
    assert points(1.5, 2.0) == "1.5 / 2"
    assert points(10 / 3, 10.0) == "3.33 / 10"


def test_points_are_not_rounded_up_to_the_maximum() -> None:
    assert points(7.999, 8.0) == "7.99 / 8"
    assert points(8.0, 8.0) == "8 / 8"


def of_class(*names: str) -> str:
    return document("text", *(cases()[name] for name in names))


def test_a_single_submission_has_a_pass_line() -> None:
    assert of_class("right").endswith("\nPassed: the pass mark is 80 %.\n")
    assert of_class("wrong").endswith("\nNot passed: the pass mark is 80 %.\n")
    assert "submissions" not in of_class("right")


def test_several_submissions_have_a_summary() -> None:
    page = of_class("right", "wrong", "wrong", "unusable")
    assert page.count("(dh_table)") == 3
    summary = page[page.index("4 submissions: ") :]
    assert "1 of 3 graded passed (pass mark 80 %), 1 not graded" in summary
    # The twist of link 2 is a quarter turn off, in two submissions.
    assert "   2  α is not right: compare z1 and z2. (quarter_turn in table)" in summary


def test_each_submission_of_a_class_is_one_line() -> None:
    names = ["right", *["wrong"] * 7, "unusable", "unreadable"]
    page = of_class(*names)
    assert "(dh_table)" not in page
    verdicts = [line[:10].strip() for line in page.splitlines()[: len(names)]]
    assert verdicts == ["passed", *["not passed"] * 7, "not graded", "not graded"]
    assert "10 submissions: 1 of 8 graded passed" in page
    assert "What could not be read most often" in page
