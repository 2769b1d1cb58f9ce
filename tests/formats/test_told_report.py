"""Reports are translated into the reader's language."""

from collections.abc import Mapping
from dataclasses import replace

from dh_grader.catalogue import Exercise
from dh_grader.formats.graded import report_in, with_texts
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
from dh_grader.translations import ENGLISH, say

from tests.translations.german import german

WORDS = {
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
    told = report_in(replace(report, parts=(part, *more)), german(WORDS)).parts[0]

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
