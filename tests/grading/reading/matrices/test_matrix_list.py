"""Read all link transforms of an arm from one text."""

from collections.abc import Callable, Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport, Verdict
from dh_grader.grading.reading import preview_pasted

from tests.grading.support.exercise_texts import all_codes
from tests.grading.support.submitting import cell, codes, full_marks, handed_in, part
from tests.grading.support.wrist import A4, A5, A6, WRIST

A1 = "[c1 -s1 0 a1*c1; s1 c1 0 a1*s1; 0 0 1 0; 0 0 0 1]"
A2 = "[c2 -s2 0 a2*c2; s2 c2 0 a2*s2; 0 0 1 0; 0 0 0 1]"


@pytest.fixture
def arm(catalogue: Mapping[str, Exercise]) -> Exercise:
    # Return an arm with two revolute joints, whose tool frame is the frame of the second link.
    return catalogue["planar-rr"]


def pasted(arm: Exercise, answer: object) -> PartReport:
    return part(handed_in(arm, {"links": answer}), "links")


@pytest.mark.parametrize(
    ("text", "notes"),
    [
        (f"A1 = {A1}\nA2 = {A2}", set()),
        (f"{A1}\n{A2}", set()),
        (f"A2 = {A2}; A1 = {A1};", {"matrix_order"}),
        (f"A0 = {A1}\nA1 = {A2}", {"matrix_names"}),
        (f"A1 = {A1}\nA2 = {A2}\nT = {A1}", {"matrix_left_aside"}),
        (f"T01 = {A1}\nT12 = {A2}\nT02 = {A1}", {"matrix_left_aside"}),
        (f"A1 = {A1}\n{A2}", set()),
        (f"T = {A1}\nR = {A2}", set()),
        (f"theta1 = pi/2\nA1 = {A1}\nA2 = {A2}", {"matrix_left_aside"}),
        (f"H1 = {A1}, H2 = {A2}, H1*H2 = T", {"matrix_left_aside"}),
        (f"H1 = {A1}\nH2 = {A2}\nH1*H2 = {A1}", {"matrix_left_aside"}),
        (f"A1 = {A1}\nA2 = {A2}\ninv(A1) = {A1}", {"matrix_left_aside"}),
        (f"T12 = {A1}\nT23 = {A2}", {"matrix_names"}),
    ],
)
def test_matrices_in_another_order_get_full_marks_and_a_note(
    text: str, notes: set[str], arm: Exercise
) -> None:
    report = pasted(arm, text)
    assert full_marks(report), report
    assert all_codes(report) == notes | {"blank_before_sign"}


@pytest.mark.parametrize(
    ("text", "code", "marked"),
    [
        (f"A1 = {A1}\nA1 = {A2}", "duplicate_matrix", "A1"),
        (f"A1 = {A1}\nA7 = {A2}", "unknown_matrix", "A7"),
        (f"A1 = {A1}\nT = {A2}\nB = {A2}", "unknown_matrix", "B"),
        (f"inv(A1) = {A1}\nA2 = {A2}", "unknown_matrix", "inv(A1)"),
        (f"A1' = {A1}\nA2 = {A2}", "unknown_matrix", "A1'"),
        (f"A1 = {A1}\nA2.T = {A2}", "unknown_matrix", "A2.T"),
        (f"{A1}\n{A2}\n{A1}", "wrong_shape", A1[1:-1]),
        ("see the attached file", "wrong_shape", "see the attached file"),
        (f"A1 = {A1[:-1]}\nA2 = {A2}", "unbalanced_bracket", "["),
    ],
)
def test_matrices_that_cannot_be_identified_are_refused(
    text: str, code: str, marked: str, arm: Exercise
) -> None:
    report = pasted(arm, text)
    [feedback] = report.feedback
    assert (report.verdict, feedback.code) == (Verdict.UNREADABLE, code)
    assert feedback.span is not None
    assert text[slice(*feedback.span)] == marked


@pytest.mark.parametrize(
    ("answer", "notes"),
    [
        ([f"A2 = {A2}", f"A1 = {A1}"], {"matrix_order"}),
        ([f"A1 = {A1}", f"A2 = {A2}"], set()),
        ([f"T = {A1}", f"R = {A2}"], set()),
        ([f"T12 = {A1}", f"T23 = {A2}"], {"matrix_names"}),
    ],
)
def test_texts_in_a_list_are_ordered_by_their_names(
    answer: list[str], notes: set[str], arm: Exercise
) -> None:
    report = pasted(arm, answer)
    assert full_marks(report), report
    assert all_codes(report) == notes | {"blank_before_sign"}


@pytest.mark.parametrize("names", ["A6 A4 A5", "T56 T34 T45", "T_6^5 T_4^3 T_5^4", "A3 A1 A2"])
def test_links_may_have_the_numbers_of_the_joints(
    names: str, make_exercise: Callable[[str], Exercise]
) -> None:
    wrist = make_exercise(WRIST)
    texts = [f"{name} = {a}" for name, a in zip(names.split(), (A6, A4, A5), strict=True)]
    for answer in (texts, "\n".join(texts)):
        report = pasted(wrist, answer)
        assert full_marks(report), report
        assert all_codes(report) == {"matrix_order"}


def test_a_list_of_texts_under_the_wrong_names_is_wrong(arm: Exercise) -> None:
    report = pasted(arm, [f"A2 = {A1}", f"A1 = {A2}"])
    assert (report.verdict, report.points) == (Verdict.INCORRECT, 0)


@pytest.mark.parametrize(
    ("answer", "code"),
    [
        ([f"A1 = {A1}", f"A1 = {A2}"], "duplicate_matrix"),
        ([f"inv(A1) = {A1}", f"A2 = {A2}"], "unknown_matrix"),
        ([f"A1 = {A1}", f"A5 = {A2}"], "unknown_matrix"),
    ],
)
def test_contradicting_names_in_a_list_are_refused(
    answer: list[str], code: str, arm: Exercise
) -> None:
    report = pasted(arm, answer)
    [feedback] = report.feedback
    assert (report.verdict, feedback.code, feedback.span) == (Verdict.UNREADABLE, code, None)


def test_a_product_is_not_a_link(arm: Exercise) -> None:
    report = pasted(arm, f"A1 = {A1}\nA1*A2 = {A2}")
    assert [row.verdict for row in report.rows] == [Verdict.CORRECT] * 4 + [Verdict.MISSING] * 4


def test_an_unreadable_matrix_affects_only_itself(arm: Exercise) -> None:
    for answer in (f"A1 = {A1}\nA2 = {A2}'", [A1, f"{A2}'"]):
        report = pasted(arm, answer)
        assert [row.verdict for row in report.rows] == (
            [Verdict.CORRECT] * 4 + [Verdict.UNREADABLE] * 4
        )
        assert codes(cell(report, "A2.1", "1")) == ["text_around"]
        assert codes(cell(report, "A2.1", "2")) == []
        assert 0 < report.points < report.max_points


def test_a_matrix_of_the_wrong_size_affects_only_itself(arm: Exercise) -> None:
    report = pasted(arm, f"A1 = {A1}\nA2 = [1 2; 3 4]")
    assert codes(cell(report, "A2.1", "1")) == ["wrong_shape"]
    assert report.rows[0].verdict is Verdict.CORRECT


def test_an_absent_matrix_is_missing(arm: Exercise) -> None:
    report = pasted(arm, f"A2 = {A2}")
    assert [row.verdict for row in report.rows] == [Verdict.MISSING] * 4 + [Verdict.CORRECT] * 4


def test_an_empty_paste_is_missing(arm: Exercise) -> None:
    assert pasted(arm, " \n").verdict is Verdict.MISSING


def test_a_span_counts_in_the_whole_text(arm: Exercise) -> None:
    text = f"A1 = {A1}\nA2 = {A2.replace('a2*s2', 'foo')}"
    [feedback] = cell(pasted(arm, text), "A2.2", "4").feedback
    assert feedback.span is not None
    assert text[slice(*feedback.span)] == "foo"


def test_the_preview_has_the_rows_of_the_report(arm: Exercise) -> None:
    text = f"A2 = {A2}\nA1 = {A1}"
    shown = preview_pasted(text, arm, "links")
    assert shown.ok
    assert [row[0].row for row in shown.rows] == [row.label for row in pasted(arm, text).rows]
    assert [row[0].typed for row in shown.rows] == ["c1", "s1", "0", "0", "c2", "s2", "0", "0"]
    assert "matrix_order" in {note.code for note in shown.notes}


def test_the_preview_shows_unreadable_cells(arm: Exercise) -> None:
    [*rows, last] = preview_pasted(f"A1 = {A1}\nA2 = {A2}'", arm, "links").rows
    assert len(rows) == 4
    assert [(each.row, each.problem.code) for each in last if each.problem] == [
        ("A2", "text_around")
    ]
    problem = preview_pasted(f"A1 = {A1}\nA1 = {A2}", arm, "links").problem
    assert problem is not None
    assert problem.code == "duplicate_matrix"


def test_a_note_on_the_reading_is_shown_once(arm: Exercise) -> None:
    report = pasted(arm, f"A1 = {A1}\nA2 = {A2}")
    assert [message.code for message in report.feedback] == ["blank_before_sign"]
