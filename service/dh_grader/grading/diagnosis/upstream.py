"""Search for the slip in the table or in a symbol that leads to a student's wrong answer.

This file computes the wrong answers that slips lead to, and the symbols that an entry must contain.
The slips themselves are in ``slips_of_the_table.py`` and ``whole_tables.py``.
"""

from collections.abc import Callable, Iterable, Sequence, Set
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from dh_grader.catalogue import (
    Exercise,
    Joint,
    PartSpec,
    ReferenceTable,
    Robot,
    ScrewRobot,
    grid_values,
)
from dh_grader.catalogue.kinds import LinkTransformsSpec
from dh_grader.catalogue.part import PosePartSpec
from dh_grader.catalogue.robot import at_home
from dh_grader.expressions.evaluate import SymbolValues
from dh_grader.grading.diagnosis.formulas import WrongEntry
from dh_grader.grading.diagnosis.slips_of_the_table import (
    HOME_POSITION,
    Change,
    Names,
    Slip,
    SymbolChange,
    axis_direction,
    change_cells,
    changed_values,
    home_slip,
    joint_slips,
    length_slips,
)
from dh_grader.grading.diagnosis.whole_tables import (
    TableRows,
    lengths_of,
    row_slips,
    slips_of_rows,
    table_slips,
)
from dh_grader.grading.frames import reference_values, variable_column
from dh_grader.grading.judging import Grading, as_entries
from dh_grader.grading.misconception import (
    UNEXPLAINED,
    Explained,
    Hypothesis,
    Mask,
    check,
    differs,
    finding_on,
    says,
)
from dh_grader.grading.numbers import (
    HALF,
    SAME_MOTION,
    SAMPLES,
    Samples,
    changes,
    difference,
    nearly_equal,
)
from dh_grader.grading.reading.matrices import StudentMatrix
from dh_grader.grading.reading.table import IS_ANGLE
from dh_grader.grading.report import Finding
from dh_grader.kinematics import (
    COLUMNS,
    Convention,
    Matrices,
    Numbers,
    Table,
    frames,
    inverse,
    links,
)
from dh_grader.kinematics import row as dh_row
from dh_grader.translations import listed, say

# --- The wrong answers that mistakes in the table or in symbols lead to


AnswersAt = Callable[[Sequence[Change], Samples], Numbers]


@dataclass(frozen=True)
class SlippedAnswers:
    """The wrong answers that ``slips`` lead to."""

    slips: tuple[Slip, ...]
    # Returns the answers (K, ..., samples) that K changes lead to.
    at: AnswersAt
    # True if every symbol can be changed, False if only joint variables can be changed.
    by_symbols: bool = True
    # True if all joint variables are 0 in the answers.
    at_home: bool = False

    def of(self, entries: Callable[[Numbers], Numbers]) -> "SlippedAnswers":
        """Return a copy of the answers with only some entries, such as the positions."""
        return replace(self, at=lambda changes, samples: entries(self.at(changes, samples)))


def slipped_answers(part: PartSpec, grading: Grading) -> SlippedAnswers | None:
    """Return the wrong answers that slips lead to, or None if they cannot be computed.

    With formulas for the part, the answers are ``(K, rows, columns, samples)``, otherwise they are
    poses ``(K, 4, 4, samples)`` of the robot.
    """
    exercise = grading.exercise
    if grading.following:
        return None
    if exercise.formulas.get(part.id) is not None:
        grid = exercise.formulas[part.id]
        at = _stacked(lambda values, count: grid_values(grid, values, count))
        return SlippedAnswers(_general_slips(exercise, grading.samples), at)
    if exercise.reference is None or not isinstance(part, PosePartSpec):
        return None
    poses = _of_table if isinstance(exercise.reference, Robot) else _of_screws
    return poses(part, exercise, grading.samples)


def _of_table(part: PosePartSpec, exercise: Exercise, samples: Samples) -> SlippedAnswers:
    robot = exercise.robot
    table = robot.tables[robot.convention]
    start, to, last = *map(robot.frame_number, (part.start, part.to)), len(table.rows)

    def values_at(samples: Samples) -> SymbolValues:
        values = samples.values
        return at_home(robot.joints, values, samples.count) if part.home else values

    def at(changes: Sequence[Change], samples: Samples) -> Numbers:
        tables = slipped_tables(table, changes, values_at(samples), samples.count)
        reached = frames(tables, table.convention)
        # A slip may add a row at the end.
        return as_entries(inverse(reached[start]) @ reached[to if to < last else -1])

    few = samples.subset(1)
    constants = table.values(at_home(robot.joints, few.values, few.count), few.count)
    axis, whole = axis_direction(exercise, few), (start, to) == (0, last)
    slips = table_slips(table, constants, axis, home=part.home, whole=whole)
    return SlippedAnswers(tuple(slips), at, at_home=part.home)


def slipped_tables(
    table: ReferenceTable, changes: Sequence[Change], values: SymbolValues, count: int
) -> Table:
    """Return one changed table for each of K changes, in an array ``(rows, 4, K, samples)``.

    A change in a row that the table does not have adds rows.
    """
    changed = changed_values(changes, values)
    tables = table.values(changed, len(changes) * count).reshape(len(table.rows), 4, -1, count)
    right = table.values(values, count)
    constants = table.values(at_home(table.joints, values, count), count)
    added = max((cell.row + 1 for each in changes for cell in each.cells), default=0) - len(tables)
    if added > 0:
        tables, right, constants = (
            np.concatenate([cells, np.zeros((added, *cells.shape[1:]))])
            for cells in (tables, right, constants)
        )
    change_cells(changes, tables, right, constants)
    return tables


def _of_screws(part: PosePartSpec, exercise: Exercise, samples: Samples) -> SlippedAnswers:
    robot = exercise.reference
    assert isinstance(robot, ScrewRobot)

    def pose(values: SymbolValues, count: int) -> Numbers:
        if part.home:
            values = at_home(robot.joints, values, count)
        start, to = (robot.frame(name, values, count) for name in (part.start, part.to))
        return as_entries(inverse(start) @ to)

    slips = _general_slips(exercise, samples)
    return SlippedAnswers(slips, _stacked(pose), at_home=part.home)


def _stacked(answer: Callable[[SymbolValues, int], Numbers]) -> AnswersAt:
    # The returned function calls ``answer`` once for all changes, and splits the result.
    def at(changes: Sequence[Change], samples: Samples) -> Numbers:
        values = changed_values(changes, samples.values)
        found = answer(values, len(changes) * samples.count)
        split = found.reshape(*found.shape[:-1], len(changes), samples.count)
        return np.moveaxis(split, -2, 0)

    return at


def _general_slips(exercise: Exercise, samples: Samples) -> tuple[Slip, ...]:
    joints = exercise.joints
    if not joints:
        return ()
    variables = {joint.variable for joint in joints}
    lengths = [
        variable.name
        for variable in exercise.variables
        if variable.kind == "length" and variable.name not in variables
    ]
    axis = axis_direction(exercise, samples.subset(1))
    return (*joint_slips(joints, joints, axis), *home_slip(joints), *length_slips(lengths))


# --- The search for slips that explain a wrong answer


# These slips change several entries. If only one is wrong, its sign or a term is the cause.
OF_SEVERAL_ENTRIES = {"quarter_turn", "half_turn", "parameter_sign"}
# Far-fetched slips if signs of the answer explain it: of the whole vector, or of a column.
AFTER_SIGNS = {"half_turn", "parameter_sign"}
# A slip of rows or columns, and the slips that it includes: only these are certain.
PARTS_OF = {
    "columns_swapped": {"distance_left_out"},
    "parameter_sign": {"sign"},
    "row_order": {"lengths_exchanged"},
}
# If more slips lead to the same answer, the message does not list them.
MAX_LISTED = 4


@dataclass(frozen=True)
class SlipSearch:
    """A student's wrong answer, and the wrong answers that possible slips lead to.

    A slip is a mistake in the table, the joints or the lengths.
    """

    answers: SlippedAnswers
    samples: Samples
    # (..., L) at some of the samples, like expected; NaN if unreadable.
    actual: Numbers
    expected: Numbers
    # The wrong entries, (...).
    wrong: Mask
    # Broadcasts to (...).
    scale: ArrayLike
    # Broadcasts to (..., 1).
    angle: ArrayLike = False
    # Returns the name that the student uses for a symbol.
    name: Callable[[str], str] = str
    # The constants that the student did not write.
    unwritten: Set[str] = frozenset()

    def explanation(self, entries: Mask) -> Explained | None:
        """Return the finding on the slips that explain these entries, or None."""
        slips = self.explaining(entries)
        finding = _finding(slips, Names(self.name, self._gives_away))
        return None if finding is None else Hypothesis(None, finding, entries, record=slips[0].kind)

    def _gives_away(self, symbol: str) -> bool:
        if symbol in self.unwritten:
            return True
        count = self.actual.shape[-1] // 2
        value = Samples.subset_of(self.samples.values[symbol], count)
        whole = nearly_equal(np.abs(self.expected[self.wrong]), np.abs(value)).any()
        before, after = self.actual[..., :count], self.actual[..., count:]
        return bool(whole or nearly_equal(before, after)[self.wrong].all())

    def explaining(self, entries: Mask) -> list[Slip]:
        """Return the slips that explain all readable ``entries``, likeliest first."""
        read = entries & np.isfinite(self.actual).all(axis=-1)
        # Nobody has calculated an answer of zeros from a table.
        if not self.answers.slips or not self.actual[np.isfinite(self.actual)].any():
            return []
        fits, changes = self._at_two_samples
        found = np.flatnonzero(fits[:, read].all(axis=1) & changes[:, read].any(axis=1))
        slips = [self.answers.slips[k] for k in found]
        if (self.wrong & read).sum() == 1:
            slips = [slip for slip in slips if slip.code not in OF_SEVERAL_ENTRIES]
        if not slips:
            return []
        fits, changes = self._compared(slips, self.actual.shape[-1] // 2)
        sure = np.flatnonzero(fits[:, read].all(axis=1) & changes[:, read].any(axis=1))
        found_slips = sorted((slips[k] for k in sure), key=lambda slip: slip.kind.rank)
        # If all joints stand still, no single joint is to blame.
        at_home = [slip for slip in found_slips if slip.kind is HOME_POSITION]
        return at_home or _certain(found_slips)

    @cached_property
    def _at_two_samples(self) -> tuple[Mask, Mask]:
        # The entries that each slip explains, and those that it changes: two masks (K, ...). All
        # slips are compared at only two samples, which is a quick first test.
        return self._compared(self.answers.slips, 1)

    def _compared(self, slips: Sequence[Slip], count: int) -> tuple[Mask, Mask]:
        # The entries that K slips explain, and those that they change: two masks (K, ...).
        samples = self.samples if count == HALF else self.samples.subset(count)
        half = self.actual.shape[-1] // 2
        some = [*range(count), *range(half, half + count)]
        answers = self.answers.at(slips, samples)
        fits = nearly_equal(self.actual[..., some], answers, self.scale, self.angle)
        same = nearly_equal(self.expected[..., some], answers, self.scale, self.angle)
        return fits, ~same


def _certain(slips: list[Slip]) -> list[Slip]:
    # A slip is removed if it includes another slip of the list as a part. A missing link is kept
    # only together with exchanged rows.
    codes = {slip.code for slip in slips}
    covered = {code for code in codes if PARTS_OF.get(code, set()) & codes}
    if codes != {"row_order", "missing_link"}:
        covered.add("missing_link")
    return [slip for slip in slips if slip.code not in covered]


def _finding(slips: Sequence[Slip], names: Names) -> Finding | None:
    # Slips with the same clause are the same to a student.
    plain = Names(names.name, lambda _: False)
    different: dict[str, Slip] = {}
    for slip in slips:
        different.setdefault(slip.words(plain).clause, slip)
    if not different or len(different) > MAX_LISTED:
        return None
    if len(different) == 1:
        hint = slips[0].words(names).hint
        return says(hint, slips[0].words(plain).correction)
    *clauses, last = [slip.words(names).clause for slip in different.values()]
    all_but_last: str = clauses[0]
    for each in clauses[1:]:
        all_but_last = say("{first}; {second}", first=all_but_last, second=each)
    hint = say(
        "One of these slips explains it: {slips}; or {last}. Check each of them.",
        slips=all_but_last,
        last=last,
    )
    return says(hint)


# --- The wrong link transforms that mistakes in one row of the table lead to


def slipped_link(
    row: int, right: Matrices, convention: Convention, grading: Grading
) -> SlippedAnswers | None:
    """Return the wrong link transforms ``(K, 4, 4, samples)`` that mistakes in one row lead to.

    ``right`` is the correct transform ``(SAMPLES, 4, 4)``. Return None if the answer is judged by
    an earlier answer of the student.
    """
    if grading.following:
        return None
    samples = grading.samples
    table = grading.exercise.robot.tables[convention]
    cells = dh_row(right, convention)
    given = reference_values(table, samples)[row]
    axis = axis_direction(grading.exercise, samples.subset(1))
    of_joint = joint_slips(table.joints[row : row + 1], table.joints, axis)
    if np.abs(difference(cells, given, IS_ANGLE[:, None])).max() < SAME_MOTION:
        few = samples.subset(1)
        home = table.values(at_home(table.joints, few.values, few.count), few.count)[row]
        of_row = row_slips(table, row, home[:, 0].tolist(), axis)
        of_lengths = length_slips(*lengths_of(table))
        # A single row can hold another length in place of its own, but no exchange of two.
        single = (slip for slip in of_lengths if len(slip.symbols) == 1)
        return SlippedAnswers((*of_joint, *of_row, *single), _in_reference_frames(table, row))
    joint = table.joints[row] if row < len(table.joints) else None
    senses = _senses(cells, joint, samples)
    constants = cells - _motion(senses, joint, samples.values)
    of_row = row_slips(table, row, constants[:, 0].tolist(), axis, own_frames=True)
    at = _in_own_frames(row, constants, senses, joint, convention)
    return SlippedAnswers((*of_joint, *of_row), at, by_symbols=False)


def _in_reference_frames(table: ReferenceTable, row: int) -> AnswersAt:
    def at(changes: Sequence[Change], samples: Samples) -> Numbers:
        tables = slipped_tables(table, changes, samples.values, samples.count)
        return as_entries(links(tables[row : row + 1], table.convention)[0])

    return at


def _in_own_frames(
    row: int, constants: Numbers, senses: Numbers, joint: Joint | None, convention: Convention
) -> AnswersAt:
    # ``constants`` ``(4, SAMPLES)`` are the cells of the row with all joint variables 0.
    def at(changes: Sequence[Change], samples: Samples) -> Numbers:
        count = samples.count
        fixed = constants if count == SAMPLES else Samples.subset_of(constants, count // 2)
        moved = _motion(senses, joint, changed_values(changes, samples.values))
        right = fixed + _motion(senses, joint, samples.values)
        rows = np.repeat(fixed[:, None], len(changes), axis=1)
        rows += moved.reshape(4, -1, count) if joint else 0.0
        change_cells(changes, rows[None], right[None], fixed[None], first_row=row)
        return as_entries(links(rows[None], convention)[0])

    return at


def constants_and_motion(
    right: Matrices, convention: Convention, joints: Sequence[Joint], samples: Samples
) -> tuple[Table, Table]:
    """Return the DH rows of correct link transforms, split into constants and motion.

    The motion is the part of each cell that changes with the joints. ``right`` is ``(rows, SAMPLES,
    4, 4)``. Both results are tables ``(rows, 4, SAMPLES)``, and the table is their sum.
    """
    constants, motions = np.empty((2, len(right), len(COLUMNS), samples.count))
    for i, link in enumerate(right):
        joint, cells = joints[i] if i < len(joints) else None, dh_row(link, convention)
        motions[i] = _motion(_senses(cells, joint, samples), joint, samples.values)
        constants[i] = cells - motions[i]
    return constants, motions


def _motion(senses: Numbers, joint: Joint | None, values: SymbolValues) -> Numbers:
    return np.multiply.outer(senses, values[joint.variable] if joint else np.zeros(1))


def _senses(cells: Numbers, joint: Joint | None, samples: Samples) -> Numbers:
    # The factor of the joint's variable in each cell of a row: 0, 1 or -1.
    senses = np.zeros(len(cells))
    if joint is not None:
        column = variable_column(joint)
        error = difference(
            changes(cells[column]), changes(samples.values[joint.variable]), not joint.prismatic
        )
        senses[column] = 1.0 if np.abs(error).max() < SAME_MOTION else -1.0
    return senses


# --- One slip in the table that explains all wrong link transforms of an answer


# Samples of each half that are enough to tell whole answers apart.
SUBSET = 4
# The work of explaining all link transforms, as the budget counts it.
LINKS_WORK = 6.0


def explain_links(
    matrices: Sequence[StudentMatrix],
    written: Matrices,
    right: Matrices,
    scale: Numbers,
    part: LinkTransformsSpec,
    grading: Grading,
) -> Finding | None:
    """Return the finding that explains all wrong link transforms at once, or None.

    ``written`` are the numbers of the matrices and ``right`` the correct numbers, ``(rows, SAMPLES,
    4, 4)`` each; ``scale`` is ``(4, 4)``. None also if the answer is judged by an earlier answer of
    the student.
    """
    wrong = _wrong(written, right, scale)
    if grading.following or not wrong.any() or not grading.affords(LINKS_WORK):
        return None
    found = _explained(matrices, written, right, scale, part, grading)
    is_of_one = wrong.any(axis=(1, 2)).sum() == 1
    if is_of_one:
        # With one wrong link transform, only this slip can be one of all.
        return found if found and found.code == "other_convention" else None
    if found is None and part.frames == "free" and grading.affords(LINKS_WORK):
        # After such a slip, frames other than the student's may fit best: try the reference's.
        reference = _reference(part, grading)
        found = _explained(matrices, written, reference, scale, part, grading)
    return found


def _explained(
    matrices: Sequence[StudentMatrix],
    written: Matrices,
    right: Matrices,
    scale: Numbers,
    part: LinkTransformsSpec,
    grading: Grading,
) -> Finding | None:
    entries = [entry for matrix in matrices for row in matrix.entries for entry in row]
    wrong = _wrong(written, right, scale)
    search = SlipSearch(
        _slipped_links(right, part, grading),
        grading.samples,
        _at_subset(written),
        _at_subset(right),
        wrong,
        scale,
        name=grading.symbol_names(entries),
        unwritten=grading.unwritten(entries),
    )
    found = search.explanation(np.ones_like(wrong))
    return None if found is None else found.findings[0]


def _wrong(written: Matrices, right: Matrices, scale: Numbers) -> Mask:
    actual, expected = _at_subset(written), _at_subset(right)
    is_read = np.isfinite(actual).all(axis=-1)
    return np.asarray(is_read & ~nearly_equal(actual, expected, scale, False))


def _at_subset(transforms: Matrices) -> Numbers:
    return Samples.subset_of(np.moveaxis(transforms, 1, -1), SUBSET)


def _reference(part: LinkTransformsSpec, grading: Grading) -> Matrices:
    table = grading.exercise.robot.tables[part.convention]
    return links(table.values(grading.samples.values, SAMPLES), table.convention)


def _slipped_links(right: Matrices, part: LinkTransformsSpec, grading: Grading) -> SlippedAnswers:
    table, samples = grading.exercise.robot.tables[part.convention], grading.samples
    constants, motion = constants_and_motion(right, table.convention, table.joints, samples)
    slips = list(
        slips_of_rows(
            TableRows(
                constants[..., 0], table.joints, table.labels, table.convention, multiplied=False
            )
        )
    )
    in_its_frames = np.abs(right - _reference(part, grading)).max() < SAME_MOTION
    if in_its_frames:
        slips += [slip for slip in length_slips(*lengths_of(table)) if len(slip.symbols) == 2]

    def tables(changes: Sequence[Change], samples: Samples) -> Table:
        if in_its_frames:
            return slipped_tables(table, changes, samples.values, samples.count)
        fixed, moved = (
            cells if samples.count == SAMPLES else Samples.subset_of(cells, samples.count // 2)
            for cells in (constants, motion)
        )
        changed = np.repeat((fixed + moved)[:, :, None], len(changes), axis=2)
        change_cells(changes, changed, fixed + moved, fixed)
        return changed

    def at(changes: Sequence[Change], samples: Samples) -> Numbers:
        changed = tables(changes, samples)
        found = links(changed, table.convention)
        misread = [k for k, change in enumerate(changes) if change.misread]
        if misread:
            found[:, misread] = links(changed[:, :, misread], table.convention.other)
        return np.moveaxis(found, (1, 2), (0, -1))

    return SlippedAnswers(tuple(slips), at, by_symbols=False)


# --- Symbols that an entry lacks or should not contain


# A change that has an effect on every entry: not a whole turn, and not a multiple of a length.
PROBE = 0.37
TWICE = 2.0
NOT_ZERO = say("This must not be 0: check which lengths have a part here.")


@dataclass(frozen=True, slots=True)
class Required:
    """The symbols that a correct entry depends on."""

    symbols: frozenset[str]
    # 1 if the entry doubles when all lengths double, 0 if it stays the same, else None.
    grows: int | None
    # All lengths, and the variables of sliding joints.
    lengths: frozenset[str]
    # The variables of all joints.
    joints: tuple[str, ...]


@dataclass(frozen=True)
class Requirements:
    """The search for the symbols that each correct entry depends on."""

    answers: SlippedAnswers
    exercise: Exercise
    samples: Samples
    # (..., SAMPLES).
    expected: Numbers
    # Broadcasts to (...).
    scale: Numbers

    def of(self, *place: int) -> Required | None:
        """Return the symbols that an entry must contain, or None if they are unknown."""
        if not self.answers.by_symbols:
            return None
        depends, grows = self._dependences
        symbols = {name for k, name in enumerate(self.samples.values) if depends[(k, *place)]}
        joints = tuple(joint.variable for joint in self.exercise.joints)
        alike = [k for k in (0, 1) if grows[(k, *place)]]
        return Required(
            frozenset(symbols.difference(joints) if self.answers.at_home else symbols),
            # Zero passes both tests, so it is not known to be a length or a number.
            alike[0] if len(alike) == 1 else None,
            self._lengths,
            joints,
        )

    @cached_property
    def _lengths(self) -> frozenset[str]:
        return frozenset(each.name for each in self.exercise.variables if each.kind == "length")

    @cached_property
    def _dependences(self) -> tuple[Mask, Mask]:
        # The first mask (symbols, ...) marks the entries that depend on each symbol. The second
        # mask (2, ...) marks the entries that stay the same if all lengths double, and those that
        # double.
        probes = [
            Change(symbols=(SymbolChange(name, name, 1.0, PROBE),)) for name in self.samples.values
        ]
        doubled = tuple(SymbolChange(name, name, TWICE) for name in sorted(self._lengths))
        few = self.samples.subset(1)
        *changed, larger = self.answers.at([*probes, Change(symbols=doubled)], few)
        right = Samples.subset_of(self.expected, 1)
        depends = [~nearly_equal(each, right, self.scale) for each in changed]
        grows = [nearly_equal(larger, size * right, self.scale) for size in (1.0, TWICE)]
        return np.array(depends), np.array(grows)


@dataclass(frozen=True)
class Dependence:
    """A wrong entry, and the symbols that the correct entry depends on."""

    case: WrongEntry
    # None if the symbols are unknown.
    required: Required | None

    @property
    def written(self) -> frozenset[str]:
        """The symbols that the student wrote."""
        return frozenset(self.case.expression.symbols)

    @property
    def joints(self) -> list[str]:
        """The joint variables that the student left out."""
        known = self.required
        return (
            [name for name in known.joints if name in known.symbols - self.written] if known else []
        )


def _is_formula(entry: Dependence) -> bool:
    return entry.required is not None and bool(entry.written)


@check(
    of=Dependence,
    rank=10,
    code="independent_of",
    rule="dependence",
    means="the entry does not contain a joint variable or a length that it must depend on",
    example=("planar-rpr-poe", "position", "[0, 0]"),
    unlike={"1/1": "theta1"},
)
def constant(entry: Dependence) -> Finding | None:
    """The student wrote a number, but the correct entry changes with a joint."""
    if entry.written or not entry.joints:
        return None
    hint = say("This is a constant, but it must change with the joints.")
    return finding_on(entry.case, hint)


@check(
    of=Dependence,
    rank=20,
    code=UNEXPLAINED,
    rule="dependence",
    means="the value is wrong, and no other code explains it",
    example=("rigid-motion-chain", "point", "[0, 0, 0]"),
    unlike={"3/1": "h"},
)
def zero(entry: Dependence) -> Finding | None:
    """The student wrote 0 for a length."""
    case, required = entry.case, entry.required
    if required is None or required.grows != 1 or not required.lengths:
        return None
    return differs(case, NOT_ZERO) if _same(case, case.actual, 0 * case.actual) else None


@check(
    of=Dependence,
    rank=30,
    code="quantity",
    rule="dependence",
    when=_is_formula,
    means="the entry must be a length and is not, or must be a plain number and contains a length",
    example=("planar-rr", "pose", {"1/4": "c1 + c12"}),
    unlike={"1/4": "a1 c1"},
)
def quantity(entry: Dependence) -> Finding | None:
    """The formula is a plain number instead of a length, or a length instead of a number."""
    case, required = entry.case, entry.required
    if required is None or required.grows is None or not required.lengths:
        return None
    few = case.samples.subset(1)
    larger = {
        name: values * TWICE if name in required.lengths else values
        for name, values in few.values.items()
    }
    once, twice = (_value(case, values) for values in (few.values, larger))
    if not np.isfinite([once, twice]).all() or _same(case, once, 0 * once):
        return None
    if _same(case, twice, (1 + required.grows) * once):
        return None
    if required.grows == 0:
        return finding_on(case, say("A plain number is asked for, but this contains a length."))
    if _same(case, twice, once):
        return finding_on(case, say("A length is asked for, but this contains none."))
    return finding_on(case, say("A length is asked for, but not every term here is a length."))


@check(
    of=Dependence,
    rank=40,
    code="independent_of",
    rule="dependence",
    when=_is_formula,
    means="the entry does not contain a joint variable or a length that it must depend on",
    example=("planar-rr", "pose", {"1/4": "a1 c1"}),
    unlike={"1/4": "c1 + c12"},
)
def missing_joints(entry: Dependence) -> Finding | None:
    """Joint variables are missing in the entry."""
    case, names = entry.case, entry.joints
    if not names or any(_is_whole(case, name) for name in names):
        return None
    hint = say(
        "Nothing here depends on {variables}. Check what these joints move.",
        variables=_named(case, names),
    )
    if len(names) == 1:
        hint = say(
            "Nothing here depends on {variable}. Check what this joint moves.",
            variable=_named(case, names),
        )
    return finding_on(case, hint)


@check(
    of=Dependence,
    rank=50,
    code="joint_variable_extra",
    rule="dependence",
    when=_is_formula,
    means="the entry contains a joint variable too many, alone or in a sum of joint angles",
    example=("planar-rrr-drawn", "links", {"A3.1/3": "c12"}),
    unlike={"A2.3/4": "1"},
)
def extra_joints(entry: Dependence) -> Finding | None:
    """The entry contains joint variables that should not be in the entry."""
    case, required = entry.case, entry.required
    assert required is not None
    few = case.samples.subset(1)
    now = _value(case, few.values)
    moving = [
        name
        for name in required.joints
        if name in entry.written - required.symbols
        and not _same(case, _value(case, {**few.values, name: few.values[name] + PROBE}), now)
    ]
    if not moving:
        return None
    hint = say(
        "This must not change with {variables}: check which joints move it.",
        variables=_named(case, moving),
    )
    return finding_on(case, hint)


@check(
    of=Dependence,
    rank=60,
    code="independent_of",
    rule="dependence",
    when=_is_formula,
    means="the entry does not contain a joint variable or a length that it must depend on",
    example=("rigid-motion-chain", "point", {"3/1": "h"}),
    unlike={"3/1": "-pi/2"},
)
def missing_length(entry: Dependence) -> Finding | None:
    """A length is missing in the entry."""
    # The hint does not name the length: it may be the answer.
    required = entry.required
    assert required is not None
    if not required.symbols & required.lengths - entry.written - set(required.joints):
        return None
    hint = say("A length is missing here: check which lengths have a part in this.")
    return finding_on(entry.case, hint)


@check(
    of=Dependence,
    rank=90,
    code=UNEXPLAINED,
    rule="dependence",
    means="the value is wrong, and no other code explains it",
    example=("planar-rr", "pose", {"1/4": "a1 c1 + 2 a2 c12"}),
    unlike={"1/2": "s12"},
)
def unexplained(entry: Dependence) -> Finding:
    """No misconception explains the entry."""
    hint = say("This is not right. Check each term: its factor, length, angle and sign.")
    return differs(entry.case, hint)


def _is_whole(case: WrongEntry, name: str) -> bool:
    # Then the name of the symbol would give the entry away.
    return _same(case, np.abs(case.expected), np.abs(case.samples.values[name]))


def _named(case: WrongEntry, names: Iterable[str]) -> str:
    return listed([case.spelling.names.get(name, name) for name in names])


def _value(case: WrongEntry, values: SymbolValues) -> Numbers:
    value = case.expression.evaluate(values)
    return np.broadcast_to(value, next(iter(values.values())).shape)


def _same(case: WrongEntry, one: Numbers, other: Numbers) -> bool:
    return bool(nearly_equal(one, other, case.scale, case.angle))
