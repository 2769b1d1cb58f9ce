"""Slips in whole rows or columns of the robot's table."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import combinations

import numpy as np

from dh_grader.catalogue import Joint
from dh_grader.expressions.evaluate import SymbolValues
from dh_grader.grading.misconception import (
    SYMBOLS,
    Record,
    change_every_sign,
    register,
    wrong_throughout,
)
from dh_grader.grading.numbers import CONSTANT
from dh_grader.grading.reading.table import IS_ANGLE
from dh_grader.kinematics import ALPHA, COLUMNS, THETA, A, Convention, D, Numbers, Table
from dh_grader.translations import Sentence, say

# A slip: a mistake in the robot's table, joints or lengths, which leads to a wrong answer.


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
        yield Slip(COLUMNS_SWAPPED, words, cells=_exchanged(row, moving=moving))


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

    cells = tuple(cell for i in range(len(rows.constants)) for cell in _exchanged(i))
    yield Slip(COLUMNS_SWAPPED, words, cells=cells)


def _exchanged(row: int, *, moving: bool = False) -> tuple[CellChange, ...]:
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


# The kinds of slips in the robot's table, joints or lengths, likeliest first.


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
