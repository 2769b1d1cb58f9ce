"""Test reports as text and as Markdown."""

import io
import re
from collections.abc import Iterator
from gettext import NullTranslations
from typing import Any

import pytest
from dh_grader.formats.terminal import AlignedColumn, AlignedTable, write
from dh_grader.formats.texts import (
    escaped,
    marks,
    messages,
    places_in_words,
    points,
    sentence,
    visible,
    whole_percent,
    whole_score,
)
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
from dh_grader.grading.report import CELLS, WHOLE, lost_in_row, lost_points
from dh_grader.translations import say
from markdown_it import MarkdownIt
from markdown_it.token import Token
from rich.console import Console
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from tests.formats.submissions import HOSTILE, cases, document

# --- Test the report for a terminal

# The tests build reports by hand, without grading.

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


# --- Test reports in Markdown

# They are parsed as CommonMark with the extensions of GitHub.

READER = MarkdownIt("commonmark", {"html": True}).enable(["table", "strikethrough"])
# The tokens of the format itself. Any other token would come from a text.
MEANT = {"text", "code_inline", "strong_open", "strong_close", "softbreak"}


def tokens(text: str) -> Iterator[Token]:
    for token in READER.parse(text):
        yield token
        yield from token.children or ()


def inline(text: str) -> list[Token]:
    return [child for token in READER.parse(text) for child in token.children or ()]


def shown(text: str) -> str:
    return "".join(token.content for token in inline(text))


@pytest.mark.parametrize("case", cases())
@pytest.mark.parametrize("name", ["markdown", "gradescope"])
def test_no_text_becomes_markup(name: str, case: str) -> None:
    page = document("markdown", cases()[case])
    found = {token.type for token in inline(page)}
    assert found <= MEANT, found - MEANT
    assert {token.type for token in tokens(page)}.isdisjoint({"html_block", "fence", "hr", "image"})


@pytest.mark.parametrize("case", cases())
def test_no_text_becomes_a_mention_or_a_link(case: str) -> None:
    # GitHub looks for mentions in the rendered text, outside of code.
    texts = [each.content for each in inline(document("markdown", cases()[case]))]
    plain = [
        token.content
        for token in inline(document("markdown", cases()[case]))
        if token.type == "text"
    ]
    assert texts
    assert [found for text in plain for found in re.findall(r"@\w|#\d", text)] == []
    # GitHub looks for bare links in the source.
    source = re.sub("`[^`]*`", "", document("markdown", cases()[case]))
    assert re.findall(r"www\.|https?://", source) == []


def test_an_escaped_text_is_shown_unchanged() -> None:
    for text in ("_a_ * b_c ~x~ <b> &amp; | \\ [x](y) `z`", "1. x", "# x", "http://x.y", "a_1"):
        assert shown(f"x {escaped(text)}") == f"x {text}"
    seen = shown(f"x {escaped(HOSTILE)}")
    assert "<script>alert(1)</script>" in seen
    assert "**bold** _em_ ~~s~~ `code` ![i](http://e.vil)" in seen


def test_backticks_in_a_message_enclose_code() -> None:
    assert [(each.type, each.content) for each in inline(sentence("write `a*b`, not `<b>`"))] == [
        ("text", "write "), ("code_inline", "a*b"), ("text", ", not "), ("code_inline", "<b>"),
    ]  # fmt: skip
    assert [each.content for each in inline(sentence("`a``b`"))] == ["a", " ", "b"]
    for hostile in ("`a``<b>`", "``<b>``", "`<b>", "```<b>```", "`a```<b>`"):
        assert {each.type for each in inline(f"x {sentence(hostile)}")} <= {"text", "code_inline"}


def test_a_table_of_submissions_precedes_the_parts_of_each() -> None:
    page = document("markdown", cases()["wrong"], cases()["unusable"])
    cells = [
        token.content
        for before, token in zip(READER.parse(page), READER.parse(page)[1:], strict=False)
        if before.type in ("th_open", "td_open")
    ]
    assert cells[:12] == [
        "submission", "points", "score", "passed",
        "folder/anna.json", "11 / 16", "68.7 %", "✗",
        "folder/b.json", "", "not graded", "✗",
    ]  # fmt: skip
    assert "✗ row 2 alpha: " in shown(page)


# --- An AlignedTable looks exactly like a table printed by Rich

COLUMNS = (
    AlignedColumn("row"),
    AlignedColumn("alpha", "center"),
    AlignedColumn("q", "center"),
    AlignedColumn("pts", "right"),
)
ROWS = (
    (("1", ""), ("✓", "green"), ("?", "red"), ("1.5 / 2", "")),
    (("e", ""), ("", ""), ("中文", ""), ("2", "")),
)


def printed(what: object, width: int) -> str:
    file = io.StringIO()
    console = Console(file=file, width=width, force_terminal=True, legacy_windows=False)
    console.print(what, width=width)
    return file.getvalue()


@pytest.mark.parametrize("width", [10, 24, 29, 30, 80])
def test_a_table_looks_like_richs_own_table(width: int) -> None:
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="dim")
    for column in COLUMNS:
        no_wrap = column.justify == "right"
        table.add_column(column.heading, justify=column.justify, no_wrap=no_wrap)
    for row in ROWS:
        table.add_row(*(Text(*cell) for cell in row))
    expected = printed(Padding(table, (0, 0, 0, 2), expand=False), width)
    console = Console(width=width)
    assert printed(AlignedTable(COLUMNS, ROWS).on(console, width, 2), width) == expected


# --- Test messages of a report as plain text, in two languages

GERMAN = {
    "row {rows} {columns}": "Zeile {rows} {columns}",
    "rows {rows}": "Zeilen {rows}",
    "columns {columns}": "Spalten {columns}",
    "The sign is wrong.": "Das Vorzeichen ist falsch.",
    "Did you mean {suggestion}?": "War {suggestion} gemeint?",
    "It should be {formula}.": "Richtig ist {formula}.",
    "(with {values}, yours gives {yours}, not {right})": "({yours} statt {right} bei {values})",
    "Nothing was handed in.": "Es wurde nichts abgegeben.",
    "{cells} in row {row}": "{cells} in Zeile {row}",
    "mistakes that run through the answer, charged once for the whole part (its rows "
    "share the loss)": "durchgehende Fehler",
}


class German(NullTranslations):
    """Translates a few sentences into German."""

    def gettext(self, message: str) -> str:
        return GERMAN.get(message, message)

    def ngettext(self, one: str, many: str, count: int) -> str:
        return self.gettext(one if count == 1 else many)


def part_with_messages(
    *feedback: Feedback, verdict: Verdict = Verdict.INCORRECT, **given: Any
) -> PartReport:
    return PartReport("p", "matrix", verdict, 0.0, 1.0, False, (), feedback, **given)


SIGN = Feedback(
    "sign",
    Severity.ERROR,
    say("The sign is wrong."),
    places=(Place("2", "1"), Place("2", "3")),
    suggestion="l1",
    correction=Correction("-l1", "-l_1"),
    values={"l1": 0.5, "yours": 0.5, "expected": -0.5},
)


def test_a_message_is_a_line_in_english() -> None:
    [message] = messages(part_with_messages(SIGN))
    assert message.line == (
        "row 2 columns 1, 3: The sign is wrong. Did you mean l1? It should be -l1. "
        "(with l1 = 0.5, yours gives 0.5, not -0.5)"
    )


def test_a_message_is_a_line_in_the_language() -> None:
    [message] = messages(part_with_messages(SIGN), German())
    assert message.line == (
        "Zeile 2 Spalten 1, 3: Das Vorzeichen ist falsch. War l1 gemeint? Richtig ist -l1. "
        "(0.5 statt -0.5 bei l1 = 0.5)"
    )
    [nothing] = messages(part_with_messages(verdict=Verdict.MISSING), German())
    assert nothing.text == "Es wurde nichts abgegeben."


@pytest.mark.parametrize("translation", [None, German()])
def test_a_question_that_the_message_asks_is_not_repeated(translation: German | None) -> None:
    question = say("Did you mean {suggestion}?", suggestion="l1")
    asked = Feedback("x", Severity.ERROR, say("No. {question}", question=question), suggestion="l1")
    [message] = messages(part_with_messages(asked), translation)
    assert message.offers == ""


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"q1": 0.5}, "(with q1 = 0.5)"),
        ({"q1": 0.5, "yours": 2.0}, "(with q1 = 0.5, yours gives 2.0)"),
        ({"yours": 0.0}, "(yours gives 0.0)"),
        ({"yours": 2.0, "expected": 0.0}, "(yours gives 2.0, not 0.0)"),
        ({}, ""),
    ],
)
def test_a_counterexample_names_what_it_has(values: dict[str, float | str], text: str) -> None:
    [message] = messages(
        part_with_messages(Feedback("value", Severity.ERROR, "No.", values=values))
    )
    assert message.example == text


def test_lost_points_have_their_places_in_the_language() -> None:
    cells = (CellReport("a", Verdict.INCORRECT), CellReport("d", Verdict.CORRECT))
    row = lost_in_row(RowReport("2", Verdict.PARTIAL, 0.5, 1.0, cells), 0.5)
    report = part_with_messages(lost=(row, lost_points(WHOLE, 0.25)))
    assert marks(report, translation=German()) == ["−0.5: a in Zeile 2; −0.25: durchgehende Fehler"]
    assert row.code == CELLS


def test_places_without_cells_are_rows() -> None:
    assert places_in_words([]) == ""
    assert places_in_words([Place("1"), Place("3")]) == "rows 1, 3"
    assert places_in_words([Place("1", "d"), Place("2")]) == "row 1 d; row 2"


def test_a_message_on_all_cells_of_a_row_is_told_once() -> None:
    unread = Feedback("row_length", Severity.ERROR, say("The row is too short."))
    other = Feedback("sign", Severity.ERROR, say("The sign is wrong."))
    unreadable = Verdict.UNREADABLE

    def row(label: str, *found: Feedback | None) -> RowReport:
        cells = [
            CellReport(name, unreadable, (each,) if each else ())
            for name, each in zip("abc", found, strict=True)
        ]
        return RowReport(label, unreadable, 0.0, 1.0, tuple(cells), ())

    rows = (
        row("1", unread, unread, unread),
        row("2", unread, None, unread),
        row("3", other, None, other),
    )
    report = PartReport("p", "matrix", unreadable, 0.0, 1.0, False, rows, ())
    assert [message.line for message in messages(report)] == [
        "row 1: The row is too short.",
        "row 2 a, c: The row is too short.",
        "row 3 a, c: The sign is wrong.",
    ]


# --- Write fractions and scores in per cent


@pytest.mark.parametrize(
    ("share", "rounded", "cut"),
    [
        (4 / 6, "67 %", "66 %"),
        (5 / 6, "83 %", "83 %"),
        (0.995, "99 %", "99 %"),
        (0.796, "80 %", "79 %"),
        (0.29, "29 %", "29 %"),
        (1.0, "100 %", "100 %"),
        (0.0, "0 %", "0 %"),
    ],
)
def test_a_share_is_rounded_and_a_score_never_up(share: float, rounded: str, cut: str) -> None:
    assert (whole_percent(share), whole_score(share)) == (rounded, cut)
