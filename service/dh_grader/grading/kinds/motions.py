"""Answer kinds ``screw_axes``, ``link_transforms`` and ``euler_angles``.

Each kind has a function that reads and one that judges (``AnswerKind``). They only put together
what ``reading``, ``judging.py`` and ``diagnosis`` know; the nearest triple of angles is found here.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from dh_grader.catalogue.kinds import EulerAnglesSpec, LinkTransformsSpec, ScrewAxesSpec
from dh_grader.catalogue.robot import HOMOGENEOUS, SCREW, at_home
from dh_grader.grading.diagnosis.lists import WrongTriple, explain_triple, is_arctangent, slips_of
from dh_grader.grading.diagnosis.matrices import WORK_BUDGET
from dh_grader.grading.diagnosis.motions import Explanation, MatrixCase
from dh_grader.grading.diagnosis.products import (
    NOT_AT_HOME,
    LinkAmongOthers,
    explain_link,
    with_joint_variable,
)
from dh_grader.grading.diagnosis.screws_and_placements import (
    WrongScrews,
    explain_screw,
    explain_screws,
)
from dh_grader.grading.diagnosis.upstream import explain_links, slipped_link
from dh_grader.grading.frames import FrameFreedom, Role
from dh_grader.grading.frames.roles import nearest_with_tool_row
from dh_grader.grading.judging import (
    ComparedValues,
    Content,
    ExpectedMatrix,
    Grading,
    Judged,
    StudentChain,
    asked_pose,
    entry_rows,
    formula_values,
    known_cells,
    number_corrections,
    of_links,
    of_list,
    of_rows,
    value_rows,
)
from dh_grader.grading.kinds.matrices import matrix_rows
from dh_grader.grading.marks import stands_still
from dh_grader.grading.misconception import Explained, value_formula
from dh_grader.grading.numbers import (
    EXACT_VALUE,
    LINK_TRANSFORM,
    SAME_TRIPLE,
    SAMPLES,
    Match,
    Samples,
    SharedDecimals,
    difference,
    entry_matches,
    fitted_shifts,
    rounding_slack,
)
from dh_grader.grading.reading.entries import from_grid_error, from_note
from dh_grader.grading.reading.lists import StudentValues, names_of_angles, read_list
from dh_grader.grading.reading.matrices import (
    WIDTH,
    StudentMatrix,
    columns_as_axes,
    matrix_of_entries,
    matrix_of_grid,
    places_in_list,
    read_matrices,
    read_matrix,
    screw_grid,
    screw_rows,
    unreadable_matrix,
    with_notes,
)
from dh_grader.grading.reading.table import StudentRow, computed_row
from dh_grader.grading.report import (
    Correction,
    Feedback,
    Finding,
    Place,
    RowReport,
    Severity,
    UnreadableAnswerError,
    reading_error,
)
from dh_grader.kinematics import (
    Matrices,
    Numbers,
    from_angles,
    inverse,
    is_singular,
    last_angle,
    link_transforms,
    links,
    moved,
    other_triple,
    products,
    to_angles,
)
from dh_grader.kinematics import row as dh_row
from dh_grader.pasting import GridError
from dh_grader.translations import say

# --- Answer kind ``screw_axes``: the screw axis (ω; v) of each joint in the base or tool frame


# The share of the points that a slip in all axes costs, regardless of the number of axes.
COST = 0.25
COSTS = {"body_for_space": 0.5, "space_for_body": 0.5}


@dataclass(frozen=True, slots=True)
class ExpectedScrews:
    """The expected screw axes in the requested frame, and the same axes in the other frame.

    They are ``(joints, 6, SAMPLES)`` each; ``labels`` are the joints' numbers.
    """

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
        columns = _transposed(rows, grading)
        return replace(columns, findings=(*rows.findings, from_note(columns_as_axes(grid))))
    return read_matrix(screw_rows(answer, numbers), quantities, grading.reader)


def _columns_are_axes(part: ScrewAxesSpec, rows: StudentMatrix, grading: Grading) -> bool:
    # As in Lynch & Park, "Modern Robotics". One column may be correct by chance, so the number of
    # correct columns must exceed that of correct rows by two.
    axes = _expected_screws(part, grading).axes
    senses = (1, -1) if part.directions == "free" else (1,)

    def right(matrix: StudentMatrix) -> int:
        found = [_matches(matrix, sense * axes, grading) for sense in senses]
        return int((np.array(found) >= Match.ROUNDED).all(axis=2).any(axis=0).sum())

    return right(_transposed(rows, grading)) >= right(rows) + 2


def _transposed(rows: StudentMatrix, grading: Grading) -> StudentMatrix:
    entries = [list(column) for column in zip(*rows.entries, strict=True)]
    return matrix_of_entries(entries, rows.quantities, grading.reader)


def judge_screw_axes_answer(part: ScrewAxesSpec, answer: StudentMatrix, grading: Grading) -> Judged:
    """Judge the axes; the report has one row for each joint."""
    expected = _expected_screws(part, grading)
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
    explained, cost = _explained_screws(answer, case, grading) if wrong.any() else ({}, None)
    slips = {
        (i, j): slip
        for i in np.flatnonzero(wrong.any(axis=1)).tolist()
        if i not in explained
        for (j, _), slip in _slips_of_screw(answer, i, axes[i], wrong[i], grading).items()
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
    return Judged(rows, of_rows(_known_cells_of_screws(axes, grading)), feedback, whole_cost=cost)


def _explained_screws(
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


def _known_cells_of_screws(axes: Numbers, grading: Grading) -> NDArray[np.bool_]:
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


def _expected_screws(part: ScrewAxesSpec, grading: Grading) -> ExpectedScrews:
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


def _slips_of_screw(
    student: StudentMatrix, i: int, axis: Numbers, wrong: NDArray[np.bool_], grading: Grading
) -> dict[tuple[int, int], Finding]:
    values = StudentValues(student.entries[i], SCREW, student.values[i])
    compared = ComparedValues(values, axis, number_corrections(axis, grading))
    return slips_of(compared, wrong, grading)


# --- Answer kind ``link_transforms``: one matrix A_i for each row of a DH table


@dataclass(frozen=True, slots=True)
class StudentLinks:
    """The k matrices of an answer, and their values ``(k, SAMPLES, 4, 4)``, NaN if unreadable."""

    matrices: tuple[StudentMatrix, ...]
    values: Matrices

    def chain(self) -> StudentChain | None:
        """Return the product of the links; None unless all entries have a value."""
        if np.isnan(self.values).any():
            return None
        return StudentChain(products(self.values), self._frames_at)

    def _frames_at(self, samples: Samples) -> Matrices:
        return products(_links_of([matrix.values_at(samples) for matrix in self.matrices]))


def read_link_transforms_answer(
    part: LinkTransformsSpec, answer: object, grading: Grading
) -> StudentLinks:
    """Read the matrices of a list or of one pasted text, one for each row of the table.

    The entries of an omitted matrix at the end are missing.
    """
    labels = grading.exercise.robot.tables[part.convention].labels
    if isinstance(answer, str):
        matrices = tuple(read_matrices(answer, labels, HOMOGENEOUS, grading.reader))
    else:
        matrices = _listed(answer, labels, grading)
    return StudentLinks(matrices, _links_of([matrix.values for matrix in matrices]))


def _listed(answer: object, labels: tuple[str, ...], grading: Grading) -> tuple[StudentMatrix, ...]:
    if not isinstance(answer, list) or not 0 < len(answer) <= len(labels):
        raise UnreadableAnswerError(_wrong_shape(labels))
    places, notes = places_in_list(answer, labels, grading.reader)
    ordered: list[object] = [[None] * 4] * len(labels)
    for place, matrix in zip(places, answer, strict=True):
        ordered[place] = matrix
    matrices, refused = [], 0
    for matrix in ordered:
        try:
            matrices.append(read_matrix(matrix, HOMOGENEOUS, grading.reader))
        except UnreadableAnswerError as error:
            # A matrix that cannot be read costs only itself.
            matrices.append(unreadable_matrix(error.finding, HOMOGENEOUS, grading.reader))
            refused += not isinstance(matrix, str)
    if refused == len(answer):
        raise UnreadableAnswerError(_wrong_shape(labels))
    return (with_notes(matrices[0], notes), *matrices[1:])


def judge_link_transforms_answer(
    part: LinkTransformsSpec, answer: StudentLinks, grading: Grading
) -> Judged:
    """Judge the matrices; the report has the rows "A1.1" to "An.4"."""
    labels = grading.exercise.robot.tables[part.convention].labels
    right = _expected_links(part, answer, grading)
    rows: list[RowReport] = []
    messages: list[Feedback] = []
    expected = [
        ExpectedMatrix(values, HOMOGENEOUS, rigid=True) for values in np.moveaxis(right, 1, -1)
    ]
    scale = expected[0].scale(grading.exercise.length_scale)
    throughout = explain_links(answer.matrices, answer.values, right, scale, part, grading)
    for i, (label, matrix) in enumerate(zip(labels, answer.matrices, strict=True)):
        by_others = partial(_by_other_links, right[: i + 1], part, grading)
        judged = matrix_rows(
            matrix,
            expected[i],
            grading,
            slipped=partial(slipped_link, i, right[i], part.convention, grading),
            explanations=partial(_throughout, throughout) if throughout else by_others,
            work_budget=WORK_BUDGET / len(labels),
            name=f"A{label}",
        )
        rows.extend(judged.rows)
        messages.extend(judged.feedback)
    return Judged(
        tuple(rows),
        _content_of_links(right, part, grading),
        tuple(messages),
        stands_still=stands_still(
            np.array([matrix.with_zeros for matrix in answer.matrices]), HOMOGENEOUS, grading
        ),
        chain=answer.chain,
    )


def _throughout(finding: Finding, case: MatrixCase) -> list[Explanation]:
    return [Explanation(finding, case.mask(...))]


def _by_other_links(
    links: Matrices, part: LinkTransformsSpec, grading: Grading, case: MatrixCase
) -> list[Explanation]:
    # Such a slip is an angle or a factor of the earlier ``links``, which are the correct transforms
    # up to the wrong one.
    joints, count = grading.exercise.robot.joints, case.actual.shape[-1] // 2
    link = LinkAmongOthers.of(links, joints, grading.samples, part.convention, count)
    return explain_link(link, case)


def _content_of_links(right: Matrices, part: LinkTransformsSpec, grading: Grading) -> Content:
    exercise, samples = grading.exercise, grading.samples
    table = exercise.robot.tables[part.convention]
    reference = links(table.values(samples.values, SAMPLES), part.convention)
    return of_links(right, reference, exercise.robot.joints, samples, exercise.length_scale)


def _links_of(values: list[Numbers]) -> Matrices:
    return np.moveaxis(np.array(values), -1, 1)


def _expected_links(part: LinkTransformsSpec, answer: StudentLinks, grading: Grading) -> Matrices:
    reference = grading.exercise.robot.tables[part.convention]
    chain, wanted = grading.student_chain, len(reference.rows)
    if chain is not None and grading.following and len(chain.frames) == wanted + 1:
        return chain.links
    if part.frames == "free":
        if chain is None or chain.nearest_links is None:
            return _nearest_links(part, answer, grading)
        if len(chain.nearest_links) == wanted:
            return chain.nearest_links
    return links(reference.values(grading.samples.values, SAMPLES), part.convention)


def _nearest_links(part: LinkTransformsSpec, answer: StudentLinks, grading: Grading) -> Matrices:
    # Each matrix that is a link transform gives a row of the table; the other rows are missing.
    joints = grading.exercise.robot.joints
    roles = tuple(
        Role(_row(matrix, part), joints[i] if i < len(joints) else None)
        for i, matrix in enumerate(_completed(answer.values, part, grading))
    )
    reading = nearest_with_tool_row(roles, part.convention, FrameFreedom(), grading)
    return links(reading.expected, part.convention)


def _completed(values: Matrices, part: LinkTransformsSpec, grading: Grading) -> Matrices:
    # A single unreadable matrix is computed from the others.
    unread = np.flatnonzero(np.isnan(values).any(axis=(1, 2, 3)))
    if len(unread) != 1:
        return values
    reference = grading.exercise.robot.tables[part.convention]
    tool = products(links(reference.values(grading.samples.values, SAMPLES), part.convention))[-1]
    [i] = unread
    completed = values.copy()
    before, after = products(values[:i])[-1], products(values[i + 1 :])[-1]
    completed[i] = inverse(before) @ tool @ inverse(after)
    return completed


def _row(matrix: Matrices, part: LinkTransformsSpec) -> StudentRow | None:
    if np.isnan(matrix).any():
        return None
    row = dh_row(matrix, part.convention)
    if np.abs(link_transforms(part.convention, *row) - matrix).max() > LINK_TRANSFORM:
        return None
    return computed_row(row)


def _wrong_shape(labels: tuple[str, ...]) -> Finding:
    first, last = f"A{labels[0]}", f"A{labels[-1]}"
    message = say(
        "Write {number} matrices, {first} to {last}, each with 4 rows of 4 entries.",
        number=len(labels),
        first=first,
        last=last,
    )
    if len(labels) == 2:
        message = say(
            "Write 2 matrices, {first} and {last}, each with 4 rows of 4 entries.",
            first=first,
            last=last,
        )
    return reading_error("wrong_shape", message)


# --- Answer kind ``euler_angles``: three angles that describe a rotation
#
# Every triple of angles that gives the rotation is correct. A wrong triple is compared with the
# nearest correct triple.


SINGULAR = Finding(
    "singular_orientation",
    say(
        "Here the first and the third axis lie in one line. Only the sum or the difference of the "
        "outer angles counts: any pair that fits is right."
    ),
    severity=Severity.INFO,
)


def read_euler_angles_answer(
    part: EulerAnglesSpec, answer: object, grading: Grading
) -> StudentValues:
    """Read the angles in a list or a pasted text."""
    names = names_of_angles(part.turns, fixed=part.axes == "fixed")
    return read_list(answer, names, grading.reader)


def judge_euler_angles_answer(
    part: EulerAnglesSpec, answer: StudentValues, grading: Grading
) -> Judged:
    """Judge the angles; the report has one row for each angle."""
    turns, fixed = part.turns, part.axes == "fixed"
    angles, rotation = answer.values, _expected_rotation(part, grading)
    slack = [rounding_slack(each, grading.samples) if each else 0.0 for each in answer.expressions]
    expected = nearest_triple(angles, rotation, turns, fixed=fixed, slack=slack)
    found = _matches_of_angles(answer, expected, rotation, part, grading)
    slips: dict[tuple[int, int], Finding] = {}
    findings: tuple[Finding, ...] = ()
    if is_singular(turns, rotation, fixed=fixed).all():
        findings = (SINGULAR,)
    if (found < Match.ROUNDED).any() and np.isfinite(angles).all():
        arctangents = [bool(each and is_arctangent(each.tree)) for each in answer.expressions]
        case = WrongTriple(angles, rotation, turns, fixed, arctangents)
        found, slips, explained = _explained_angles(found, explain_triple(case))
        findings += explained
    if not findings or findings[-1] is SINGULAR:
        slips = {**_slips_of_angles(answer, expected, found, grading), **slips}
    rows = value_rows(answer, found, slips, grading)
    return Judged(rows, _content_of_angles(expected, rotation, part), grading.messages(findings))


def _content_of_angles(expected: Numbers, rotation: Matrices, part: EulerAnglesSpec) -> Content:
    # The angles that are not 0. At most as many count as in the simplest triple of the rotation.
    fixed = part.axes == "fixed"
    simplest = nearest_triple(np.zeros_like(expected), rotation, part.turns, fixed=fixed)
    known, most = (known_cells(triple, 0.0, angle=True) for triple in (expected, simplest))
    return of_list(known, most)


def _expected_rotation(part: EulerAnglesSpec, grading: Grading) -> Matrices:
    given = formula_values(part, grading)
    if given is None:
        return asked_pose(part, grading)[:, :3, :3]
    return from_angles(part.turns, given[0].T, fixed=part.axes == "fixed")


def _matches_of_angles(
    student: StudentValues,
    expected: Numbers,
    rotation: Matrices,
    part: EulerAnglesSpec,
    grading: Grading,
) -> NDArray[np.int_]:
    # Angles that give the rotation all match.
    angles = student.values
    found = entry_matches(student.expressions, angles, expected, 1.0, grading.samples, angle=True)
    if np.isfinite(angles).all():
        described = from_angles(part.turns, angles.T, fixed=part.axes == "fixed")
        if np.abs(described - rotation).max() < EXACT_VALUE:
            return np.full(3, int(Match.EXACT))
        if (found < Match.ROUNDED).any() and _are_rounded(student, rotation, part, grading):
            return np.where(found == Match.EXACT, found, int(Match.ROUNDED))
    return found


def _are_rounded(
    student: StudentValues, rotation: Matrices, part: EulerAnglesSpec, grading: Grading
) -> bool:
    # In a singular orientation only a sum of angles matters, so that single angles may be
    # arbitrary.
    decimals = SharedDecimals(student.expressions, grading.samples)
    if not decimals.count:
        return False

    def errors(shifts: Numbers) -> Numbers:
        angles = decimals.shifted(shifts, student.values)
        described = from_angles(part.turns, np.swapaxes(angles, 1, 2), fixed=part.axes == "fixed")
        return np.asarray((described - rotation).reshape(len(shifts), -1))

    return fitted_shifts(errors, decimals.units, EXACT_VALUE) is not None


def nearest_triple(
    angles: Numbers,
    rotation: Matrices,
    sequence: str,
    *,
    fixed: bool = False,
    slack: Sequence[float] = (0.0, 0.0, 0.0),
) -> Numbers:
    """Return the triple ``(3, SAMPLES)`` of ``rotation`` that is nearest to ``angles``.

    The nearest triple has the fewest different angles; a NaN does not count as different. ``slack``
    is the rounding error of each angle.
    """
    if fixed:
        return nearest_triple(angles[::-1], rotation, sequence[::-1], slack=slack[::-1])[::-1]
    one = to_angles(sequence, rotation)
    singular = is_singular(sequence, rotation)
    if singular.any():
        one = np.where(singular[:, None], _singular_triple(angles, one, rotation, sequence), one)
    both = np.stack([one, np.where(singular[:, None], one, other_triple(sequence, one))])
    off = np.nan_to_num(np.abs(difference(angles.T, both, angle=True)))
    hit = off <= np.maximum(slack, SAME_TRIPLE)
    return np.asarray(both[_family(off, hit), np.arange(len(one))].T)


def _family(off: Numbers, hit: NDArray[np.bool_]) -> NDArray[np.int_]:
    # For each of the two triples of a rotation, ``off`` is the distance of each angle from the
    # triple's angle, and ``hit`` is a mask of equal angles, both ``(2, SAMPLES, 3)``. The choice
    # makes as many angles as possible correct at all samples.
    total, samples = off.sum(axis=-1), np.arange(off.shape[1])
    for count in (3, 2, 1):
        fits = [hit[..., list(each)].all(axis=-1) for each in combinations(range(3), count)]
        sides = [
            np.where(fit, total, np.inf).argmin(axis=0) for fit in fits if fit.any(axis=0).all()
        ]
        if sides:
            return min(sides, key=lambda side: float(total[side, samples].sum()))
    return np.asarray(total.argmin(axis=0))


def _singular_triple(angles: Numbers, one: Numbers, rotation: Matrices, sequence: str) -> Numbers:
    # The first angle is as the student wrote it.
    first = np.where(np.isfinite(angles[0]), angles[0], one[:, 0])
    last = last_angle(sequence, np.stack([first, one[:, 1]], axis=-1), rotation)
    if not np.isfinite(angles[0]).all():
        last = np.where(np.isfinite(angles[2]), angles[2], last)
    return np.stack([first, one[:, 1], last], axis=-1)


def _explained_angles(
    found: NDArray[np.int_], explained: Explained | None
) -> tuple[NDArray[np.int_], dict[tuple[int, int], Finding], tuple[Finding, ...]]:
    if explained is None:
        return found, {}, ()
    slipped = explained.entries
    if not isinstance(slipped, np.ndarray):
        return found, {}, explained.findings
    [finding] = explained.findings
    matched = np.where(slipped, int(Match.DIFFERENT), int(Match.EXACT))
    return matched, {(int(i), 0): finding for i in np.flatnonzero(slipped)}, ()


def _slips_of_angles(
    student: StudentValues, expected: Numbers, found: NDArray[np.int_], grading: Grading
) -> dict[tuple[int, int], Finding]:
    wrong = found < Match.ROUNDED
    corrections: list[Correction | None] = [None] * len(expected)
    if wrong.any() and grading.corrects:
        exercise, samples = grading.exercise, grading.samples
        spelling = grading.spelling(student.entries)
        corrections = [
            value_formula(angle, True, exercise, samples, spelling) if is_wrong else None
            for angle, is_wrong in zip(expected, wrong, strict=True)
        ]
    return slips_of(ComparedValues(student, expected, corrections), wrong, grading)
