"""Answer kind ``link_transforms``: one matrix A_i for each row of a DH table."""

from dataclasses import dataclass
from functools import partial

import numpy as np

from service.catalogue.parts.link_transforms import LinkTransformsSpec
from service.catalogue.robots.formulas import HOMOGENEOUS
from service.grading.diagnosis.matrices.link_slips import LinkAmongOthers, explain_link
from service.grading.diagnosis.matrices.matrix_case import Explanation, MatrixCase
from service.grading.diagnosis.matrices.matrix_entry import WORK_BUDGET
from service.grading.diagnosis.upstream.all_links import explain_links
from service.grading.diagnosis.upstream.slipped_link import slipped_link
from service.grading.feedback import Finding, UnreadableAnswerError, reading_error
from service.grading.follow_through import stands_still
from service.grading.judging.content import of_links
from service.grading.judging.matrix import ExpectedMatrix
from service.grading.judging.own_frames.best_roles import nearest_with_tool_row
from service.grading.judging.own_frames.row_roles import FrameFreedom, Role
from service.grading.kinds.shared.matrix_rows import matrix_rows
from service.grading.numerics.samples import SAMPLES, Samples
from service.grading.numerics.tolerances import LINK_TRANSFORM
from service.grading.part import Content, Grading, Judged, StudentChain
from service.grading.reading.matrices.matrix import StudentMatrix, read_matrix, unreadable_matrix
from service.grading.reading.matrices.matrix_list import places_in_list, read_matrices, with_notes
from service.grading.reading.tables.table import StudentRow, computed_row
from service.grading.report import Feedback, RowReport
from service.kinematics.chain import links, products
from service.kinematics.dh import link_transforms
from service.kinematics.dh_row import row as dh_row
from service.kinematics.transforms import Matrices, Numbers, inverse
from service.translations import say


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
    """Read the matrices of a list or of one pasted text, one for each row of the table."""
    # The entries of an omitted matrix at the end are missing.
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
    right = _expected(part, answer, grading)
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
            explanations=partial(_as_told, throughout) if throughout else by_others,
            work_budget=WORK_BUDGET / len(labels),
            name=f"A{label}",
        )
        rows.extend(judged.rows)
        messages.extend(judged.feedback)
    return Judged(
        tuple(rows),
        _content(right, part, grading),
        tuple(messages),
        stands_still=stands_still(
            np.array([matrix.with_zeros for matrix in answer.matrices]), HOMOGENEOUS, grading
        ),
        chain=answer.chain,
    )


def _as_told(finding: Finding, case: MatrixCase) -> list[Explanation]:
    return [Explanation(finding, case.mask(...))]


def _by_other_links(
    links: Matrices, part: LinkTransformsSpec, grading: Grading, case: MatrixCase
) -> list[Explanation]:
    # Such a slip is an angle or a factor of the earlier ``links``, which are the correct transforms
    # up to the wrong one.
    joints, count = grading.exercise.robot.joints, case.actual.shape[-1] // 2
    link = LinkAmongOthers.of(links, joints, grading.samples, part.convention, count)
    return explain_link(link, case)


def _content(right: Matrices, part: LinkTransformsSpec, grading: Grading) -> Content:
    exercise, samples = grading.exercise, grading.samples
    table = exercise.robot.tables[part.convention]
    reference = links(table.values(samples.values, SAMPLES), part.convention)
    return of_links(right, reference, exercise.robot.joints, samples, exercise.length_scale)


def _links_of(values: list[Numbers]) -> Matrices:
    return np.moveaxis(np.array(values), -1, 1)


def _expected(part: LinkTransformsSpec, answer: StudentLinks, grading: Grading) -> Matrices:
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
