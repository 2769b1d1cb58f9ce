"""Generate slips in an arm's table, each with the codes of its messages."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

from tests.pose_slips.unseen.algebra import STANDARD, Cell, Row, Table
from tests.pose_slips.unseen.arms import NONE, Arm

A, ALPHA, D, THETA = range(4)
# The classes of slips; the first are of one cell or of two lengths.
CELL = "one cell"
SWAPPED_ROW, SWAPPED_ALL = "a and d in a row", "a and d in all rows"
OTHER_FORMULA, OTHER_TABLE = "the other formula", "the other table"
NEGATED, ROWS, PRODUCT = "one column negated", "two rows exchanged", "another product"
CLASSES = (CELL, SWAPPED_ROW, SWAPPED_ALL, OTHER_FORMULA, OTHER_TABLE, NEGATED, ROWS, PRODUCT)


@dataclass(frozen=True)
class ArmSlip:
    """A slip: the wrong table, and the codes of the messages that name it."""

    # `order` is the order in which the links are multiplied. The message must contain `words`.
    kind: str
    codes: frozenset[str]
    table: Table
    convention: str
    order: tuple[int, ...]
    words: tuple[str, ...] = ()


def slips_of(arm: Arm) -> Iterator[ArmSlip]:
    table, convention = arm.table, arm.convention
    order = tuple(range(len(table)))

    def slip(kind: str, codes: str, rows: Sequence[Row], *words: str, by: str = "") -> ArmSlip:
        whole = tuple(range(len(rows)))
        used = by or convention
        return ArmSlip(kind, frozenset(codes.split()), tuple(rows), used, whole, words)

    for i, row in enumerate(table):
        for codes, changed in _cells(arm, i, row):
            yield slip(CELL, codes, [*table[:i], changed, *table[i + 1 :]])
    lengths = sorted(name for name in arm.symbols if not name.startswith("q"))
    for one, other in combinations(lengths, 2):
        exchanged = {one: other, other: one}
        yield slip(CELL, "lengths_exchanged", [_with_names(row, exchanged) for row in table])
    swapped = [_swapped(row, arm, i) for i, row in enumerate(table)]
    for i in order:
        rows = [*table[:i], swapped[i], *table[i + 1 :]]
        yield slip(SWAPPED_ROW, "columns_swapped", rows, f"row {arm.labels[i]}")
    yield slip(SWAPPED_ALL, "columns_swapped", swapped)
    other = "modified" if convention == STANDARD else STANDARD
    yield slip(OTHER_FORMULA, "other_convention", table, by=other)
    for rows in _other_tables(arm):
        yield slip(OTHER_TABLE, "other_convention", rows)
    for column in range(4):
        yield slip(NEGATED, "parameter_sign", [_negated(row, column, True) for row in table])
        yield slip(NEGATED, "parameter_sign", [_negated(row, column, False) for row in table])
    for i, j in combinations(order, 2):
        rows = list(table)
        rows[i], rows[j] = rows[j], rows[i]
        words = (arm.labels[i], arm.labels[j])
        yield slip(ROWS, "row_order", rows, *words)
        if max(i, j) < len(arm.structure) and arm.structure[i] == arm.structure[j]:
            one, two = f"q{i + 1}", f"q{j + 1}"
            rows[i], rows[j] = _renamed(rows[i], two, one), _renamed(rows[j], one, two)
            yield slip(ROWS, "row_order", rows, *words)
    yield from _products(arm)


def _products(arm: Arm) -> Iterator[ArmSlip]:
    order = tuple(range(len(arm.table)))

    def product(codes: str, links: Sequence[int]) -> ArmSlip:
        chosen = frozenset(codes.split())
        return ArmSlip(PRODUCT, chosen, arm.table, arm.convention, tuple(links))

    yield product("reversed_product", order[::-1])
    for k in order[1:]:
        yield product("wrong_frame", order[:k])
        yield product("wrong_base", order[k:])
        yield product("premultiplied", [k, *order[:k], *order[k + 1 :]])
        yield product("missing_link", [i for i in order if i != k])


def _cells(arm: Arm, i: int, row: Row) -> Iterator[tuple[str, Row]]:
    moving = f"q{i + 1}" if i < len(arm.structure) else "none"
    for column in (A, D):
        if moving not in row[column]:
            yield "sign", _with_cell(row, column, _minus(row[column]))
            yield "distance_left_out", _with_cell(row, column, NONE)
    for column in (ALPHA, THETA):
        cell = row[column]
        for turn in (1, -1, 2):
            turned = {**cell, "": cell.get("", 0) + turn}
            codes = "half_turn" if turn == 2 else "quarter_turn"
            if cell.get("", 0) % 2 and turned[""] % 2:
                codes += " sign"
            yield codes, _with_cell(row, column, turned)
    for column in (D, THETA):
        if moving in row[column]:
            for codes, cell in _variables(arm, i, row[column]):
                yield codes, _with_cell(row, column, cell)


def _variables(arm: Arm, i: int, cell: Cell) -> Iterator[tuple[str, Cell]]:
    moving = f"q{i + 1}"
    yield "joint_variable_sign", {**cell, moving: -1.0}
    yield "joint_variable_sign", _minus(cell)
    yield "joint_variable_missing home_position", {**cell, moving: 0.0}
    yield "joint_variable_missing home_position", NONE
    for j, letter in enumerate(arm.structure):
        if letter == arm.structure[i] and j != i:
            yield (
                "joint_variable_index",
                {f"q{j + 1}" if name == moving else name: factor for name, factor in cell.items()},
            )


def _with_cell(row: Row, column: int, cell: Cell) -> Row:
    cells = [*row[:column], cell, *row[column + 1 :]]
    return cells[0], cells[1], cells[2], cells[3]


def _minus(cell: Cell) -> Cell:
    return {name: -factor for name, factor in cell.items()}


def _swapped(row: Row, arm: Arm, i: int) -> Row:
    moving = f"q{i + 1}"
    a, alpha, d, theta = row
    stays = {moving: d[moving]} if moving in d else {}
    rest = {name: factor for name, factor in d.items() if name != moving}
    return rest, alpha, {**a, **stays}, theta


def _negated(row: Row, column: int, with_variable: bool) -> Row:
    cell = row[column]
    changed = {
        name: factor if name.startswith("q") and not with_variable else -factor
        for name, factor in cell.items()
    }
    return _with_cell(row, column, changed)


def _renamed(row: Row, old: str, new: str) -> Row:
    return _with_names(row, {old: new})


def _with_names(row: Row, names: Mapping[str, str]) -> Row:
    cells = [{names.get(name, name): factor for name, factor in cell.items()} for cell in row]
    return cells[0], cells[1], cells[2], cells[3]


def _other_tables(arm: Arm) -> Iterator[list[Row]]:
    rows, none = arm.table, (NONE, NONE)
    links = [(row[A], row[ALPHA]) for row in rows]
    is_standard = arm.convention == STANDARD
    shifted = [none, *links[:-1]] if is_standard else [*links[1:], none]
    moved: list[Row] = [
        (a, alpha, row[D], row[THETA]) for (a, alpha), row in zip(shifted, rows, strict=True)
    ]
    if not any(moved[-1]):
        moved.pop()
    yield moved
    if is_standard and any(links[-1]):
        yield [*moved, (*links[-1], NONE, NONE)]
