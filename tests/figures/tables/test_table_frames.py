"""Test the frames computed from students' tables."""

import numpy as np
import pytest
from dh_grader.figures.table_figure import (
    DrawingScope,
    TableFrames,
    free_scope,
    table_frames,
    table_to_draw,
)
from dh_grader.grading.report import UnreadableAnswerError, WorkBudget
from dh_grader.kinematics import Convention

STANDARD, MODIFIED = Convention


def framed(
    rows: object,
    structure: str,
    amounts: list[list[float]],
    convention: Convention = STANDARD,
    **numbers: float,
) -> TableFrames:
    scope: DrawingScope = free_scope(structure)
    written = table_to_draw(rows, scope, WorkBudget())
    return table_frames(written, convention, scope, scope.numbers(numbers), np.array(amounts))


ELBOW = [["0", "90deg", "d1", "theta1"], ["a2", "0", "0", "q2"]]


def test_the_frames_of_an_elbow_are_those_computed_by_hand() -> None:
    # θ1 = 90° turns the arm to y, and θ2 = 30° raises it.
    found = framed(ELBOW, "RR", [[0, 0], [np.pi / 2, np.pi / 6]], d1=0.5, a2=2)
    assert found.complete
    assert found.frames.shape == (2, 3, 4, 4)
    assert found.frames[0, 0] == pytest.approx(np.eye(4))
    assert found.frames[0, 2, :3, 3] == pytest.approx([2, 0, 0.5])
    assert found.frames[1, 2, :3, 3] == pytest.approx([0, np.sqrt(3), 1.5])
    assert found.frames[1, 1, :3, 2] == pytest.approx([1, 0, 0], abs=1e-12)
    assert found.symbols == {"d1", "a2", "theta1", "theta2"}
    assert (found.freedoms, found.lost) == (2, ())


def test_frames_follow_the_convention_and_the_angle_unit() -> None:
    # In the modified convention, a and α come before d and θ, which gives another arm.
    found = framed(ELBOW, "RR", [[0, 0]], MODIFIED, d1=0.5, a2=2)
    assert found.frames[0, 2, :3, 3] == pytest.approx([2, -0.5, 0])
    scope = free_scope("R")
    amounts = np.zeros((1, 1))
    rows = [["1", "90", "0", "q1"]]
    written = table_to_draw(rows, scope, WorkBudget(), "degrees")
    found = table_frames(written, STANDARD, scope, scope.numbers({}), amounts)
    assert found.frames[0, 1, :3, 2] == pytest.approx([0, -1, 0], abs=1e-12)


def test_pasted_text_is_read_as_grading_reads_it() -> None:
    pasted = framed("i a alpha d theta\n1 0 90° d1 θ1\n2 a2 0 0 θ2", "RR", [[0.3, 0.4]])
    assert pasted.frames == pytest.approx(framed(ELBOW, "RR", [[0.3, 0.4]]).frames)


@pytest.mark.parametrize(
    ("cell", "code", "suggestion"),
    [
        ("a2 +", "trailing_operator", "a2"),
        ("", "missing", None),
        ("1/(q2 - 0.4)", "undefined", None),
        ("1e7 a2", "undefined", None),
        ("q3", "unknown_joint", None),
    ],
)
def test_frames_end_before_a_cell_without_a_number(
    cell: str, code: str, suggestion: str | None
) -> None:
    found = framed([ELBOW[0], [cell, "0", "0", "q2"], ["1", "0", "0", "0"]], "RR", [[0.3, 0.4]])
    assert not found.complete
    assert found.frames.shape == (1, 2, 4, 4)
    [unread] = found.unread
    assert (unread.row, unread.column) == ("2", "a")
    assert (unread.finding.code, unread.finding.suggestion) == (code, suggestion)
    assert found.freedoms is None


@pytest.mark.parametrize(
    ("rows", "structure", "freedoms", "lost"),
    [
        (["0 0 d1 q1", "0 0 0 q2"], "RR", 1, [(1, 2)]),
        (["0 0 q1 0", "a1 0 q2 0", "0 0 0 q3"], "PPR", 2, [(1, 2)]),
        (["a1 0 0 q1", "a2 0 0 0"], "RR", 1, [(2,)]),
        (["a1 0 0 q1", "a2 0 0 q2", "a3 0 0 q3", "a4 0 0 q4"], "RRRR", 3, []),
    ],
)
def test_lost_freedoms_are_named(
    rows: list[str], structure: str, freedoms: int, lost: list[tuple[int, ...]]
) -> None:
    found = framed([row.split() for row in rows], structure, [[0.0] * len(structure)])
    assert found.freedoms == freedoms
    assert [each.joints for each in found.lost] == lost


def test_an_answer_without_rows_is_unreadable() -> None:
    with pytest.raises(UnreadableAnswerError):
        framed(7, "R", [[0]])
    assert framed({"rows": []}, "R", [[0]]).frames.shape == (1, 1, 4, 4)
