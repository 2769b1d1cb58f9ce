"""Answer kind ``screw_axes``: the screw axis (ω; v) of each joint in the base or tool frame."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from service.catalogue.parts.screw_axes import ScrewAxesSpec
from service.catalogue.robots.formulas import SCREW
from service.catalogue.robots.robot import at_home
from service.expressions import Note
from service.grading.diagnosis.lists.value_list import slips_of
from service.grading.diagnosis.matrices.home_position import NOT_AT_HOME, with_joint_variable
from service.grading.diagnosis.screws.all_screws import WrongScrews, explain_screws
from service.grading.diagnosis.screws.screw_axis import explain_screw
from service.grading.feedback import Finding, UnreadableAnswerError
from service.grading.judging.content import known_cells, of_rows
from service.grading.judging.expected import formula_values
from service.grading.judging.report_rows import entry_rows
from service.grading.judging.value_list import ComparedValues, number_corrections
from service.grading.numerics.comparison import Match, entry_matches
from service.grading.numerics.samples import SAMPLES, Samples
from service.grading.part import Grading, Judged
from service.grading.reading.entry import from_note
from service.grading.reading.lists.value_list import StudentValues
from service.grading.reading.matrices.matrix import (
    StudentMatrix,
    matrix_of_entries,
    matrix_of_grid,
    read_matrix,
)
from service.grading.reading.matrices.screw_list import (
    WIDTH,
    columns_as_axes,
    screw_grid,
    screw_rows,
)
from service.grading.reading.pasted import from_grid_error
from service.grading.report import Feedback, Place, Severity
from service.grids import GridError
from service.kinematics.screws import moved
from service.kinematics.transforms import Numbers, inverse
from service.translations import say

# The share of the points that a slip in all axes costs, regardless of the number of axes.
COST = 0.25
COSTS = {"body_for_space": 0.5, "space_for_body": 0.5}


@dataclass(frozen=True, slots=True)
class ExpectedScrews:
    """The expected screw axes in the requested frame, and the same axes in the other frame."""

    # ``(joints, 6, SAMPLES)`` each; ``labels`` are the joints' numbers.
    axes: Numbers
    elsewhere: Numbers | None
    labels: tuple[str, ...]


def read_screw_axes_answer(part: ScrewAxesSpec, answer: object, grading: Grading) -> StudentMatrix:
    """Read a six-vector for each joint, in a list or a pasted text."""
    numbers = part.numbers(grading.exercise.joints)
    quantities = (SCREW,) * len(numbers)
    if isinstance(answer, str) and answer.strip():
        try:
            grid = screw_grid(answer, numbers, grading.reader)
        except GridError as error:
            raise UnreadableAnswerError(from_grid_error(error, answer)) from error
        rows = matrix_of_grid(grid, quantities, grading.reader)
        if len(numbers) != WIDTH or not _columns_are_axes(part, rows, grading):
            return rows
        return _by_columns(rows, columns_as_axes(grid), grading)
    return read_matrix(screw_rows(answer, numbers), quantities, grading.reader)


def _columns_are_axes(part: ScrewAxesSpec, rows: StudentMatrix, grading: Grading) -> bool:
    # As in Lynch & Park, "Modern Robotics". One column may be correct by chance, so the number of
    # correct columns must exceed that of correct rows by two.
    axes = _expected(part, grading).axes
    senses = (1, -1) if part.directions == "free" else (1,)

    def right(matrix: StudentMatrix) -> int:
        found = [_matches(matrix, sense * axes, grading) for sense in senses]
        return int((np.array(found) >= Match.ROUNDED).all(axis=2).any(axis=0).sum())

    return right(_transposed(rows, grading)) >= right(rows) + 2


def _transposed(rows: StudentMatrix, grading: Grading) -> StudentMatrix:
    entries = [list(column) for column in zip(*rows.entries, strict=True)]
    return matrix_of_entries(entries, rows.quantities, grading.reader)


def _by_columns(rows: StudentMatrix, note: Note, grading: Grading) -> StudentMatrix:
    columns = _transposed(rows, grading)
    return replace(columns, findings=(*rows.findings, from_note(note)))


def judge_screw_axes_answer(part: ScrewAxesSpec, answer: StudentMatrix, grading: Grading) -> Judged:
    """Judge the axes; the report has one row for each joint."""
    expected = _expected(part, grading)
    axes = expected.axes
    found = _matches(answer, axes, grading)
    remarks: dict[int, Finding] = {}
    if part.directions == "free":
        turned = _matches(answer, -axes, grading)
        better = (turned >= Match.ROUNDED).sum(axis=1) > (found >= Match.ROUNDED).sum(axis=1)
        found = np.where(better[:, None], turned, found)
        axes = np.where(better[:, None, None], -axes, axes)
        remarks = {int(i): REVERSED for i in np.flatnonzero(better)}
    wrong = found < Match.ROUNDED
    case = WrongScrews(
        answer.values, axes, _scale(grading), wrong, expected.elsewhere, frame=part.frame
    )
    explained, cost = _explained(answer, case, grading) if wrong.any() else ({}, None)
    slips = {
        (i, j): slip
        for i in np.flatnonzero(wrong.any(axis=1)).tolist()
        if i not in explained
        for (j, _), slip in _slips(answer, i, axes[i], wrong[i], grading).items()
    }
    shared, of_single_rows = _shared_messages(explained, wrong, expected.labels, grading)
    remarks = {i: remark for i, remark in remarks.items() if i not in explained}
    rows = entry_rows(
        answer.entries,
        found,
        slips,
        grading,
        labels=expected.labels,
        remarks={**remarks, **of_single_rows},
    )
    feedback = (*grading.messages(answer.findings), *shared)
    return Judged(rows, of_rows(_known(axes, grading)), feedback, whole_cost=cost)


def _explained(
    answer: StudentMatrix, case: WrongScrews, grading: Grading
) -> tuple[dict[int, Finding], float | None]:
    # If one slip explains all wrong axes, the cost is its share of the points; otherwise it is
    # None.
    wrong = np.flatnonzero(case.wrong.any(axis=1)).tolist()
    if (throughout := explain_screws(case)) is not None:
        return dict.fromkeys(wrong, throughout), COSTS.get(throughout.code, COST)
    entries = case.wrong & with_joint_variable(answer.entries, grading.exercise)
    moves = np.asarray(entries.any(axis=1))
    explained: dict[int, Finding] = {}
    for i in wrong:
        finding = NOT_AT_HOME if moves[i] else explain_screw(case.axis(i))
        if finding is not None:
            explained[i] = finding
    is_one_slip = bool(moves[wrong].all()) and _is_right_at_home(answer, case, grading)
    return explained, COST if is_one_slip else None


def _is_right_at_home(answer: StudentMatrix, case: WrongScrews, grading: Grading) -> bool:
    exercise, samples = grading.exercise, grading.samples
    home = at_home(exercise.joints, samples.values, SAMPLES)
    values = answer.values_at(Samples(home))
    return bool(case.agree(values, case.expected).all())


def _shared_messages(
    explained: Mapping[int, Finding],
    wrong: NDArray[np.bool_],
    labels: Sequence[str],
    grading: Grading,
) -> tuple[tuple[Feedback, ...], dict[int, Finding]]:
    shared: list[Feedback] = []
    alone: dict[int, Finding] = {}
    for finding in dict.fromkeys(explained.values()):
        axes = [i for i, each in explained.items() if each == finding]
        places = tuple(Place(labels[i], str(j + 1)) for i in axes for j in np.flatnonzero(wrong[i]))
        if len(axes) > 1:
            shared += grading.messages((finding,), places)
        else:
            alone[axes[0]] = finding
    return tuple(shared), alone


def _known(axes: Numbers, grading: Grading) -> NDArray[np.bool_]:
    # A cell that earns points differs from 0 and from the cell of the frame's own z axis.
    turns = np.abs(axes[:, :3]).max(axis=(1, 2)) > 0
    lazy = np.where(turns[:, None], [0, 0, 1, 0, 0, 0], [0, 0, 0, 0, 0, 1])
    scale = _scale(grading)
    return known_cells(axes, lazy[..., None], scale) & known_cells(axes, 0.0, scale)


REVERSED = Finding(
    "own_direction",
    say(
        "Your axis points the opposite way. This is valid if the joint variable also has the "
        "opposite sign."
    ),
    severity=Severity.INFO,
)


def _expected(part: ScrewAxesSpec, grading: Grading) -> ExpectedScrews:
    exercise, samples = grading.exercise, grading.samples
    given, robot = formula_values(part, grading), exercise.reference
    if given is not None:
        return ExpectedScrews(given, None, tuple(str(i + 1) for i in range(len(given))))
    if robot is None:
        raise LookupError(f"exercise {exercise.id!r} has no robot")
    home = robot.frame("tool", at_home(robot.joints, samples.values, SAMPLES), SAMPLES)
    space = robot.screws(samples.values, SAMPLES)
    body = moved(inverse(home), space)
    asked, other = (space, body) if part.frame == "space" else (body, space)
    return ExpectedScrews(
        np.swapaxes(asked, 1, 2),
        np.swapaxes(other, 1, 2),
        tuple(str(joint.index) for joint in robot.joints),
    )


def _matches(student: StudentMatrix, expected: Numbers, grading: Grading) -> NDArray[np.int_]:
    return entry_matches(
        student.expressions, student.values, expected, _scale(grading), grading.samples
    )


def _scale(grading: Grading) -> Numbers:
    return np.repeat([1.0, grading.exercise.length_scale], 3)


def _slips(
    student: StudentMatrix, i: int, axis: Numbers, wrong: NDArray[np.bool_], grading: Grading
) -> dict[tuple[int, int], Finding]:
    values = StudentValues(student.entries[i], SCREW, student.values[i])
    compared = ComparedValues(values, axis, number_corrections(axis, grading))
    return slips_of(compared, wrong, grading)
