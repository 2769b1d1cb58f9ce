"""Slips in whole rows or columns of the robot's table."""

# They change numbers of the table, but no symbols.

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import combinations

import numpy as np

from service.catalogue import Joint
from service.grading.diagnosis.upstream.slip import CellChange, Names, Slip, SlipWords
from service.grading.diagnosis.upstream.slip_kinds import (
    COLUMNS_SWAPPED,
    MISSING_LINK,
    OTHER_CONVENTION,
    PARAMETER_SIGN,
    ROW_ORDER,
)
from service.grading.diagnosis.wording import (
    SYMBOLS,
    change_every_sign,
    wrong_throughout,
)
from service.grading.numerics.tolerances import CONSTANT
from service.grading.reading.tables.table import IS_ANGLE
from service.kinematics.chain import ALPHA, COLUMNS, THETA, A, D
from service.kinematics.dh import Convention
from service.kinematics.transforms import Numbers
from service.translations import say


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
