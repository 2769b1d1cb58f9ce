"""Answer kind ``link_transforms``: the matrices A_1 … A_n that a table's rows stand for."""

from dataclasses import dataclass, replace

import numpy as np

from service.catalogue.parts.link_transforms import LinkTransformsSpec
from service.expressions import Vocabulary, read
from service.grading.feedback import Finding
from service.grading.judging.own_frames.frame_freedom import Freedom
from service.grading.judging.own_frames.row_roles import Role
from service.grading.judging.table import nearest_reading
from service.grading.kinds.matrix_rows import (
    PATIENCE,
    ExpectedMatrix,
    UnreadableMatrixError,
    judged_matrix,
    numbers_of,
    read_matrix,
)
from service.grading.kinds.transform import HOMOGENEOUS
from service.grading.part import Grading, PartTerms
from service.grading.reading.entry import Entry
from service.grading.reading.table import HandedInRow
from service.grading.report import (
    CellReport,
    Feedback,
    PartReport,
    RowReport,
    Verdict,
)
from service.grading.samples import SAMPLES
from service.kinematics.chain import links
from service.kinematics.dh import link_transforms
from service.kinematics.dh_row import row as dh_row
from service.kinematics.transforms import Matrices

SAME = 1e-6

# A number that was worked out of a matrix stands for a cell that was read.
_WORKED_OUT = Entry(read(0, Vocabulary([])))


@dataclass(frozen=True, slots=True)
class ReadLinks:
    """A list of matrices as read: entries, and values ``(k, SAMPLES, 4, 4)``, NaN where unread."""

    entries: list[list[list[Entry]]]
    values: Matrices


@dataclass(frozen=True, slots=True)
class LinkTransformsKind:
    """Grades each link transform in the frames that the student's table chose, or in valid ones."""

    def grade(self, part: LinkTransformsSpec, answer: object, grading: Grading) -> PartReport:
        """The report on the matrices, rows "A1.1" to "An.4"."""
        terms = PartTerms(part.id, part.kind, part.points, part.all_or_nothing)
        labels = grading.exercise.robot.tables[part.convention].labels
        found = read_links(part, answer, grading)
        if found is None:
            return terms.unread(Verdict.UNREADABLE, grading.visible((_wrong_shape(labels),)))
        expected = np.moveaxis(_expected(part, found, grading), 1, -1)
        rows: list[RowReport] = []
        told: list[Feedback] = []
        for label, entries, values in zip(labels, found.entries, expected, strict=True):
            share = part.points / len(labels)
            matrix = ExpectedMatrix(values, HOMOGENEOUS, rigid=True)
            patience = PATIENCE / len(labels)
            judged = judged_matrix(entries, matrix, share, grading, patience=patience)
            rows.extend(_named(row, label) for row in judged.rows)
            told.extend(_placed(message, label) for message in judged.feedback)
        return terms.report(tuple(rows), tuple(told))


def read_links(part: LinkTransformsSpec, answer: object, grading: Grading) -> ReadLinks | None:
    """The matrices of an answer, one for each row of the table; None where it is no such list.

    A matrix that cannot be read is one of missing entries.
    """
    wanted = len(grading.exercise.robot.tables[part.convention].rows)
    if not isinstance(answer, list) or not 0 < len(answer) <= wanted:
        return None
    entries = []
    for matrix in [*answer, *[[None] * 4] * (wanted - len(answer))]:
        try:
            entries.append(read_matrix(matrix, HOMOGENEOUS, grading.reader))
        except UnreadableMatrixError:
            return None
    values = [numbers_of(matrix, HOMOGENEOUS, grading.reader) for matrix in entries]
    return ReadLinks(entries, np.moveaxis(np.array(values), -1, 1))


def _expected(part: LinkTransformsSpec, found: ReadLinks, grading: Grading) -> Matrices:
    """What each matrix must be, ``(k, SAMPLES, 4, 4)``."""
    reference = grading.exercise.robot.tables[part.convention]
    source, wanted = grading.source, len(reference.rows)
    if source is not None and grading.following and len(source.frames) == wanted + 1:
        return source.links
    if part.frames == "free":
        if source is not None and source.nearest_links is not None:
            if len(source.nearest_links) == wanted:
                return source.nearest_links
        else:
            return _nearest_links(part, found, grading)
    return links(reference.values(grading.samples.values, SAMPLES), part.convention)


def _nearest_links(part: LinkTransformsSpec, found: ReadLinks, grading: Grading) -> Matrices:
    """The link transforms of the valid table nearest to the matrices themselves.

    Each matrix that is a link transform gives its row; one that is not tells nothing.
    """
    joints = grading.exercise.robot.joints
    roles = tuple(
        Role(_row(matrix, part), joints[i] if i < len(joints) else None)
        for i, matrix in enumerate(found.values)
    )
    reading = nearest_reading(roles, part.convention, Freedom(), grading)
    return links(reading.expected, part.convention)


def _row(matrix: Matrices, part: LinkTransformsSpec) -> HandedInRow | None:
    if np.isnan(matrix).any():
        return None
    row = dh_row(matrix, part.convention)
    if np.abs(link_transforms(part.convention, *row) - matrix).max() > SAME:
        return None
    return HandedInRow((_WORKED_OUT,) * 4, row)


def _wrong_shape(labels: tuple[str, ...]) -> Finding:
    return Finding(
        "wrong_shape",
        f"This answer is a list of {len(labels)} matrices, A{labels[0]} to A{labels[-1]}, each "
        f"with 4 rows of 4 entries.",
        reading=True,
    )


def _named(row: RowReport, link: str) -> RowReport:
    label = f"A{link}.{row.label}"
    cells = tuple(
        CellReport(cell.label, cell.verdict, tuple(replace(m, row=label) for m in cell.feedback))
        for cell in row.cells
    )
    messages = tuple(replace(message, row=label) for message in row.feedback)
    return replace(row, label=label, cells=cells, feedback=messages)


def _placed(message: Feedback, link: str) -> Feedback:
    """A message on a whole matrix, with the matrix it is about."""
    row = f"A{link}.{message.row}" if message.row else f"A{link}"
    return replace(message, row=row, message=f"A{link}: {message.message}")
