"""Read a wrong table in several ways (readings), and take the best one.

A reading corrects one mistake of the whole table: columns, units, numbers of joints. It is judged
like the table as written. Mistakes that leave the table as it is read, such as a column with wrong
signs, are in ``whole_tables.py``.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import permutations
from typing import Final, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from dh_grader.catalogue import Exercise, Joint
from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.expressions import Expression, Symbol, Vocabulary
from dh_grader.expressions.printing import Spelling
from dh_grader.grading.diagnosis.formulas import quantity_of
from dh_grader.grading.diagnosis.whole_tables import exchanged_columns
from dh_grader.grading.frames import (
    OWN_FRAME_CHOICE,
    FrameFreedom,
    Role,
    freedom_of,
    reference_values,
    written_table,
)
from dh_grader.grading.frames.roles import rows_of_mechanism, usual_rows
from dh_grader.grading.judging import Grading, Judged
from dh_grader.grading.judging_table import (
    EXTRA_ROW,
    FairPoints,
    column_scales,
    extra_row,
    row_too_many,
    with_lazy_cells,
    written_content,
)
from dh_grader.grading.marks import steps_lost
from dh_grader.grading.misconception import SYMBOLS, UNIT_FACTORS, other_length_unit, register
from dh_grader.grading.numbers import INTENDED_CELL, Samples, changes, difference, nearly_equal
from dh_grader.grading.reading.entries import with_absent_variables
from dh_grader.grading.reading.table import (
    COMPUTED,
    IS_ANGLE,
    StudentRow,
    StudentTable,
    table_values,
    values_of,
)
from dh_grader.grading.report import (
    CellReport,
    Finding,
    Place,
    RowReport,
    Verdict,
    WorkBudget,
    row_report,
)
from dh_grader.kinematics import (
    ALPHA,
    COLUMNS,
    SAME_SCREW,
    THETA,
    A,
    CellIndex,
    Convention,
    D,
    Screws,
    Table,
    coincident,
    dependent,
    rank,
    space_jacobian,
)
from dh_grader.translations import Sentence, listed, paragraph, say, template

# --- The readings of a wrong table, and the best of them
#
# The first reading is the table as written. Others are the table with other joint numbers, with its
# columns in another order, with its lengths in another unit, or with a and d of one row exchanged.
# All readings are judged in the same way. A reading counts if it explains enough wrong cells.
#
# Three more readings only limit the points: the table without its extra rows; the table with each
# unread cell replaced by its joint variable or 0; and the table with one row given up
# (``FairPoints``).


class IntendedTable(NamedTuple):
    """A student's table with one mistake corrected; ``cells`` are those that have the mistake."""

    table: StudentTable
    finding: Finding
    cells: frozenset[CellIndex]


# The share of the points that a slip of the whole table costs, regardless of the number of cells.
COST = 0.25
# The work of judging a wrong table once: with given frames, with free ones (more for each row), and
# with a free base or tool or free directions too.
GIVEN_WORK, FREE_WORK, FREE_ROW_WORK, ALL_FREE_WORK = 18.0, 20.0, 4.0, 60.0


class JudgedTable(NamedTuple):
    """The judgement of a table, and the convention in which it was judged."""

    judged: Judged
    convention: Convention


# A function that judges one reading of a table.
Judge: TypeAlias = Callable[[DhTableSpec, StudentTable, Grading], JudgedTable]


class _Reading(NamedTuple):
    """One reading; it counts if at most ``most_wrong`` of its cells are wrong, always if None.

    With ``has_links``, a later part follows from this reading instead of from the table as written.
    """

    intended: IntendedTable
    most_wrong: int | None
    has_links: bool = False


def best_reading(
    part: DhTableSpec, table: StudentTable, first: JudgedTable, judge: Judge, grading: Grading
) -> Judged:
    """Return the judgement of a wrong table in its best reading, with limits on its points.

    ``first`` is the judgement of the table as written.
    """
    work = search_work(part, table, grading)
    readings = _Readings(part, judge, work, grading)
    written = readings.limited(table, first)
    # A table with unread cells has already been charged.
    if not np.isnan(table.values).any():
        grading.reader.budget.charge_search(work)
    best = readings.best(table, written)

    def judged_again(other: StudentTable) -> Judged:
        silent = readings.in_silence()
        return silent.best(other, silent.as_written(other))

    judged_once = _once(judged_again, grading.reader.budget)
    fair = FairPoints(part, judged_once, work, grading).limited(table, best)
    return replace(fair, written=written_content(table, fair.content.given, grading))


def _once(
    judge: Callable[[StudentTable], Judged], budget: WorkBudget
) -> Callable[[StudentTable], Judged]:
    """Return ``judge``, which does not judge the same table again.

    A table whose judgement was charged is judged again, so that the budget stays the same.
    """
    # The tables are kept, so that no other object gets the id of an entry.
    known: dict[object, tuple[StudentTable, Judged]] = {}

    def judged(table: StudentTable) -> Judged:
        entries = tuple(id(entry) for row in table.rows for entry in row.entries)
        written = tuple(row.handed_in.tobytes() for row in table.rows)
        key = entries, written, table.values.tobytes(), table.convention
        if key not in known:
            left = budget.searches, budget.explanations
            found = judge(table)
            if (budget.searches, budget.explanations) != left:
                return found
            known[key] = table, found
        return known[key][1]

    return judged


def search_work(part: DhTableSpec, table: StudentTable, grading: Grading) -> float:
    """Return the amount of computation for judging a wrong table once."""
    rows = len(table.rows)
    once = FREE_WORK + FREE_ROW_WORK * rows
    if part.frames == "given":
        once = GIVEN_WORK
    elif freedom_of(part) != FrameFreedom():
        once = ALL_FREE_WORK
    convention = table.convention if part.convention == "either" else part.convention
    ways = 2 if convention is None else 1
    has_rows_too_many = rows > usual_rows(convention or grading.exercise.robot.convention, grading)
    has_unread_cells = np.isnan(table.values).any()
    return once * (ways + int(has_rows_too_many) + int(has_unread_cells))


@dataclass(frozen=True, slots=True)
class _Readings:
    """The readings of a table; ``work`` is the work of judging one of them."""

    part: DhTableSpec
    judge: Judge
    work: float
    grading: Grading

    def in_silence(self) -> "_Readings":
        return replace(self, grading=replace(self.grading, explains=False))

    def as_written(self, table: StudentTable) -> Judged:
        return self.limited(table, self.judge(self.part, table, self.grading))

    def best(self, table: StudentTable, judged: Judged) -> Judged:
        """Return the judgement of the best reading.

        ``judged`` is the judgement of the table as written.
        """
        chosen: tuple[_Reading, Judged] | None = None
        for reading in self._others(table, judged):
            # Several orders of the columns may fit, but the other readings are alternatives.
            if chosen is not None and not reading.has_links:
                break
            is_certain = reading.most_wrong is None
            if not is_certain and not self.grading.reader.budget.affords_search(self.work):
                break
            without = self.as_written(reading.intended.table)
            if reading.most_wrong is None or without.count_wrong <= reading.most_wrong:
                if chosen is None or without.count_wrong < chosen[1].count_wrong:
                    chosen = reading, without
                if without.is_right:
                    break
        if chosen is None:
            return judged
        reading, without = chosen
        found = _with_slip(reading.intended, without, judged, self.grading)
        if steps_lost(self.part, found) > steps_lost(self.part, judged):
            found = replace(found, at_least=judged)
        return replace(found, chain=without.chain) if reading.has_links else found

    def _others(self, table: StudentTable, judged: Judged) -> Iterator[_Reading]:
        # The readings that explain most come first.
        if (renumbered := by_other_numbering(table, self.grading)) is not None:
            yield _Reading(renumbered, None)
            return
        if judged.whole_cost is not None:
            return
        wrong = judged.count_wrong
        # An unread cell is not read in any order.
        if 3 * np.count_nonzero(np.isnan(table.values).any(axis=-1)) <= wrong:
            for reordered in in_other_orders(table, self.grading):
                # A student with columns in another order still multiplies out the intended links.
                yield _Reading(reordered, wrong // 3, has_links=True)
        if wrong > 1:
            convention = self.part.convention
            named = table.convention if convention == "either" else convention
            if (converted := in_other_length_unit(table, named, self.grading)) is not None:
                yield _Reading(converted, wrong // 2)
            if (exchanged := with_exchanged_row(table, named, self.grading)) is not None:
                yield _Reading(exchanged, wrong - 1)

    def limited(self, table: StudentTable, first: JudgedTable) -> Judged:
        # A wrong table earns no more than it would without its extra rows, because the points
        # belong to the rows of the mechanism. A table with unread cells, whose right values are
        # unknown, earns no more than if each of these cells contained its joint variable or 0.
        judged, convention = first
        if judged.is_right:
            return judged
        fixed = replace(table, convention=convention)
        kept = rows_of_mechanism(table.rows, convention, self.grading)
        if len(kept) < len(table.rows):
            rows = tuple(table.rows[i] for i in kept)
            without = self.as_written(replace(fixed, rows=rows, values=table.values[kept]))
            return _with_extra_rows(fixed, kept, judged, without, self.grading)
        unread = np.isnan(table.values).any(axis=-1)
        # A table without any readable cell earns nothing anyway.
        if unread.any() and not unread.all():
            filled = with_lazy_cells(fixed, convention, self.grading)
            return replace(judged, at_most=self.in_silence().as_written(filled))
        return judged


def _with_slip(
    intended: IntendedTable, without: Judged, judged: Judged, grading: Grading
) -> Judged:
    # ``without`` is the judgement of the table without the mistake, ``judged`` that of the table as
    # written. The cells with the mistake are wrong; together they cost as much as a mistake in the
    # whole table.
    rows = tuple(
        row_report(
            row.label,
            tuple(
                replace(cell, verdict=Verdict.INCORRECT)
                if (i, j) in intended.cells and cell.verdict is Verdict.CORRECT
                else cell
                for j, cell in enumerate(row.cells)
            ),
            row.feedback,
        )
        for i, row in enumerate(without.rows)
    )
    places = tuple(
        Place(rows[i].label, COLUMNS[column])
        for i, column in sorted(intended.cells)
        if i < len(rows)
    )
    return replace(
        without,
        rows=rows,
        feedback=(*grading.messages((intended.finding,), places), *without.feedback),
        whole_cost=COST,
        beside=without,
        lost=judged.lost,
        chain=judged.chain,
    )


def _with_extra_rows(
    table: StudentTable, kept: list[int], judged: Judged, without: Judged, grading: Grading
) -> Judged:
    # ``kept`` are the indices of the mechanism's rows; ``without`` is the judgement of only these
    # rows.
    extra = [i for i, row in enumerate(table.rows) if i not in kept and not row.is_zero]
    is_at_end = kept == list(range(len(kept)))
    if extra and is_at_end and without.is_right and not np.isnan(table.values[extra]).any():
        # Nothing but the rows at the end is wrong.
        messages = grading.messages(tuple(map(extra_row, extra)))
        feedback = (*without.feedback, *messages)
        return replace(without, feedback=feedback, slips=len(extra), chain=judged.chain)
    is_told = any(message.code in EXTRA_ROW.codes for message in judged.feedback)
    of_mechanism = {row.label for row in without.rows}
    beside = [row for row in judged.rows if row.label not in of_mechanism]
    wrong = [row for row in beside if row.verdict is not Verdict.CORRECT]
    # The student's frames may need the rows: then these are right, and another row is wrong.
    is_right = len(beside) == len(table.rows) - len(kept) and not (wrong or judged.slips)
    needs_all = bool(extra) and is_right
    # If nothing that was read is wrong, the table may be right.
    tells = judged.is_wrong and not is_told and not needs_all
    messages = grading.messages(tuple(map(row_too_many, extra))) if tells else ()
    return replace(
        judged,
        rows=_explained_without(judged.rows, without.rows),
        feedback=(*(m for m in judged.feedback if m.code != OWN_FRAME_CHOICE), *messages),
        slips=judged.slips + len(wrong),
        at_most=without,
        needs_all=needs_all,
    )


def _explained_without(
    rows: tuple[RowReport, ...], without: tuple[RowReport, ...]
) -> tuple[RowReport, ...]:
    # ``without`` are the rows of the report on the table without its extra rows. Messages on cells
    # that are wrong only because of an extra row are left out.
    right = {
        (row.label, cell.label): cell
        for row in without
        for cell in row.cells
        if cell.verdict is Verdict.CORRECT
    }
    labels = {row.label for row in without}

    def silent(row: RowReport, cell: CellReport) -> CellReport:
        if cell.verdict is not Verdict.INCORRECT:
            return cell
        if row.label not in labels:
            return replace(cell, feedback=())
        found = right.get((row.label, cell.label))
        return cell if found is None else replace(cell, feedback=found.feedback)

    return tuple(
        row_report(row.label, tuple(silent(row, cell) for cell in row.cells), row.feedback)
        for row in rows
    )


# --- A table with a and d exchanged in one row


_EXCHANGED = [D, 1, A, 3]


def with_exchanged_row(
    table: StudentTable, convention: Convention | None, grading: Grading
) -> IntendedTable | None:
    """Return the table with a and d exchanged in one row, if that corrects both cells.

    Return None unless there is exactly one such row.
    """
    robot = grading.exercise.robot
    reference = robot.tables.get(convention or robot.convention)
    if reference is None or len(reference.rows) != len(table.rows):
        return None
    expected = reference_values(reference, grading.samples)[:, [A, D]]
    written, scale = table.values[:, [A, D]], column_scales(grading)[A]
    as_read = nearly_equal(written, expected, scale, False)
    exchanged = nearly_equal(written[:, ::-1], expected, scale, False)
    found = np.flatnonzero(exchanged.all(axis=-1) & ~as_read.any(axis=-1)).tolist()
    if len(found) != 1:
        return None
    [i] = found
    rows = list(table.rows)
    rows[i] = StudentRow(
        tuple(rows[i].entries[column] for column in _EXCHANGED), rows[i].values[_EXCHANGED]
    )
    intended = replace(table, rows=tuple(rows), values=values_of(rows))
    return IntendedTable(intended, exchanged_columns(A, D), frozenset({(i, A), (i, D)}))


# --- Tables whose lengths are in a wrong unit, such as millimetres instead of metres


# Between two units. The lengths of other frames differ, too, but not by so much.
_HALFWAY: Final = 10**0.5
# With fewer lengths, any number could be a length in another unit.
_LEAST_LENGTHS: Final = 2
_OTHER_UNIT = register(
    of=StudentTable,
    code="other_length_unit",
    rule="link_length",
    means=template("all lengths are in another unit, such as millimetres instead of metres"),
    example=(
        "ur5e",
        "table",
        (
            "0, 90°, 162.5, theta1 ↵ -425, 0, 0, theta2 ↵ -392.2, 0, 0, theta3 ↵ 0, 90°, 133.3, "
            "theta4 ↵ 0, -90°, 99.7, theta5 ↵ 0, 0, 99.6, theta6"
        ),
    ),
    unlike={"1/d": "162.5", "2/a": "-425"},
)


def in_other_length_unit(
    table: StudentTable, convention: Convention | None, grading: Grading
) -> IntendedTable | None:
    """Return the table with its lengths in the unit of the exercise, or None.

    The size of the lengths shows in which unit they were written. Joint variables are not
    converted.
    """
    robot = grading.exercise.robot
    reference = robot.tables.get(convention or robot.convention)
    if reference is None or not np.isfinite(table.values).all():
        return None
    right = np.abs(reference_values(reference, grading.samples)[:, ~IS_ANGLE]).max()
    written = written_table(
        table.values, reference.convention, None, robot.joints, grading.samples
    ).constants
    lengths = np.abs(written).max(axis=-1) * ~IS_ANGLE
    times = _times(lengths.max(), right)
    cells = np.argwhere(lengths > 0).tolist()
    if times is None or len(cells) < _LEAST_LENGTHS:
        return None
    rows = list(table.rows)
    for i, column in cells:
        entries, values = list(rows[i].entries), rows[i].values.copy()
        # The decimals of the entry are not those of the converted number.
        entries[column] = COMPUTED
        values[column] += written[i, column] * (1 / times - 1)
        rows[i] = StudentRow(tuple(entries), values)
    intended = replace(table, rows=tuple(rows), values=values_of(rows))
    finding = replace(other_length_unit(times), code=_OTHER_UNIT.code, rule=_OTHER_UNIT.rule)
    return IntendedTable(intended, finding, frozenset((i, j) for i, j in cells))


def _times(largest: float, right: float) -> float | None:
    # The power of ten by which the lengths are too large, or None if they are not.
    for times in UNIT_FACTORS:
        if right / _HALFWAY < largest / times < right * _HALFWAY:
            return times
    return None


# --- Tables whose joint numbers are not the expected ones, but begin for example with 0


# Maps the names under a numbering to the joint variables that they mean.
Meanings = Mapping[str, str]
_NUMBERED = register(
    of=StudentTable,
    code="joint_numbering",
    rule="joint_variable",
    means=template("the joint numbers start at another number: θ0, θ1, θ2 for θ1, θ2, θ3"),
    example=("planar-rr", "table", {"1/theta": "theta0", "2/theta": "theta1"}),
    unlike={"1/a": "0", "1/d": "a1"},
)
_NUMBERED_BY_KIND = register(
    of=StudentTable,
    code="joint_numbering_by_kind",
    rule="joint_variable",
    means=template(
        "turning and sliding joints are numbered separately: θ1, θ2, d3, θ3 for θ1, θ2, d3, θ4"
    ),
    example=(
        "stanford-arm",
        "table",
        (
            "a, alpha, d, theta ↵ 0, -90deg, 0, theta1 ↵ 0, 90deg, d2, theta2 ↵ 0, 0, d3, 0 ↵ 0, "
            "-90deg, 0, theta3 ↵ 0, 90deg, 0, theta4 ↵ 0, 0, d6, theta5"
        ),
    ),
    unlike="0, -90, 0, theta1 ↵ 0, 90, d2, theta2 ↵ 0, 0, d3, 0 ↵ 0, -90, 0, theta4 ↵ 0, 90, 0, "
    "theta5 ↵ 0, 0, d6, theta6",
)


def by_other_numbering(table: StudentTable, grading: Grading) -> IntendedTable | None:
    """Return the table with its joint variables renumbered.

    Return None if no other numbering gives each row the variable of its own joint.
    """
    joints = grading.exercise.joints
    vocabulary = with_absent_variables(grading.exercise.vocabulary)
    used = [_joint_variables(row, vocabulary) for row in table.rows]
    if all(not names - {joint.variable} for names, joint in zip(used, joints, strict=False)):
        return None
    spelling = grading.spelling(entry for row in table.rows for entry in row.entries)
    written = set[str]().union(*used)
    if written <= {joint.variable for joint in joints}:
        # Another numbering has a name that this robot does not have. Rows that are missing or in
        # other places have only the robot's own names.
        return None
    for finding, every_name in _numberings(joints, spelling):
        if not written <= every_name.keys():
            continue
        meanings = {name: every_name[name] for name in written}
        if not _explains(used, meanings, joints):
            continue
        values = table_values(table.rows, grading.samples.renamed(meanings))
        rows = tuple(
            replace(row, values=cells, as_written=None)
            for row, cells in zip(table.rows, values, strict=True)
        )
        cells = frozenset(
            (i, column)
            for i, row in enumerate(table.rows)
            for column, each in enumerate(row.expressions)
            if each is not None and any(meanings.get(name, name) != name for name in each.symbols)
        )
        return IntendedTable(replace(table, rows=rows, values=values), finding, cells)
    return None


def _joint_variables(row: StudentRow, vocabulary: Vocabulary) -> set[str]:
    symbols = set[str]().union(*(each.symbols for each in row.expressions if each is not None))
    return {name for name in symbols if vocabulary.by_name[name].joint is not None}


def _explains(used: Sequence[set[str]], meanings: Meanings, joints: Sequence[Joint]) -> bool:
    # ``used`` are the joint variables in each row.
    if len(used) < len(joints):
        return False
    own = [joint.variable for joint in joints]
    of_rows = [*own, *[""] * (len(used) - len(own))]
    return all(
        {meanings[name] for name in names} <= {variable}
        for names, variable in zip(used, of_rows, strict=True)
    )


def _numberings(joints: Sequence[Joint], spelling: Spelling) -> Iterator[tuple[Finding, Meanings]]:
    # Each numbering is a finding on it, and a map from written to correct variables.
    first = joints[0].index
    by_index = {joint.index: joint for joint in joints}
    for start in {0, 1, first - 1} - {first}:
        yield (
            _numbered_from(start, joints[0], spelling),
            {
                name: joint.variable
                for joint in joints
                for slides in (False, True)
                for name in [_name(joint.index - first + start, by_index, slides)]
            },
        )
    for slides_too in (False, True):
        meanings: dict[str, str] = {}
        count = {True: 0, False: 0}
        for joint in joints:
            count[joint.prismatic] += 1
            is_counted = slides_too or not joint.prismatic
            name = _name(count[joint.prismatic], by_index, joint.prismatic)
            meanings[name if is_counted else joint.variable] = joint.variable
        renamed = {variable for name, variable in meanings.items() if name != variable}
        moved = [joint for joint in joints if joint.variable in renamed]
        if moved:
            yield _numbered_by_kind(moved[0], spelling), meanings


def _name(index: int, joints: Mapping[int, Joint], slides: bool) -> str:
    joint = joints.get(index)
    if joint is not None and joint.prismatic == slides:
        return joint.variable
    return f"{'d' if slides else 'theta'}{index}"


def _numbered_from(start: int, first: Joint, spelling: Spelling) -> Finding:
    variable = spelling.names.get(first.variable, first.variable)
    return _NUMBERED.finding(
        say(
            "The joint variables are numbered from {start}. This robot's joints are numbered from "
            "{first}: the variable of its first joint is {variable}.",
            start=start,
            first=first.index,
            variable=variable,
        ),
        say("Add {number} to the index of each joint variable.", number=first.index - start),
    )


def _numbered_by_kind(joint: Joint, spelling: Spelling) -> Finding:
    variable = spelling.names.get(joint.variable, joint.variable)
    return _NUMBERED_BY_KIND.finding(
        say(
            "Turning and sliding joints are numbered separately. Number all joints together, from "
            "the base to the end effector: the variable of joint {joint} is {variable}.",
            joint=joint.index,
            variable=variable,
        ),
        say("Number turning and sliding joints together."),
    )


# --- Tables whose columns are not in the expected order, but for example θ, d, a, α
#
# The columns have no headers, or the cells were typed one by one under the headers a, α, d, θ.


# For each written column, from left to right, the column that it is meant to be.
Order = tuple[int, ...]

# The orders of the Robotics Toolbox, of Craig and of Wikipedia; they are preferred among equals.
_USUAL: Final[tuple[Order, ...]] = (
    (THETA, D, A, ALPHA),
    (ALPHA, A, D, THETA),
    (D, THETA, A, ALPHA),
)
# For each column, one of the other quantity: an angle for a length.
_OTHER_QUANTITY: Final[Order] = (ALPHA, A, THETA, D)
# At most this many orders are judged; the first is almost always right.
_MAX_ORDERS: Final = 2
_PERMUTED = register(
    of=StudentTable,
    code="columns_permuted",
    rule="convention",
    means="the columns are in another order, such as θ, d, a, α, without headers that say so",
    example=("planar-rr", "table", "theta1, 0, a1, 0 ↵ theta2, 0, a2, 0"),
    unlike={"1/a": "0"},
)


def in_other_orders(table: StudentTable, grading: Grading) -> Iterator[IntendedTable]:
    """Yield the table in each order of columns that fits the cells better than the written one.

    For example, a column with joint variables must be d or θ, and a column with lengths a or d.
    Only the orders that suit the cells best are tried, the likeliest first.
    """
    if table.reread is None or _suits(table, grading):
        return
    other = table.reread([COLUMNS[column] for column in _OTHER_QUANTITY])
    if len(other.rows) != len(table.rows):
        return
    misfits = _misfits(table, other, grading.exercise.joints)
    orders = [*_USUAL, *(order for order in permutations(range(4)) if order not in _USUAL)]
    found = [int(misfits[range(4), order].sum()) for order in orders]
    if min(found) >= np.trace(misfits):
        return
    tried = [table]
    for order in (
        order for order, misfit in zip(orders, found, strict=True) if misfit == min(found)
    ):
        intended = _reordered(order, table, other)
        changes_to = (np.nan_to_num(np.abs(intended.values - one.values)) for one in tried)
        if any(change.max() < INTENDED_CELL for change in changes_to):
            continue
        if len(tried) > _MAX_ORDERS:
            return
        tried.append(intended)
        finding = _finding(order, named=table.named)
        yield IntendedTable(intended, finding, _moved(intended, table))


def _suits(table: StudentTable, grading: Grading) -> bool:
    sliding = _sliding(grading.exercise.joints)
    known = grading.exercise.vocabulary.by_name
    return all(
        entry.verdict is Verdict.MISSING
        if entry.expression is None
        else _suits_column(entry.expression, column, sliding, known)
        for row in table.rows
        for column, entry in enumerate(row.entries)
    )


def _suits_column(
    expression: Expression, column: int, sliding: Mapping[str, bool], known: Mapping[str, Symbol]
) -> bool:
    # A name before a value may name its column.
    if any(note.code == "equation" for note in expression.notes):
        return False
    moving = [sliding[name] for name in expression.symbols if name in sliding]
    if moving:
        return column == (D if moving[0] else THETA)
    if not IS_ANGLE[column]:
        return expression.source.isdecimal() or quantity_of(expression.tree) != "angle"
    # An angle column is suspicious only if its cell contains a length.
    return all(name in known and known[name].kind != "length" for name in expression.symbols)


def _sliding(joints: Sequence[Joint]) -> dict[str, bool]:
    return {joint.variable: joint.prismatic for joint in joints}


def _misfits(table: StudentTable, other: StudentTable, joints: Sequence[Joint]) -> NDArray[np.int_]:
    # The number of cells of each written column that cannot be a, α, d or θ: (4, 4). ``other`` is
    # the table with lengths read as angles, and angles read as lengths.
    sliding = _sliding(joints)
    count = np.zeros((len(COLUMNS), len(COLUMNS)), np.int_)
    for one, two in zip(table.rows, other.rows, strict=True):
        for place in range(len(COLUMNS)):
            # Read as an angle, a bare number may get a unit that the student did not write.
            as_length = two if IS_ANGLE[place] else one
            expression = as_length.expressions[_OTHER_QUANTITY[place] if IS_ANGLE[place] else place]
            if expression is None or expression.source == "0":
                continue
            moving = [sliding[name] for name in expression.symbols if name in sliding]
            if moving:
                count[place] += np.arange(len(COLUMNS)) != (D if moving[0] else THETA)
            elif (found := quantity_of(expression.tree)) in ("angle", "length"):
                count[place] += (found == "angle") != IS_ANGLE
    return count


def _reordered(order: Order, table: StudentTable, other: StudentTable) -> StudentTable:
    rows = tuple(
        _reordered_row(order, one, two) for one, two in zip(table.rows, other.rows, strict=True)
    )
    # The note on the order of columns is no longer true.
    findings = tuple(each for each in table.findings if each.code != "column_order")
    return replace(table, rows=rows, values=values_of(rows), findings=findings)


def _reordered_row(order: Order, one: StudentRow, two: StudentRow) -> StudentRow:
    cells = []
    for column in range(len(COLUMNS)):
        place = order.index(column)
        is_other = IS_ANGLE[place] != IS_ANGLE[column]
        row, place = (two, _OTHER_QUANTITY[place]) if is_other else (one, place)
        cells.append((row.entries[place], row.values[place]))
    entries, values = zip(*cells, strict=True)
    return StudentRow(entries, np.array(values))


def _moved(intended: StudentTable, table: StudentTable) -> frozenset[CellIndex]:
    error = np.abs(difference(intended.values, table.values, IS_ANGLE[:, None])).max(axis=-1)
    return frozenset((i, column) for i, column in np.argwhere(error > INTENDED_CELL).tolist())


def _finding(order: Order, *, named: bool) -> Finding:
    written = ", ".join(SYMBOLS[column] for column in order)
    advice = say(
        "A table without headers has the order a, α, d, θ: put headers above the columns, or "
        "change their order."
    )
    if named:
        advice = say("Write each parameter under its own header: a, α, d, θ.")
    return _PERMUTED.finding(
        paragraph(say("The columns stand in the order {order}.", order=written), advice),
        say("Write the columns in the order a, α, d, θ."),
    )


# --- Tables whose joints have fewer degrees of freedom than the robot
#
# Two joints that turn about one line, or slide along one direction, move the arm like a single
# joint. More generally, the arm loses a degree of freedom if joint screws are linearly dependent,
# but independent in the reference.


# The samples of each half at which the rank is computed.
POSTURES = 2
# Lengths over this multiple of the typical length make a numerical rank meaningless.
TOO_LONG = 300.0
_LOST = register(
    of=StudentTable,
    code="lost_freedom",
    rule="joint_variable",
    means="some joints share an axis or depend on each other, so the arm has fewer degrees of "
    "freedom than the robot; the message itself costs no points",
    example=("planar-rrr-drawn", "table", {"2/a": "0"}),
    unlike={"1/theta": "q2"},
)


@dataclass(frozen=True, slots=True)
class _Arm:
    joints: tuple[Joint, ...]
    # (samples, 6, joints), in units of the typical length.
    screws: Screws

    def directions(self, i: int) -> NDArray[np.float64]:
        return self.screws[:, 3:, i] if self.joints[i].prismatic else self.screws[:, :3, i]


def freedom_lost(
    roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> tuple[Finding, ...]:
    """Return findings on joints that share an axis or whose motions depend on each other."""
    present = [role for role in roles if role.row is not None]
    joints = grading.exercise.robot.joints
    where = [next((i for i, role in enumerate(present) if role.joint is j), None) for j in joints]
    if None in where:
        return ()
    values = values_of([role.row for role in present if role.row])
    return lost_freedom(values, where, convention, grading.exercise, grading.samples)


def lost_freedom(
    values: Table,
    joint_rows: Sequence[int | None],
    convention: Convention,
    exercise: Exercise,
    samples: Samples,
) -> tuple[Finding, ...]:
    """Return findings on joints that share an axis or whose motions depend on each other.

    ``values`` is the student's table ``(rows, 4, SAMPLES)``, NaN for an unreadable cell.
    ``joint_rows`` is the row of each joint of the robot; joints with the row None are left out. The
    result is empty if a cell is unreadable or extremely large, or if a joint variable is missing.
    """
    table = samples.subset_of(values, POSTURES)
    if not np.isfinite(table).all():
        return ()
    present = [(j, row) for j, row in enumerate(joint_rows) if row is not None]
    own = [D if joint.prismatic else THETA for joint in exercise.robot.joints]
    if any(np.abs(changes(table[row, own[j]])).max() < SAME_SCREW for j, row in present):
        # This joint has no variable; that alone may be why other joints depend on each other.
        return ()
    written = _arm(table, convention, present, exercise)
    if rank(written.screws) == len(present) or np.abs(written.screws).max() > TOO_LONG:
        return ()
    subset = samples.subset(POSTURES)
    reference = exercise.robot.tables[exercise.robot.convention]
    right = reference.values(subset.values, subset.count)
    intended = _arm(right, reference.convention, [(j, j) for j, _ in present], exercise)
    return _shared_axes(written, intended, convention) or _lost_rank(written, intended, convention)


def _arm(
    table: Table, convention: Convention, rows: Sequence[tuple[int, int]], exercise: Exercise
) -> _Arm:
    joints = tuple(exercise.robot.joints[j] for j, _ in rows)
    prismatic = [joint.prismatic for joint in joints]
    screws = space_jacobian(table, convention, tuple(row for _, row in rows), prismatic)
    screws[:, 3:] /= np.where(prismatic, 1.0, exercise.length_scale)
    return _Arm(joints, screws)


def _shared_axes(written: _Arm, intended: _Arm, convention: Convention) -> tuple[Finding, ...]:
    joined = np.triu(coincident(written.screws) & ~coincident(intended.screws))
    findings, done = [], set[int]()
    for i, others in enumerate(joined):
        together = [i, *np.flatnonzero(others).tolist()]
        if len(together) > 1 and not done.intersection(together):
            done.update(together)
            findings.append(_one_axis(together, written, intended, convention))
    return tuple(findings)


def _lost_rank(written: _Arm, intended: _Arm, convention: Convention) -> tuple[Finding, ...]:
    if rank(written.screws) >= rank(intended.screws):
        return ()
    involved = dependent(written.screws)
    if involved.sum() < 2:
        # A single joint cannot be dependent: the samples disagree, so all joints are named.
        involved = np.ones_like(involved)
    names = [str(joint.index) for joint, yes in zip(written.joints, involved, strict=True) if yes]
    first, *_, last = np.flatnonzero(involved).tolist()
    finding = _LOST.finding(
        say(
            "The axes of joints {joints} leave the arm fewer degrees of freedom than the robot "
            "has: check a and α of {rows}.",
            joints=listed(names),
            rows=_rows_between(first, last, written, convention),
        ),
    )
    return (finding,)


def _one_axis(
    together: list[int], written: _Arm, intended: _Arm, convention: Convention
) -> Finding:
    first, last = together[0], together[-1]
    slide = written.joints[first].prismatic
    named = listed([str(written.joints[k].index) for k in together])
    rows = _rows_between(first, last, written, convention)
    if len(together) > 2:
        return _LOST.finding(_lost_degrees(named, rows, slide=slide))
    parallel, right = _lie(intended.directions(first), intended.directions(last))
    return _LOST.finding(_lost_degree(named, "a" if parallel else "α", rows, slide=slide), right)


def _lost_degree(joints: str, column: str, rows: str, *, slide: bool) -> Sentence:
    if slide:
        return say(
            "Joints {joints} slide along one and the same direction, so the arm has lost a degree "
            "of freedom: check {column} of {rows}.",
            joints=joints,
            column=column,
            rows=rows,
        )
    return say(
        "Joints {joints} turn about one and the same line, so the arm has lost a degree of "
        "freedom: check {column} of {rows}.",
        joints=joints,
        column=column,
        rows=rows,
    )


def _lost_degrees(joints: str, rows: str, *, slide: bool) -> Sentence:
    if slide:
        return say(
            "Joints {joints} slide along one and the same direction, so the arm has lost degrees "
            "of freedom: check a and α of {rows}.",
            joints=joints,
            rows=rows,
        )
    return say(
        "Joints {joints} turn about one and the same line, so the arm has lost degrees of "
        "freedom: check a and α of {rows}.",
        joints=joints,
        rows=rows,
    )


def _lie(one: NDArray[np.float64], other: NDArray[np.float64]) -> tuple[bool, Sentence]:
    # True if two axes (samples, 3) are parallel, and a sentence on their directions.
    if np.abs(np.cross(one, other)).max() < SAME_SCREW:
        return True, say("The axes of these joints are parallel, but apart.")
    cosines = np.abs(np.sum(one * other, axis=-1))
    if np.ptp(cosines) > SAME_SCREW:
        return False, say("The axes of these joints are not parallel.")
    if cosines[0] < SAME_SCREW:
        return False, say("The axes of these joints are at right angles.")
    angle = np.degrees(np.arccos(min(cosines[0], 1.0)))
    return False, say("The axes of these joints are at an angle of {angle}°.", angle=f"{angle:.4g}")


def _rows_between(i: int, j: int, written: _Arm, convention: Convention) -> str:
    # The rows whose a and α lead from the axis of joint i to that of joint j. In a standard row,
    # a and α come after its joint; in a modified one, before it.
    shift = int(convention is Convention.MODIFIED)
    labels = [str(joint.index) for joint in written.joints[i + shift : j + shift]]
    if len(labels) == 1:
        return say("row {row}", row=labels[0])
    return say("rows {rows}", rows=listed(labels))
