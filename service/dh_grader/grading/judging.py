"""The state of grading a submission, the correct numbers of a part, and how answers are judged.

This file decides right or wrong by numbers only, for lists and matrices; tables are judged in
``judging_table.py``. Messages on mistakes are made in ``diagnosis``.
"""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dh_grader.catalogue import Exercise, Joint, PartSpec, grid_values
from dh_grader.catalogue.part import PosePartSpec
from dh_grader.catalogue.robot import Robot, at_home
from dh_grader.expressions import Expression, Kind, Vocabulary
from dh_grader.expressions.printing import Habits, Spelling, habits_of, spelling_of
from dh_grader.grading.frames import tool_pose
from dh_grader.grading.misconception import number_formula
from dh_grader.grading.numbers import (
    SAME_CONTENT,
    SAMPLES,
    Match,
    Samples,
    difference,
    entry_matches,
)
from dh_grader.grading.reading.entries import Entry, Reader
from dh_grader.grading.reading.lists import StudentValues
from dh_grader.grading.reading.matrices import StudentMatrix
from dh_grader.grading.report import (
    ROUNDED,
    CellReport,
    Correction,
    Feedback,
    Finding,
    Place,
    ReadEntry,
    RowReport,
    Verdict,
    row_report,
)
from dh_grader.kinematics import Matrices, Numbers, inverse

# --- The submission that is graded, and what the kind of a part returns
#
# The kinds are in ``kinds``.


# The number of entries that show how a student names symbols.
NAMING_ENTRIES = 4
# The length of a table cell. Longer texts are not memoized, because the memo would keep their
# expressions.
_CELL = 40


@dataclass(frozen=True, slots=True)
class StudentChain:
    """A student's answer as a chain of links, with which later answers can be compared."""

    # (k + 1, SAMPLES, 4, 4), from the base to the tool, in the base frame.
    frames: Matrices
    # Returns the frames at other samples, NaN where a frame is undefined.
    frames_at: Callable[[Samples], Matrices]
    # The link transforms (k, SAMPLES, 4, 4) of the correct table nearest to the answer, or None if
    # the answer consists of matrices.
    nearest_links: Matrices | None = None

    def tool_at(self, samples: Samples) -> Matrices:
        """Return the tool's frame at these samples, ``(samples, 4, 4)``."""
        tool: Matrices = self.frames_at(samples)[-1]
        return tool

    @property
    def links(self) -> Matrices:
        """The k link transforms of the student's answer, ``(k, SAMPLES, 4, 4)``."""
        return inverse(self.frames[:-1]) @ self.frames[1:]


@dataclass(frozen=True, slots=True)
class Grading:
    """The state of grading one submission."""

    exercise: Exercise
    samples: Samples
    reader: Reader
    # True if the report shows corrections, which then must be computed.
    corrects: bool = False
    # True if the report shows how each cell was read.
    echo: bool = False
    # The earlier answer that the part follows from, if there is one.
    student_chain: StudentChain | None = None
    # True if the part is judged by student_chain instead of the reference.
    following: bool = False
    # True if wrong cells are explained, not only judged.
    explains: bool = True

    def affords(self, work: float) -> bool:
        """Charge ``work`` for an explanation; return True if enough of the budget was left."""
        return self.explains and self.reader.budget.affords(work)

    def messages(
        self, findings: tuple[Finding, ...], places: tuple[Place, ...] = ()
    ) -> tuple[Feedback, ...]:
        """Return the findings as messages about ``places`` (rows and cells).

        The feedback level later decides which messages are visible.
        """
        return tuple(finding.message(places, corrects=self.corrects) for finding in findings)

    def spelling(self, entries: Iterable[Entry]) -> Spelling:
        """Return how the student writes symbols and angles in these entries."""
        # Half the cells of a table are a bare 0, which shows no spelling.
        expressions = [entry.expression for entry in entries]
        vocabulary = self.exercise.vocabulary
        habits = [
            _habits(each, vocabulary)
            for each in expressions
            if each is not None and each.source != "0"
        ]
        return spelling_of(habits, vocabulary, degrees=self.reader.angle_unit == "degrees")

    def symbol_names(self, entries: Iterable[Entry]) -> Callable[[str], str]:
        """Return a function that gives the student's name for each symbol."""

        # On its first call, the returned function reads the shortest entries: they show the names
        # with the least work.
        @cache
        def spelling() -> Spelling:
            read = [each for each in entries if each.expression and each.expression.symbols]
            return self.spelling(sorted(read, key=_length)[:NAMING_ENTRIES])

        return lambda symbol: spelling().names.get(symbol, symbol)

    def unwritten(self, entries: Iterable[Entry]) -> frozenset[str]:
        """Return the constants of the exercise that no entry contains.

        A hint must not name them, because a missing constant may be the whole answer.
        """
        read = (each.expression.symbols for each in entries if each.expression is not None)
        joints = (joint.variable for joint in self.exercise.joints)
        names = {variable.name for variable in self.exercise.variables}
        return frozenset(names.difference(joints, *read))


def _habits(expression: Expression, vocabulary: Vocabulary) -> Habits:
    if len(expression.source) <= _CELL:
        return _habits_of_cell(expression, vocabulary)
    return habits_of(expression.typed, vocabulary)


# Memoized, because the students of a class write the same cells.
@lru_cache(maxsize=2048)
def _habits_of_cell(expression: Expression, vocabulary: Vocabulary) -> Habits:
    return habits_of(expression.typed, vocabulary)


def _length(entry: Entry) -> int:
    return len(entry.expression.source) if entry.expression else 0


def _no_chain() -> StudentChain | None:
    return None


@dataclass(frozen=True, slots=True)
class Content:
    """The cells of a correct answer that need knowledge and so earn points."""

    # The cells that need knowledge, (rows, cells) like the rows of the report.
    known: tuple[tuple[bool, ...], ...]
    # The number of each cell's group, (rows, cells); a group cannot lose more than it is worth.
    groups: tuple[tuple[int, ...], ...]
    # True if each group is worth something even without these cells.
    besides: bool = False
    # True if all groups are worth the same.
    equal: bool = False
    # The largest number of cells that count, because a student's own choices may add such cells.
    most: int | None = None
    # The rows that are the same in every correct answer: the last rows of homogeneous matrices.
    bottom: tuple[int, ...] = ()
    # The numbers of rows and of these cells of the reference, if an answer may have other numbers.
    usual: tuple[int, int] | None = None
    # True for the rows that the exercise gives, which earn nothing; empty if it gives no rows.
    given: tuple[bool, ...] = ()

    @property
    def earning(self) -> tuple[bool, ...]:
        """True for each row that can earn points."""
        return tuple(not given for given in self.given) or (True,) * len(self.known)

    @property
    def count(self) -> int:
        """The number of cells that need knowledge."""
        return sum(map(sum, self.known))


@dataclass(frozen=True, slots=True)
class Judged:
    """The judgement of an answer: its rows, and the messages on the whole answer."""

    # The rows have no points yet.
    rows: tuple[RowReport, ...]
    # Determines the worth of the cells.
    content: Content
    feedback: tuple[Feedback, ...] = ()
    # The number of slips that no cell shows, such as an extra row.
    slips: int = 0
    # The share of the points that a slip of the whole answer costs, if such a slip explains all
    # wrong cells.
    whole_cost: float | None = None
    # The answer without that slip; cells that are wrong here, too, cost extra.
    beside: "Judged | None" = None
    # True if no joint moves an answer that must move.
    stands_still: bool = False
    # Its points are an upper limit.
    at_most: "Judged | None" = None
    # Its points are a lower limit.
    at_least: "Judged | None" = None
    # True if the answer needs more rows than at_most has: because of the upper limit, the wrong
    # cells of the answer lose at most a unit each.
    needs_all: bool = False
    # An upper limit of the lost units of content.
    lost: float = math.inf
    # The number of cells that the student wrote and that are not lazy, or None if unknown; a wrong
    # answer earns at most a unit for each of these cells.
    written: int | None = None
    # Returns the answer as a chain, or None; called only if another part follows this part.
    chain: Callable[[], StudentChain | None] = _no_chain

    @property
    def is_right(self) -> bool:
        """True if nothing is wrong, unread or missing."""
        return not self.slips and all(row.verdict is Verdict.CORRECT for row in self.rows)

    @property
    def count_wrong(self) -> int:
        """The number of cells that are not right."""
        return sum(cell.verdict is not Verdict.CORRECT for row in self.rows for cell in row.cells)

    @property
    def is_wrong(self) -> bool:
        """True if anything that was read is wrong."""
        cells = (cell.verdict for row in self.rows for cell in row.cells)
        return self.slips > 0 or Verdict.INCORRECT in cells


@dataclass(frozen=True, slots=True)
class AnswerKind:
    """The pure functions that read and judge a kind of answer."""

    # Takes a part and a JSON value, and returns the form that ``judge`` expects, or None for an
    # empty answer. Raises UnreadableAnswerError if nothing can be read.
    read: Callable[[Any, object, Grading], Any]
    # Takes a part and an answer that ``read`` has returned.
    judge: Callable[[Any, Any, Grading], Judged]


# --- Compare a list of lengths, angles and numbers with the expected list


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
    """Return the expected values as numbers; None for a value that varies.

    All are None if the report shows no corrections.
    """
    return [number_formula(each) if grading.corrects else None for each in expected]


# --- Make report rows from entries and the results of their comparison


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

    ``match`` is the result of comparing the entry. If a wrong entry has no ``slip``, a message on
    the part explains it.
    """
    verdict, findings = entry.verdict, entry.findings
    if match == _EXACT and not findings and entry.expression is not None and not grading.echo:
        return _right(column)
    if match == Match.ROUNDED:
        findings = (*findings, ROUNDED)
    elif entry.expression is not None and match < Match.ROUNDED:
        verdict = Verdict.INCORRECT
        if slip is not None:
            findings = (*findings, slip)
    read = None
    if grading.echo and entry.expression is not None:
        read = ReadEntry(entry.expression.text(), entry.expression.latex())
    return CellReport(column, verdict, grading.messages(findings), read)


# --- Compare a matrix with the expected matrix, entry by entry


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


# --- Compute the correct answer to a part of an exercise in numbers


def formula_values(part: PartSpec, grading: Grading) -> Numbers | None:
    """Return the values ``(rows, columns, SAMPLES)`` of the part's formulas in the exercise file.

    Return None if there are none: the correct answer follows from the robot.
    """
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
    """Return the expected pose ``(SAMPLES, 4, 4)``, from the robot or from an earlier answer.

    The student's chain must have both frames that the part asks for.
    """
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


# --- Find the content cells of a correct answer: the cells that need knowledge and earn points
#
# An answer with only zeros and joint variables is called lazy: it needs no knowledge. A content
# cell is a cell in which the correct answer differs from the lazy one. ``known`` is a mask of the
# content cells.


KnownCells = NDArray[np.bool_]


def known_cells(
    right: Numbers, lazy: ArrayLike, scale: ArrayLike = 1.0, angle: ArrayLike = False
) -> KnownCells:
    """Return a mask ``(...)`` of the cells in which the correct answer differs from the lazy one.

    ``right`` is ``(..., samples)``. ``scale`` is the unit of the tolerance; ``angle`` is true for
    angles.
    """
    error = np.abs(difference(right, np.asarray(lazy), angle)).max(axis=-1)
    return np.asarray(error > SAME_CONTENT * np.asarray(scale))


def of_rows(
    known: KnownCells,
    *,
    most: int | None = None,
    usual: tuple[int, int] | None = None,
) -> Content:
    """Return the content cells ``(rows, cells)`` of a table or of screw axes.

    Each row is also worth something besides its content cells. ``Content`` explains ``most`` and
    ``usual``.
    """
    rows = _rows(known)
    groups = tuple((i,) * len(row) for i, row in enumerate(rows))
    return Content(rows, groups, besides=True, most=most, usual=usual)


def of_one_row(known: KnownCells) -> Content:
    """Return the content cells of a single row."""
    return Content(_rows(_all_if_none(known)[None]), ((0,) * len(known),))


def of_list(known: KnownCells, reference: KnownCells | None = None) -> Content:
    """Return the content cells of a list; at most as many values count as ``reference`` marks."""
    return Content(
        _rows(_all_if_none(known)[:, None]), ((0,),) * len(known), most=_count(reference)
    )


def of_rigid(right: Numbers, part: PartSpec, grading: Grading) -> Content:
    """Return the content cells of a rotation or transform.

    If both the rotation and the position have content cells, each of the two is worth one half.
    """
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
    scales = np.ones(right.shape[1])
    scales[3:] = length_scale
    known = known_cells(right, np.eye(len(right))[..., None], scales)
    halves = known[:, :3].any() and known[:, 3:].any()
    groups = tuple(int(halves and column == 3) for column in range(known.shape[1]))
    bottom = (3,) if len(known) == 4 else ()
    return Content(_rows(_all_if_none(known)), (groups,) * len(known), equal=True, bottom=bottom)


def of_matrix(right: Numbers, scale: Numbers) -> Content:
    """Return the content cells of a matrix that is not a pose.

    The zero matrix and the identity are both lazy, so a content cell differs from both.
    """
    known = known_cells(right, 0.0, scale)
    if known.shape[0] == known.shape[1]:
        known &= known_cells(right, np.eye(len(right))[..., None], scale)
    return Content(_rows(_all_if_none(known)), ((0,) * known.shape[1],) * len(known))


def of_links(
    right: Matrices, reference: Matrices, joints: Sequence[Joint], samples: Samples, scale: float
) -> Content:
    """Return the content cells of link transforms; at most as many count as those of the reference.

    ``right`` and ``reference`` are ``(links, SAMPLES, 4, 4)``.
    """
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


def _rows(known: KnownCells) -> tuple[tuple[bool, ...], ...]:
    return tuple(map(tuple, known.tolist()))


def _all_if_none(known: KnownCells) -> KnownCells:
    return known if known.any() else np.ones_like(known)


def _count(known: KnownCells | None) -> int | None:
    return None if known is None else int(np.count_nonzero(known))
