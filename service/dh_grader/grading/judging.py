"""Compare a list of lengths, angles and numbers with the expected list."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dh_grader.catalogue import Exercise, Joint, PartSpec, grid_values
from dh_grader.catalogue.part import PosePartSpec
from dh_grader.catalogue.robot import Robot, at_home
from dh_grader.expressions import Kind
from dh_grader.grading.frames.rows import tool_pose
from dh_grader.grading.grading import Content, Grading
from dh_grader.grading.misconception import number_formula
from dh_grader.grading.numbers import (
    SAME_CONTENT,
    SAMPLES,
    Match,
    Samples,
    difference,
    entry_matches,
)
from dh_grader.grading.reading.entries import Entry
from dh_grader.grading.reading.lists import StudentValues
from dh_grader.grading.reading.matrices import StudentMatrix
from dh_grader.grading.report import (
    ROUNDED,
    CellReport,
    Correction,
    Finding,
    Place,
    ReadEntry,
    RowReport,
    Verdict,
    row_report,
)
from dh_grader.kinematics import Matrices, Numbers, inverse


@dataclass(frozen=True, slots=True)
class ComparedValues:
    """The n values of a list as read, and the expected values, ``(n, SAMPLES)`` each.

    ``corrections`` are the expected values as formulas, None for an unknown formula.
    """

    student: StudentValues
    expected: Numbers
    corrections: Sequence[Correction | None] = ()

    def scales(self, grading: Grading) -> Numbers:
        """Return the scale of each value's tolerance."""
        lengths = [quantity == "length" for quantity in self.student.quantities]
        return np.where(lengths, grading.exercise.length_scale, 1.0)

    def matches(self, grading: Grading) -> NDArray[np.int_]:
        """Return the comparison result of each value; angles are equal modulo 2π."""
        student, scales = self.student, self.scales(grading)
        angle = np.array([[quantity == "angle"] for quantity in student.quantities])
        return entry_matches(
            student.expressions, student.values, self.expected, scales, grading.samples, angle
        )


def number_corrections(expected: Numbers, grading: Grading) -> list[Correction | None]:
    """Return the expected values as numbers; None for a value that varies."""
    # All are None if the report shows no corrections.
    return [number_formula(each) if grading.corrects else None for each in expected]


# Make report rows from entries and the results of their comparison.


_EXACT = int(Match.EXACT)

# Findings on single entries, by row and column.
Slips = Mapping[tuple[int, int], Finding]


def entry_rows(
    entries: Sequence[Sequence[Entry]],
    found: NDArray[np.int_],
    slips: Slips,
    grading: Grading,
    *,
    labels: Sequence[str] | None = None,
    remarks: Mapping[int, Finding] | None = None,
) -> tuple[RowReport, ...]:
    """Return report rows of entries; ``found`` has the comparison result of each entry.

    ``remarks`` are findings on whole rows.
    """
    names = labels or [str(i + 1) for i in range(len(entries))]
    columns = tuple([str(j + 1) for j in range(found.shape[1])])

    def report(i: int, row: Sequence[Entry], of_row: list[int]) -> RowReport:
        remark = remarks.get(i) if remarks else None
        if remark is None and is_right_throughout(row, of_row, grading):
            return right_row(names[i], columns)
        cells = [
            cell_report(entry, columns[j], match, slips.get((i, j)), grading)
            for j, (entry, match) in enumerate(zip(row, of_row, strict=True))
        ]
        return row_report(names[i], tuple(cells), grading.messages((remark,)) if remark else ())

    return tuple(
        report(i, row, of_row)
        for i, (row, of_row) in enumerate(zip(entries, found.tolist(), strict=True))
    )


def value_rows(
    student: StudentValues, found: NDArray[np.int_], slips: Slips, grading: Grading
) -> tuple[RowReport, ...]:
    """Return a report row for each of n values; ``found`` ``(n,)`` has the comparison results."""
    column = [[entry] for entry in student.entries]
    return entry_rows(column, found[:, None], slips, grading)


def value_places(marked: NDArray[np.bool_]) -> tuple[Place, ...]:
    """Return the places of the values in a list for which ``marked`` is True."""
    return tuple(Place(str(i + 1), "1") for i in np.flatnonzero(marked).tolist())


@lru_cache(maxsize=64)
def _right(column: str) -> CellReport:
    return CellReport(column, Verdict.CORRECT)


@lru_cache(maxsize=256)
def right_row(label: str, columns: tuple[str, ...]) -> RowReport:
    """Return the report on a row whose entries are all right; the report has no messages."""
    return row_report(label, tuple(map(_right, columns)))


def is_right_throughout(entries: Sequence[Entry], found: list[int], grading: Grading) -> bool:
    """True if a row is correct and has no messages; ``found`` has the comparison results."""
    if grading.echo or found.count(_EXACT) < len(found):
        return False
    return all(entry.expression is not None and not entry.findings for entry in entries)


def cell_report(
    entry: Entry, column: str, match: int, slip: Finding | None, grading: Grading
) -> CellReport:
    """Return the report on an entry; ``column`` is the label of the cell.

    ``match`` is the result of comparing the entry.
    """
    # If a wrong entry has no ``slip``, a message on the part explains it.
    verdict, findings = entry.verdict, entry.findings
    if match == _EXACT and not findings and entry.expression is not None and not grading.echo:
        return _right(column)
    if match == Match.ROUNDED:
        findings = (*findings, ROUNDED)
    elif entry.expression is not None and match < Match.ROUNDED:
        verdict = Verdict.INCORRECT
        if slip is not None:
            findings = (*findings, slip)
    return CellReport(column, verdict, grading.messages(findings), _read(entry, grading))


def _read(entry: Entry, grading: Grading) -> ReadEntry | None:
    if not grading.echo or entry.expression is None:
        return None
    return ReadEntry(entry.expression.text(), entry.expression.latex())


# Compare a matrix with the expected matrix, entry by entry.


@dataclass(frozen=True, slots=True)
class ExpectedMatrix:
    """The correct matrix: the ``values`` and the quantity (length, angle …) of each entry.

    ``rigid`` marks a homogeneous transform (4×4) or a rotation (3×3).
    """

    values: Numbers
    quantities: tuple[tuple[Kind, ...], ...]
    rigid: bool = False

    def scale(self, length_scale: float) -> Numbers:
        """Return the scale of each entry's tolerance, ``(rows, columns)``."""
        return np.array(
            [[length_scale if q == "length" else 1.0 for q in row] for row in self.quantities]
        )

    def matches(
        self, student: StudentMatrix, length_scale: float, samples: Samples
    ) -> NDArray[np.int_]:
        """Compare a student's matrix with this matrix; return the Match (result) of each entry."""
        scale = self.scale(length_scale)
        return entry_matches(student.expressions, student.values, self.values, scale, samples)


# Compute the correct answer to a part of an exercise in numbers.


def formula_values(part: PartSpec, grading: Grading) -> Numbers | None:
    """Return the values of the part's formulas in the exercise file, or None."""
    # ``(rows, columns, SAMPLES)``. Without formulas, the correct answer follows from the robot.
    grid = grading.exercise.formulas.get(part.id)
    return None if grid is None else grid_values(grid, grading.samples.values, SAMPLES)


def given_values(part: PartSpec, grading: Grading) -> Numbers:
    """Return the values of the part's formulas. Raises LookupError if the part has no formulas."""
    values = formula_values(part, grading)
    if values is None:
        raise LookupError(f"part {part.id!r} has no formulas")
    return values


def robot_pose(part: PosePartSpec, exercise: Exercise, samples: Samples) -> Matrices:
    """Return the expected pose ``(SAMPLES, 4, 4)``. Raises LookupError if there is no robot."""
    robot = exercise.reference
    if robot is None:
        raise LookupError(f"exercise {exercise.id!r} has no robot")
    if isinstance(robot, Robot) and is_whole_chain(part, exercise):
        return tool_pose(exercise, samples)
    values = samples.values
    if part.home:
        values = at_home(robot.joints, values, SAMPLES)
    pose = robot.frame(part.to, values, SAMPLES)
    if part.start == "base":
        return pose
    return inverse(robot.frame(part.start, values, SAMPLES)) @ pose


def asked_pose(part: PosePartSpec, grading: Grading) -> Matrices:
    """Return the expected pose ``(SAMPLES, 4, 4)``, from the robot or from an earlier answer."""
    # The student's chain must have both frames that the part asks for.
    chain, exercise, samples = grading.student_chain, grading.exercise, grading.samples
    if chain is None or not grading.following:
        return robot_pose(part, exercise, samples)
    tool = len(chain.frames) - 1

    def place(frame: int | str) -> int:
        if isinstance(frame, str):
            return {"base": 0, "tool": tool}[frame]
        return frame - exercise.joints[0].index + 1

    start, to = place(part.start), place(part.to)
    if max(start, to) > tool:
        return robot_pose(part, exercise, samples)
    frames = chain.frames
    if part.home:
        frames = chain.frames_at(Samples(at_home(exercise.joints, samples.values, SAMPLES)))
    return np.asarray(inverse(frames[start]) @ frames[to])


def is_whole_chain(part: PosePartSpec, exercise: Exercise) -> bool:
    """True if the part asks for the pose of the tool in the base frame at all joint values."""
    return (
        exercise.reference is not None
        and exercise.formulas.get(part.id) is None
        and (part.start, part.to, part.home) == ("base", "tool", False)
    )


def as_entries(matrices: Matrices) -> Numbers:
    """Move the samples of matrices to the last axis: ``(..., rows, columns, SAMPLES)``."""
    return np.moveaxis(matrices, -3, -1)


# Find the content cells of a correct answer: the cells that need knowledge and earn points.
#
# An answer with only zeros and joint variables is called lazy. A content cell is a cell in which
# the
# correct answer differs from the lazy one. ``known`` is a mask of the content cells.


KnownCells = NDArray[np.bool_]


def known_cells(
    right: Numbers, lazy: ArrayLike, scale: ArrayLike = 1.0, angle: ArrayLike = False
) -> KnownCells:
    """Return a mask of the cells in which the correct answer differs from the lazy one.

    A lazy answer needs no knowledge. ``scale`` is the unit of the tolerance.
    """
    # ``right`` is ``(..., samples)``, the result ``(...)``; ``angle`` is true for angles.
    error = np.abs(difference(right, np.asarray(lazy), angle)).max(axis=-1)
    return np.asarray(error > SAME_CONTENT * np.asarray(scale))


def of_rows(
    known: KnownCells,
    *,
    most: int | None = None,
    usual: tuple[int, int] | None = None,
) -> Content:
    """Return the content cells (those that earn points) of a table or of screw axes.

    ``Content`` explains ``most`` and ``usual``.
    """
    # ``known`` is ``(rows, cells)``. Each row is also worth something besides its content cells.
    rows = _rows(known)
    groups = tuple((i,) * len(row) for i, row in enumerate(rows))
    return Content(rows, groups, besides=True, most=most, usual=usual)


def of_one_row(known: KnownCells) -> Content:
    """Return the content cells (those that earn points) of a single row."""
    return Content(_rows(_all_if_none(known)[None]), ((0,) * len(known),))


def of_list(known: KnownCells, reference: KnownCells | None = None) -> Content:
    """Return the content cells (those that earn points) of a list of single values."""
    # At most as many values count as ``reference`` marks.
    return Content(
        _rows(_all_if_none(known)[:, None]), ((0,),) * len(known), most=_count(reference)
    )


def of_rigid(right: Numbers, part: PartSpec, grading: Grading) -> Content:
    """Return the content cells of a rotation or transform: the entries that earn points."""
    # If both the rotation and the position have content cells, each of the two is worth one half.
    exercise = grading.exercise
    if grading.following:
        return _of_rigid(right, exercise.length_scale)
    return _of_asked(_Asked(exercise.version, part.id, right, exercise.length_scale))


@dataclass(frozen=True)
class _Asked:
    # A cache key that does not depend on the samples.
    version: str
    part: str
    right: Numbers = field(compare=False)
    length_scale: float


@lru_cache(maxsize=256)
def _of_asked(asked: _Asked) -> Content:
    return _of_rigid(asked.right, asked.length_scale)


def _of_rigid(right: Numbers, length_scale: float) -> Content:
    known = _differs_from_identity(right, length_scale)
    halves = known[:, :3].any() and known[:, 3:].any()
    groups = tuple(int(halves and column == 3) for column in range(known.shape[1]))
    bottom = (3,) if len(known) == 4 else ()
    return Content(_rows(_all_if_none(known)), (groups,) * len(known), equal=True, bottom=bottom)


def of_matrix(right: Numbers, scale: Numbers) -> Content:
    """Return the content cells (those that earn points) of a matrix that is not a pose."""
    # The zero matrix and the identity are both lazy, so a content cell differs from both.
    known = known_cells(right, 0.0, scale)
    if known.shape[0] == known.shape[1]:
        known &= known_cells(right, np.eye(len(right))[..., None], scale)
    return Content(_rows(_all_if_none(known)), ((0,) * known.shape[1],) * len(known))


def of_links(
    right: Matrices, reference: Matrices, joints: Sequence[Joint], samples: Samples, scale: float
) -> Content:
    """Return the content cells of link transforms: the entries that earn points."""
    # At most as many cells count as the ``reference`` links have content cells.
    known = _differs_from_motion(right, joints, samples, scale)
    most = _differs_from_motion(reference, joints, samples, scale)
    groups = tuple((i // 4,) * 4 for i in range(4 * len(right)))
    bottom = tuple(range(3, 4 * len(right), 4))
    return Content(
        _rows(known.reshape(-1, 4)), groups, besides=True, most=_count(most), bottom=bottom
    )


def _differs_from_motion(
    links: Matrices, joints: Sequence[Joint], samples: Samples, scale: float
) -> KnownCells:
    lazy = np.tile(np.eye(4), (len(links), samples.count, 1, 1))
    for link, joint in zip(lazy, joints, strict=False):
        q = samples.values[joint.variable]
        if joint.prismatic:
            link[:, 2, 3] = q
        else:
            link[:, 0, 0] = link[:, 1, 1] = np.cos(q)
            link[:, 1, 0] = np.sin(q)
            link[:, 0, 1] = -np.sin(q)
    scales = np.array([1.0, 1.0, 1.0, scale])
    return known_cells(np.moveaxis(links, 1, -1), np.moveaxis(lazy, 1, -1), scales)


def _differs_from_identity(right: Numbers, length_scale: float) -> KnownCells:
    scales = np.ones(right.shape[1])
    scales[3:] = length_scale
    return known_cells(right, np.eye(len(right))[..., None], scales)


def _rows(known: KnownCells) -> tuple[tuple[bool, ...], ...]:
    return tuple(map(tuple, known.tolist()))


def _all_if_none(known: KnownCells) -> KnownCells:
    return known if known.any() else np.ones_like(known)


def _count(known: KnownCells | None) -> int | None:
    return None if known is None else int(np.count_nonzero(known))
