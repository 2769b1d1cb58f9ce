"""Test messages of a report as plain text, in two languages."""

from gettext import NullTranslations
from typing import Any

import pytest
from dh_grader.formats.texts import marks, messages, places_in_words
from dh_grader.grading import Correction, Feedback, PartReport, Place, Severity, Verdict
from dh_grader.grading.report import CELLS, WHOLE, CellReport, RowReport, lost_in_row, lost_points
from dh_grader.translations import say

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


def part(*feedback: Feedback, verdict: Verdict = Verdict.INCORRECT, **given: Any) -> PartReport:
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
    [message] = messages(part(SIGN))
    assert message.line == (
        "row 2 columns 1, 3: The sign is wrong. Did you mean l1? It should be -l1. "
        "(with l1 = 0.5, yours gives 0.5, not -0.5)"
    )


def test_a_message_is_a_line_in_the_language() -> None:
    [message] = messages(part(SIGN), German())
    assert message.line == (
        "Zeile 2 Spalten 1, 3: Das Vorzeichen ist falsch. War l1 gemeint? Richtig ist -l1. "
        "(0.5 statt -0.5 bei l1 = 0.5)"
    )
    [nothing] = messages(part(verdict=Verdict.MISSING), German())
    assert nothing.text == "Es wurde nichts abgegeben."


@pytest.mark.parametrize("translation", [None, German()])
def test_a_question_that_the_message_asks_is_not_repeated(translation: German | None) -> None:
    question = say("Did you mean {suggestion}?", suggestion="l1")
    asked = Feedback("x", Severity.ERROR, say("No. {question}", question=question), suggestion="l1")
    [message] = messages(part(asked), translation)
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
    [message] = messages(part(Feedback("value", Severity.ERROR, "No.", values=values)))
    assert message.example == text


def test_lost_points_have_their_places_in_the_language() -> None:
    cells = (CellReport("a", Verdict.INCORRECT), CellReport("d", Verdict.CORRECT))
    row = lost_in_row(RowReport("2", Verdict.PARTIAL, 0.5, 1.0, cells), 0.5)
    report = part(lost=(row, lost_points(WHOLE, 0.25)))
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
