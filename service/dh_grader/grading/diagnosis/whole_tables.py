"""Slips of a whole table: put into the robot's rows and columns, or undone in an answer.

A slip explains a wrong table if the table describes the robot once the slip is corrected.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain, combinations, islice

import numpy as np
from numpy.typing import NDArray

from dh_grader.catalogue import Joint
from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.expressions import Symbol
from dh_grader.expressions.evaluate import SymbolValues
from dh_grader.grading.frames import (
    RepairedTable,
    Rereadable,
    Role,
    WrittenTable,
    freedom_of,
    reference_values,
    valid_tables,
    written_table,
)
from dh_grader.grading.frames.nearest import frames_from_reference, in_convention
from dh_grader.grading.judging import Grading
from dh_grader.grading.judging_table import Judgement, departures_of, judged_by_intended
from dh_grader.grading.misconception import (
    SYMBOLS,
    AnyHypothesis,
    Explained,
    Record,
    Repaired,
    change_every_sign,
    each_hypothesis,
    misconception,
    records_of,
    register,
    says,
    wrong_throughout,
)
from dh_grader.grading.numbers import CONSTANT, INTENDED_CELL, INTENDED_POSE, Match, difference
from dh_grader.grading.reading.table import IS_ANGLE, table_values, values_of
from dh_grader.grading.report import Finding
from dh_grader.kinematics import ALPHA, COLUMNS, THETA, A, Convention, D, Numbers, Table
from dh_grader.translations import Sentence, listed, paragraph, say, template

# --- Slips of rows and columns


# --- A slip: a mistake in the robot's table, joints or lengths, which leads to a wrong answer
#
# Many slips are tried at once: a single computation takes the changed inputs of all slips.


@dataclass(frozen=True, slots=True)
class SymbolChange:
    """A changed symbol: its value becomes ``factor`` times the ``source``, plus ``offset``."""

    symbol: str
    source: str
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class CellChange:
    """A changed constant of a cell: ``factor`` times the ``source``, plus ``offset``."""

    row: int
    column: int
    factor: float = 1.0
    offset: float = 0.0
    # The row and column of the cell whose constant is multiplied; None for the changed cell itself.
    source: tuple[int, int] | None = None
    # If True, the joint variables in the cells change along with the constants.
    moving: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """A change to the symbols or the table cells from which an answer is computed."""

    symbols: tuple[SymbolChange, ...] = ()
    cells: tuple[CellChange, ...] = ()
    # If True, the links are computed with the formula of the other convention.
    misread: bool = False


@dataclass(frozen=True, slots=True)
class Names:
    """The names of symbols in a message."""

    # Returns the name that the student uses for a symbol.
    name: Callable[[str], str]
    # True for a symbol whose name would reveal the correct entry.
    gives_away: Callable[[str], bool]

    def shown(self, symbol: str) -> str | None:
        """Return the name of a symbol, or None if the name would reveal the correct entry."""
        return None if self.gives_away(symbol) else self.name(symbol)


@dataclass(frozen=True, slots=True)
class SlipWords:
    """The sentences about a slip."""

    # What is wrong, in a clause, so that several slips can be listed.
    clause: Sentence
    # What is wrong and what to check, for this slip alone.
    hint: str
    correction: str = ""


@dataclass(frozen=True, slots=True)
class Slip(Change):
    """A possible mistake of a student: its kind, and the change that it makes."""

    kind: Record
    # Returns the sentences about the slip, with the names that the student uses.
    words: Callable[[Names], SlipWords]

    @property
    def code(self) -> str:
        """The code of the kind of slip, or the name of a kind without a code."""
        return self.kind.name


def changed_values(changes: Sequence[Change], values: SymbolValues) -> dict[str, Numbers]:
    """Return the values ``(K · samples,)`` of each symbol after each of K changes.

    The values after one change are consecutive.
    """
    names = list(values)
    if not names:
        return {}
    places = {name: i for i, name in enumerate(names)}
    right = np.array([values[name] for name in names])
    stacked = np.repeat(right[:, None], len(changes), axis=1)
    changed = [(k, symbol) for k, change in enumerate(changes) for symbol in change.symbols]
    if changed:
        targets = [places[each.symbol] for _, each in changed]
        sources = [places[each.source] for _, each in changed]
        factors = np.array([[each.factor] for _, each in changed])
        offsets = np.array([[each.offset] for _, each in changed])
        stacked[targets, [k for k, _ in changed]] = factors * right[sources] + offsets
    return dict(zip(names, stacked.reshape(len(names), -1), strict=True))


def change_cells(
    changes: Sequence[Change],
    tables: Table,
    right: Table,
    constants: Table,
    first_row: int = 0,
) -> None:
    """Apply each of K changes to its own table in ``tables``, in place.

    ``tables`` is ``(rows, 4, K, count)`` for ``count`` samples.
    """
    # right (rows, 4, count) is the correct table, constants the same table with all joint variables
    # 0. All three arrays begin with row first_row of the whole table.
    cells = [(k, cell) for k, change in enumerate(changes) for cell in change.cells]
    if not cells:
        return
    written = np.stack([constants, right])
    numbers = np.array(
        [
            (k, cell.moving, cell.row, cell.column, *(cell.source or (cell.row, cell.column)))
            for k, cell in cells
        ]
    ).T
    ways, moving, rows, columns, source_rows, source_columns = numbers
    rows, source_rows = rows - first_row, source_rows - first_row
    factors = np.array([[cell.factor] for _, cell in cells])
    offsets = np.array([[cell.offset] for _, cell in cells])
    sources = written[moving, source_rows, source_columns]
    tables[rows, columns, ways] += factors * sources - written[moving, rows, columns] + offsets


# They change numbers of the table, but no symbols.


@dataclass(frozen=True, slots=True)
class TableRows:
    """The rows of a wrong DH table; each possible mistake is tried on them."""

    # The cells (rows, 4) at one sample, with all joint variables 0.
    constants: Numbers
    # The joints of the first rows.
    joints: Sequence[Joint]
    # The labels of all rows.
    labels: Sequence[str]
    convention: Convention
    # True if the answer is for the home position, so that no joint moves.
    home: bool = False
    # True if the answer is the product of the links, False if it is the links themselves.
    multiplied: bool = True

    def moves(self, row: int, column: int) -> bool:
        """True if a cell contains a joint variable."""
        if self.home or row >= len(self.joints):
            return False
        return column == (D if self.joints[row].prismatic else THETA)


def slips_of_rows(rows: TableRows) -> Iterator[Slip]:
    """Yield the slips in whole rows and columns."""
    yield from exchanged_throughout(rows)
    yield from negated_columns(rows)
    yield from other_table(rows)
    yield from exchanged_rows(rows)
    yield from missing_links(rows) if rows.multiplied else other_formula(rows)


def exchanged_in_row(
    row: int, label: str, constants: Sequence[float], *, slides: bool
) -> Iterator[Slip]:
    """Yield the slips in which a and d are exchanged in one row."""

    # If the joint slides, the last slip also moves the joint variable from d to a.
    def words(_: Names) -> SlipWords:
        return SlipWords(
            say("the length a and the offset d are exchanged in row {row}", row=label),
            say(
                "The length a and the offset d are exchanged in row {row}: a is measured along x, "
                "d along z.",
                row=label,
            ),
            say("Exchange a and d in row {row}.", row=label),
        )

    ways = [False] if abs(constants[A] - constants[D]) > CONSTANT else []
    for moving in [*ways, True] if slides else ways:
        yield Slip(COLUMNS_SWAPPED, words, cells=_exchanged_cells(row, moving=moving))


def exchanged_throughout(rows: TableRows) -> Iterator[Slip]:
    """Yield the slip in which a and d are exchanged in all rows."""

    def words(_: Names) -> SlipWords:
        return SlipWords(
            say("the lengths a and the offsets d are exchanged throughout"),
            say(
                "The lengths a and the offsets d are exchanged throughout: a is measured along x, "
                "d along z."
            ),
            say("Exchange a and d in every row."),
        )

    cells = tuple(cell for i in range(len(rows.constants)) for cell in _exchanged_cells(i))
    yield Slip(COLUMNS_SWAPPED, words, cells=cells)


def _exchanged_cells(row: int, *, moving: bool = False) -> tuple[CellChange, ...]:
    return (
        CellChange(row, A, source=(row, D), moving=moving),
        CellChange(row, D, source=(row, A), moving=moving),
    )


def negated_columns(rows: TableRows) -> Iterator[Slip]:
    """Yield the slips in which all signs of one column are wrong."""
    # The joint variables in the column have the wrong sign, too, or keep their signs.
    for column in range(len(COLUMNS)):
        cells = rows.constants[:, column]
        sizes = np.sin(cells) if IS_ANGLE[column] else cells
        wrong = {i for i, size in enumerate(sizes.tolist()) if abs(size) > CONSTANT}
        moved = {i for i in range(len(cells)) if rows.moves(i, column)}
        # In one row alone it is a slip of the cell.
        if len(wrong) > 1:
            yield _negated(column, wrong, moving=False)
        if moved and len(wrong | moved) > 1:
            yield _negated(column, wrong | moved, moving=True)


def _negated(column: int, rows: Iterable[int], *, moving: bool) -> Slip:
    def words(_: Names) -> SlipWords:
        clause = say("{symbol} has the wrong sign throughout", symbol=SYMBOLS[column])
        return SlipWords(clause, wrong_throughout(column), change_every_sign(column))

    cells = tuple(CellChange(i, column, -1.0, moving=moving) for i in rows)
    return Slip(PARAMETER_SIGN, words, cells=cells)


def other_table(rows: TableRows) -> Iterator[Slip]:
    """Yield the slips in which the table was written in the other DH convention."""
    # Then a and α are in a neighbouring row.
    last = len(rows.constants) - 1
    cells: list[CellChange] = []
    if rows.convention is Convention.STANDARD:
        moved = [(i + 1, i) for i in range(last)]
        cells = [cell for i, source in moved for cell in _of_link(i, source)]
        cells += [CellChange(0, column, 0.0) for column in (A, ALPHA)]
        if rows.multiplied and np.abs(rows.constants[last, : ALPHA + 1]).max() > CONSTANT:
            yield _other_table(rows.convention, (*cells, *_of_link(last + 1, last)))
    elif np.abs(rows.constants[0, : ALPHA + 1]).max() < CONSTANT:
        cells = [cell for i in range(last) for cell in _of_link(i, i + 1)]
        cells += [CellChange(last, column, 0.0) for column in (A, ALPHA)]
    if cells:
        yield _other_table(rows.convention, tuple(cells))


def _of_link(row: int, source: int) -> tuple[CellChange, ...]:
    return tuple(CellChange(row, column, source=(source, column)) for column in (A, ALPHA))


def _other_table(convention: Convention, cells: tuple[CellChange, ...]) -> Slip:
    is_standard = convention is Convention.STANDARD
    words = _modified_table_multiplied if is_standard else _standard_table_multiplied
    return Slip(OTHER_CONVENTION, words, cells=cells)


def _modified_table_multiplied(_: Names) -> SlipWords:
    return SlipWords(
        say(
            "a table of the modified convention is multiplied with the link transform of the "
            "standard one"
        ),
        say(
            "A table of the modified convention is multiplied with the link transform of the "
            "standard one: use the same convention for both."
        ),
        say("In the other convention a and α stand one row higher or lower."),
    )


def _standard_table_multiplied(_: Names) -> SlipWords:
    return SlipWords(
        say(
            "a table of the standard convention is multiplied with the link transform of the "
            "modified one"
        ),
        say(
            "A table of the standard convention is multiplied with the link transform of the "
            "modified one: use the same convention for both."
        ),
        say("In the other convention a and α stand one row higher or lower."),
    )


def other_formula(rows: TableRows) -> Iterator[Slip]:
    """Yield the slip in which the links are computed with the formula of the other convention."""
    has_twists = (np.cos(rows.constants[:, ALPHA]) < 1 - CONSTANT).any()
    if rows.convention is Convention.STANDARD and not has_twists:
        return
    is_standard = rows.convention is Convention.STANDARD
    words = _modified_formula if is_standard else _standard_formula
    yield Slip(OTHER_CONVENTION, words, misread=True)


def _modified_formula(_: Names) -> SlipWords:
    return SlipWords(
        say(
            "the link transform of the modified convention is used with a table of the standard one"
        ),
        say(
            "The link transform of the modified convention is used with a table of the standard "
            "one: use the same convention for both."
        ),
        say("Use the link transform of the standard convention."),
    )


def _standard_formula(_: Names) -> SlipWords:
    return SlipWords(
        say(
            "the link transform of the standard convention is used with a table of the modified one"
        ),
        say(
            "The link transform of the standard convention is used with a table of the modified "
            "one: use the same convention for both."
        ),
        say("Use the link transform of the modified convention."),
    )


def exchanged_rows(rows: TableRows) -> Iterator[Slip]:
    """Yield the slips in which two rows are exchanged."""
    # With or without their joint variables.
    count = len(rows.constants)
    kinds = [joint.prismatic for joint in rows.joints]
    for i, j in combinations(range(count), 2):
        labels = rows.labels[i], rows.labels[j]
        # The reverse order of all links is a slip of the product.
        if not (rows.multiplied and i == 0 and j == count - 1 <= 2):
            words = partial(_rows_or_links, *labels)
            yield Slip(ROW_ORDER, words, cells=_rows_exchanged(i, j, moving=True))
        if j < len(kinds) and kinds[i] == kinds[j] and not rows.home:
            words = partial(_rows_but_variables, *labels)
            yield Slip(ROW_ORDER, words, cells=_rows_exchanged(i, j, moving=False))


def _rows_or_links(one: str, other: str, _: Names) -> SlipWords:
    return SlipWords(
        say(
            "rows {one} and {other}, or their link transforms, are exchanged", one=one, other=other
        ),
        say(
            "Rows {one} and {other}, or their link transforms, are exchanged: check which joint "
            "each row of the table belongs to.",
            one=one,
            other=other,
        ),
    )


def _rows_but_variables(one: str, other: str, _: Names) -> SlipWords:
    return SlipWords(
        say(
            "rows {one} and {other} are exchanged, but for their joint variables",
            one=one,
            other=other,
        ),
        say(
            "Rows {one} and {other} are exchanged, but for their joint variables: check which "
            "joint each row of the table belongs to.",
            one=one,
            other=other,
        ),
    )


def _rows_exchanged(one: int, other: int, *, moving: bool) -> tuple[CellChange, ...]:
    return tuple(
        CellChange(row, column, source=(source, column), moving=moving)
        for row, source in ((one, other), (other, one))
        for column in range(len(COLUMNS))
    )


def missing_links(rows: TableRows) -> Iterator[Slip]:
    """Yield the slips in which a row is missing in the product."""
    # It is not the first or last row.
    for row in range(1, len(rows.constants) - 1):
        cells = tuple(CellChange(row, column, 0.0, moving=True) for column in range(len(COLUMNS)))
        yield Slip(MISSING_LINK, partial(_missing_link, f"A{rows.labels[row]}"), cells=cells)


def _missing_link(link: str, _: Names) -> SlipWords:
    clause = say("{link} is missing in the product", link=link)
    return SlipWords(clause, clause)


# --- The kinds of slips in the robot's table, joints or lengths, likeliest first


JOINT_VARIABLE_SIGN = register(
    of=Slip,
    rank=10,
    code="joint_variable_sign",
    rule="product",
    means="a joint moves in the wrong direction about or along its axis",
    example=("planar-rr", "position", "[a1 c1 + a2 cos(q1 - q2), a1 s1 + a2 sin(q1 - q2)]"),
    unlike="[a1 c1 - a2 c12, a1 s1 - a2 s12]",
)
HOME_POSITION = register(
    of=Slip,
    rank=20,
    code="home_position",
    rule="product",
    means="the answer holds only for the home position",
    example=("planar-rr", "position", "[a1 + a2, 0]"),
    unlike={"2/1": "0"},
)
JOINT_VARIABLE_MISSING = register(
    of=Slip,
    rank=30,
    code="joint_variable_missing",
    rule="product",
    means="the variable of a joint is left out, so the joint does not move",
    example=("planar-rr", "position", "[(a1 + a2) c1, (a1 + a2) s1]"),
    unlike="[a1 c1, a1 s1]",
)
SIGN = register(
    of=Slip,
    rank=40,
    code="sign",
    rule="product",
    means="a length or an angle of the table has the wrong sign",
    example=("planar-rr", "position", "[a1 c1 - a2 c12, a1 s1 - a2 s12]"),
    unlike="[a1 c1, a1 s1]",
)
DISTANCE_LEFT_OUT = register(
    of=Slip,
    rank=50,
    code="distance_left_out",
    rule="product",
    means="a length of the table is left out",
    example=("planar-rr", "position", "[a1 c1, a1 s1]"),
    unlike="[a1 c1 - a2 c12, a1 s1 - a2 s12]",
)
QUARTER_TURN = register(
    of=Slip,
    rank=60,
    code="quarter_turn",
    rule="product",
    means="an angle of the table, or the zero position of a joint, is off by 90°",
    example=("planar-rr", "position", "[a1 c1 - a2 s12, a1 s1 + a2 c12]"),
    unlike={"1/1": "a1*c1 - a2*c12"},
)
COLUMNS_SWAPPED = register(
    of=Slip,
    rank=70,
    code="columns_swapped",
    rule="product",
    means="a and d are exchanged, throughout or in one row",
    example=(
        "planar-rr",
        "pose",
        "[c12, -s12, 0, 0; s12, c12, 0, 0; 0, 0, 1, a1 + a2; 0, 0, 0, 1]",
    ),
    unlike={"3/4": "a1"},
)
PARAMETER_SIGN = register(
    of=Slip,
    rank=80,
    code="parameter_sign",
    rule="product",
    means="one of a, α, d, θ has the wrong sign in every row",
    example=("three-link-cartesian", "position", "[-d3, -d2, d1]"),
    unlike="[d1, d2, d3]",
)
OTHER_CONVENTION = register(
    of=Slip,
    rank=90,
    code="other_convention",
    rule="convention",
    means="the table is multiplied out with the link transform of the other convention",
    example=(
        "spatial-rrr",
        "links",
        (
            "[c1, -s1, 0, R; 0, 0, -1, 0; s1, c1, 0, 0; 0, 0, 0, 1] ↵ [c2, -s2, 0, L1; s2, c2, 0, "
            "0; 0, 0, 1, 0; 0, 0, 0, 1] ↵ [c3, -s3, 0, L2; s3, c3, 0, 0; 0, 0, 1, 0; 0, 0, 0, 1]"
        ),
    ),
    unlike={"A1.2/4": "R*s2"},
)
LENGTHS_EXCHANGED = register(
    of=Slip,
    rank=100,
    code="lengths_exchanged",
    rule="product",
    means="two lengths of the table are exchanged",
    example=("planar-rr", "position", "[a2 c1 + a1 c12, a2 s1 + a1 s12]"),
    unlike={"1/1": "a1*c1 - a2*c12"},
)
OTHER_LENGTH = register(
    of=Slip,
    rank=110,
    code="other_length",
    rule="product",
    means="one length is used in place of another",
    example=("planar-rr", "position", "[a1 c1 + a1 c12, a1 s1 + a1 s12]"),
    unlike={"1/1": "a1*c1 - a2*c12"},
)
JOINT_VARIABLE_INDEX = register(
    of=Slip,
    rank=120,
    code="joint_variable_index",
    rule="product",
    means="a joint moves by the variable of another joint",
    example=("planar-rr", "position", "[a1 c1 + a2 cos(2 q1), a1 s1 + a2 sin(2 q1)]"),
    unlike="[(a1 + a2) c1, (a1 + a2) s1]",
)
ANGLE_LEFT_OUT = register(
    of=Slip,
    rank=130,
    code="angle_left_out",
    rule="product",
    means="an angle of the table that is no multiple of 90° is left out",
    example=("arm", "position", "[a3 c1 c3 + b3 s1, a3 s1 c3 - b3 c1, a3 s3 + d2]"),
    unlike="[a3 c1 c3, a3 s1 c3, a3 s3 + d2]",
)
HALF_TURN = register(
    of=Slip,
    rank=140,
    code="half_turn",
    rule="product",
    means="an angle of the table, or the zero position of a joint, is off by 180°",
    example=(
        "planar-rr",
        "pose",
        "[-c12, s12, 0, a1*c1 - a2*c12; -s12, -c12, 0, a1*s1 - a2*s12; 0, 0, 1, 0; 0, 0, 0, 1]",
    ),
    unlike={"3/2": "1", "3/3": "0"},
)
JOINT_VARIABLE_DOUBLED = register(
    of=Slip,
    rank=150,
    code="joint_variable_doubled",
    rule="product",
    means="a joint variable counts twice",
    example=("planar-rr", "position", "[a1 c1 + a2 cos(q1 + 2 q2), a1 s1 + a2 sin(q1 + 2 q2)]"),
    unlike="[a1 c1 + a2 cos(2 q1), a1 s1 + a2 sin(2 q1)]",
)
ROW_ORDER = register(
    of=Slip,
    rank=160,
    code="row_order",
    rule="product",
    means="two rows, or their link transforms, are exchanged",
    example=("turret", "position", "[a3 c1 c3, a3 s1 c3, a3 s3]"),
    unlike="[a3 c1 c2, a3 s1 c2, a3 s2]",
)
# Listed only together with exchanged rows. Otherwise ``link_products`` names the missing link.
MISSING_LINK = register(of=Slip, rank=170, name="missing_link")


# --- Slips that explain a wrong table: it describes the robot once they are corrected


_OF_LINK = slice(A, ALPHA + 1)


@dataclass(frozen=True, slots=True)
class WrongTable:
    """A wrong table."""

    # The table at all samples.
    written: WrittenTable
    # The table at a few samples, which make comparisons fast.
    subset: WrittenTable
    # Takes tables (T, rows, 4, samples) at these few samples, and returns a mask (T,) of the tables
    # that describe the robot.
    valid: Callable[[Table, Convention], NDArray[np.bool_]]

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> list[AnyHypothesis]:
        """Return the hypotheses (possible mistakes) that explain the table."""
        # The hypotheses must be tables at the few samples; all are compared at once.
        tried = list(hypotheses)
        explains = np.zeros(len(tried), dtype=np.bool_)
        for convention in Convention:
            places = [i for i, each in enumerate(tried) if each.answer.convention is convention]
            if places:
                tables = np.array([tried[i].answer.values for i in places])
                explains[places] = self.valid(tables, convention)
                if convention is self.subset.convention:
                    change = np.abs(tables - self.subset.values).max(axis=(1, 2, 3))
                    explains[places] &= change > INTENDED_POSE
        return [tried[i] for i in np.flatnonzero(explains)]


@misconception(
    of=WrittenTable,
    rank=50,
    code="link_columns_shifted",
    rule="convention",
    means=template("the columns a and α, or one of them, are one row too early or too late"),
    example=("three-link-cylindrical", "table", {"1/alpha": "-90deg", "2/alpha": "0"}),
    unlike={"2/a": "d3", "3/d": "0"},
)
def link_columns_shifted(table: WrittenTable) -> Iterator[RepairedTable]:
    """Column a, column α or both are shifted by one row."""
    rows = list(range(len(table.constants)))
    up, down = [*rows[1:], rows[0]], [rows[-1], *rows[:-1]]
    for columns in (_OF_LINK, slice(A, A + 1), slice(ALPHA, ALPHA + 1)):
        for late, order, end in ((True, up, -1), (False, down, 0)):
            of_other = late == (table.convention is Convention.STANDARD)
            other = table.convention.other if of_other and columns == _OF_LINK else None
            finding = partial(_shifted, listed(SYMBOLS[columns]), late, other)
            constants = table.constants.copy()
            constants[:, columns] = table.constants[order, columns]
            yield Repaired(table.changed(constants), finding)
            is_open = np.abs(table.values[-1 - end, columns]).max() < INTENDED_CELL
            if table.reference is not None and is_open:
                # The cells that belong at the open end are not in the student's table.
                completed = constants.copy()
                completed[end, columns] = table.reference[end, columns]
                yield Repaired(table.changed(completed), finding)


def _shifted(named: str, late: bool, other: Convention | None) -> Finding:
    # other is the convention in which the columns are in the correct place, or None.
    in_other = ""
    if other is Convention.STANDARD:
        in_other = say("In the standard convention they stand there.")
    elif other is Convention.MODIFIED:
        in_other = say("In the modified convention they stand there.")
    if late:
        hint = say(
            "{columns} stand one row too late: check which link each of them describes.",
            columns=named,
        )
        return says(paragraph(hint, in_other), say("Move {columns} up by one row.", columns=named))
    hint = say(
        "{columns} stand one row too early: check which link each of them describes.",
        columns=named,
    )
    return says(paragraph(hint, in_other), say("Move {columns} down by one row.", columns=named))


@misconception(
    of=WrittenTable,
    rank=60,
    code="column_sign",
    rule="of_column",
    means=template("one of a, α, d, θ has the wrong sign in every row"),
    example=("rrrp", "table", "-l2, 0, l1, q1 ↵ -l3, 180°, 0, q2 ↵ 0, 0, l4, q3 ↵ 0, 0, q4, 0"),
    unlike="l2, 0, l1, q1 ↵ l3, 180deg, 0, q2 ↵ q3, l4, 0, 0 ↵ 0, 0, q4, 0",
)
def column_sign(table: WrittenTable) -> Iterator[RepairedTable]:
    """One column has the wrong sign in all rows."""
    # With or without its joint variables.
    for column in range(len(COLUMNS)):
        constants, motion = table.constants.copy(), table.motion.copy()
        constants[:, column] *= -1
        motion[:, column] *= -1
        if table.constants[:, column].any():
            yield Repaired(table.changed(constants), partial(_turned_sign, column))
        if table.motion[:, column].any():
            yield Repaired(table.changed(constants, motion), partial(_turned_sign, column))


def _turned_sign(column: int) -> Finding:
    return says(wrong_throughout(column), change_every_sign(column))


@misconception(
    of=WrittenTable,
    rank=70,
    code="columns_swapped",
    rule="of_column",
    means=template("a and d, or α and θ, are exchanged, throughout or in one row"),
    example=("planar-rr", "table", {"1/a": "0", "1/d": "a1"}),
    unlike={"2/d": "90°"},
)
def columns_swapped(table: WrittenTable) -> Iterator[RepairedTable]:
    """Two columns are exchanged: a with d, or α with θ."""
    # The exchange is in all rows or in one, with or without the joint variables.
    for one, other in ((A, D), (ALPHA, THETA)):
        still = np.abs(table.constants[:, one] - table.constants[:, other]).max(axis=-1) > 0
        moving = np.abs(table.motion[:, one] - table.motion[:, other]).max(axis=-1) > 0
        for row in (None, *range(len(still))):
            rows = slice(None) if row is None else slice(row, row + 1)
            finding = partial(exchanged_columns, one, other)
            constants = _exchanged(table.constants, rows, one, other)
            if still[rows].any():
                yield Repaired(table.changed(constants), finding)
            if moving[rows].any():
                motion = _exchanged(table.motion, rows, one, other)
                yield Repaired(table.changed(constants, motion), finding)


def _exchanged(cells: Table, rows: slice, one: int, other: int) -> Table:
    exchanged = cells.copy()
    exchanged[rows, [one, other]] = cells[rows, [other, one]]
    return exchanged


def exchanged_columns(one: int, other: int) -> Finding:
    """Return the finding that two columns are exchanged."""
    # In all rows or in one row.
    hint = say("a and d are exchanged: a is measured along x, d along z.")
    if one == ALPHA:
        hint = say("α and θ are exchanged: α is measured about x, θ about z.")
    names = {"one": SYMBOLS[one], "other": SYMBOLS[other]}
    return Finding("columns_swapped", hint, say("Exchange {one} and {other}.", **names))


@misconception(
    of=WrittenTable,
    rank=80,
    code="row_order",
    rule="rows",
    means=template("two rows are exchanged, or all rows, or all but the last, are reversed"),
    example=(
        "planar-rr",
        "table",
        {"1/a": "a2", "1/theta": "theta2", "2/a": "a1", "2/theta": "theta1"},
    ),
    unlike={"2/d": "90°"},
)
def row_order(table: WrittenTable) -> Iterator[RepairedTable]:
    """Two rows are exchanged, or the rows are in reverse order."""
    # The last row may keep its place.
    rows = range(len(table.constants))
    exchanges = [{i: j, j: i} for i, j in combinations(rows, 2)]
    orders = [[exchange.get(row, row) for row in rows] for exchange in exchanges]
    if len(rows) > 2:
        orders.append([*reversed(rows)])
    if len(rows) > 3:
        orders.append([*reversed(rows[:-1]), rows[-1]])
    for order in orders:
        repaired = table.changed(table.constants[order], table.motion[order])
        yield Repaired(repaired, partial(_reordered, order))


def _reordered(order: list[int]) -> Finding:
    moved = [str(i + 1) for i, row in enumerate(order) if row != i]
    return says(
        say(
            "Rows {rows} stand in the wrong order: row i belongs to joint i, counted from the "
            "base.",
            rows=listed(moved) if len(moved) == 2 else ", ".join(moved),
        ),
    )


@misconception(
    of=WrittenTable,
    rank=40,
    code="lengths_exchanged",
    rule="of_column",
    means=template("two lengths are exchanged: a1 for a2, and a2 for a1"),
    example=("spatial-rrr", "table", {"1/a": "L2", "3/a": "R"}),
    unlike={"3/a": "0", "3/d": "L2"},
)
def lengths_exchanged(table: WrittenTable) -> Iterator[RepairedTable]:
    """Two lengths were exchanged, but not a and d of the same row."""
    for one, other, change in table.exchanges:
        repaired = table.constants + change
        rows = np.flatnonzero(change.any(axis=(1, 2)))
        if len(rows) == 1:
            row = slice(rows[0], rows[0] + 1)
            swapped = _exchanged(table.constants, row, A, D)
            if np.abs(repaired - swapped).max() < INTENDED_CELL:
                continue
        yield Repaired(table.changed(repaired), partial(_exchanged_lengths, one, other))


def _exchanged_lengths(one: str, other: str) -> Finding:
    return says(
        say(
            "{one} and {other} are exchanged: check which length each of them is.",
            one=one,
            other=other,
        ),
        say("Exchange {one} and {other}.", one=one, other=other),
    )


def _with_another(
    basic: Record, others: Sequence[Record], table: WrittenTable
) -> Iterator[Explained]:
    for first in each_hypothesis((basic,), table):
        for second in each_hypothesis(others, first.answer):
            yield Repaired(second.answer, partial(_both, first, second), record=second.record)


def _both(first: Explained, second: Explained) -> tuple[Finding, ...]:
    return (*first.findings, *second.findings)


def explaining(case: WrongTable, *, combine: bool) -> list[Explained]:
    """Return all misconceptions that explain the whole table."""
    # If there are none, and combine is true, return the first pair of misconceptions that explains
    # the table together.
    records = records_of(WrittenTable)
    found = list(_explaining(case, [partial(each_hypothesis, (each,)) for each in records]))
    if found or not combine:
        return found
    pairs = [
        partial(_with_another, each, records[i + 1 :])
        for i, each in enumerate(records_of(Rereadable))
    ]
    return list(islice(_explaining(case, pairs), 1))


def _explaining(
    case: WrongTable, ways: Sequence[Callable[[WrittenTable], Iterator[Explained]]]
) -> Iterator[Explained]:
    tried = [(build, list(build(case.subset))) for build in ways]
    every = chain.from_iterable(hypotheses for _, hypotheses in tried)
    explains = set(map(id, case.explained_by(every)))
    for build, hypotheses in tried:
        if not explains.isdisjoint(map(id, hypotheses)):
            # At all samples a misconception may yield fewer, if a value jumps between samples.
            for at_subset, complete in zip(hypotheses, build(case.written), strict=False):
                if id(at_subset) in explains:
                    yield complete


# --- The findings on a wrong table as a whole


_OF_UNIT = frozenset({"degrees_as_radians", "radians_as_degrees"})

# If more lengths are in wrong cells, the search for two exchanged ones is not reliable.
MAX_LENGTHS = 4

# Samples of each half that are enough to compare dozens of tables.
TABLE_SAMPLES = 3


@dataclass(frozen=True, slots=True)
class _Intended:
    # The slips that are corrected in the table.
    findings: tuple[Finding, ...]
    # (rows, 4, SAMPLES), or None if it needs other rows than the student wrote.
    table: Table | None
    # The cells (rows, 4) that differ from the student's table.
    changed: NDArray[np.bool_]
    # How far its frames are from the reference's frames.
    departures: float


def explained(
    part: DhTableSpec,
    roles: tuple[Role, ...],
    convention: Convention,
    judgement: Judgement,
    grading: Grading,
    *,
    combine: bool,
) -> tuple[tuple[Finding, ...], Judgement]:
    """Return the findings that explain a whole wrong table, and a judgement that fits them.

    Pairs of misconceptions are tried only if ``combine`` is true.
    """
    # Misconceptions that would make the whole table correct are compared with the cells that were
    # found wrong. If none of them fits, there are no findings and the judgement is unchanged.
    values = values_of([role.row for role in roles if role.row is not None])
    if len(values) < len(roles) or not np.isfinite(values).all():
        return (), judgement
    exchanges = tuple(_exchanges(judgement, roles, grading))
    case = _wrong_table(part, roles, convention, values, exchanges, grading)
    found = explaining(case, combine=combine)
    intended: list[_Intended] = []
    wrong = judgement.matches < Match.ROUNDED
    for repaired in found:
        intended.append(_intended(repaired, case.written, roles, grading))
        findings, table = intended[-1].findings, intended[-1].table
        if table is not None and not np.array_equal(intended[-1].changed, wrong):
            # A table that is right in the other convention is no coincidence of single cells.
            if _is_other_convention(intended[-1], judgement):
                break
            continue
        if table is None or _OF_UNIT.intersection(finding.code for finding in findings):
            # Converted numbers are rounded, so they do not show the frames.
            return findings, replace(judgement, findings=())
        # The student's frames are those of the table without the slip.
        chosen = judged_by_intended(table, roles, convention, grading).findings
        return findings, replace(judgement, findings=chosen)
    nearest = min(intended, key=lambda each: each.departures, default=None)
    if nearest is None or nearest.table is None:
        return (), judgement
    is_nearer = nearest.departures < judgement.departures
    if not (is_nearer or _is_other_convention(nearest, judgement)):
        return (), judgement
    return nearest.findings, judged_by_intended(nearest.table, roles, convention, grading)


def _is_other_convention(intended: _Intended, judgement: Judgement) -> bool:
    codes = [finding.code for finding in intended.findings]
    return codes == ["other_convention"] and intended.departures <= judgement.departures


def _wrong_table(
    part: DhTableSpec,
    roles: tuple[Role, ...],
    convention: Convention,
    values: Table,
    exchanges: tuple[tuple[str, str, Table], ...],
    grading: Grading,
) -> WrongTable:
    exercise, samples = grading.exercise, grading.samples
    table = exercise.robot.tables.get(convention)
    reference = None if table is None else reference_values(table, samples)
    written = written_table(values, convention, reference, exercise.robot.joints, samples)
    written = replace(written, exchanges=exchanges)
    freedom, subset = freedom_of(part), samples.subset(TABLE_SAMPLES)

    def valid(tables: Numbers, convention: Convention) -> NDArray[np.bool_]:
        return valid_tables(tables, roles, convention, freedom, exercise, subset, INTENDED_POSE)

    return WrongTable(written, written.subset(TABLE_SAMPLES), valid)


def _exchanges(
    judgement: Judgement, roles: Sequence[Role], grading: Grading
) -> Iterator[tuple[str, str, Table]]:
    # How the table changes if two lengths in wrong cells are exchanged.
    by_name = grading.exercise.vocabulary.by_name
    lengths: set[str] = set()
    for i, column in np.argwhere(judgement.matches < Match.ROUNDED).tolist():
        row = judgement.rows[i].row
        expression = None if row is None else row.expressions[column]
        if expression is not None:
            lengths.update(name for name in expression.symbols if _is_length(by_name.get(name)))
    if not 2 <= len(lengths) <= MAX_LENGTHS:
        return
    rows = [role.row for role in roles if role.row is not None]
    written = table_values(rows, grading.samples)
    for one, other in combinations(sorted(lengths), 2):
        exchanged = grading.samples.renamed({one: other, other: one})
        yield one, other, table_values(rows, exchanged) - written


def _is_length(symbol: Symbol | None) -> bool:
    return symbol is not None and symbol.kind == "length" and symbol.joint is None


def _intended(
    repaired: Explained, written: WrittenTable, roles: tuple[Role, ...], grading: Grading
) -> _Intended:
    table = in_convention(repaired.answer, written.convention)
    if table is None:
        nothing = np.zeros(written.values.shape[:2], np.bool_)
        return _Intended(repaired.findings, None, nothing, np.inf)
    error = np.abs(difference(table, written.values, IS_ANGLE[:, None])).max(axis=-1)
    frames = frames_from_reference(table, roles, written.convention, grading)
    departures = departures_of(frames, grading)
    return _Intended(repaired.findings, table, error > INTENDED_CELL, departures)
