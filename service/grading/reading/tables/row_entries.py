"""Read the four cells of a DH row as entries."""

from collections.abc import Sequence
from functools import lru_cache
from typing import Final, NamedTuple

from service.expressions import AngleUnit, Vocabulary
from service.grading.feedback import Finding
from service.grading.numerics.samples import Samples
from service.grading.reading.entry import Entry, Reader, unreadable
from service.grading.reading.tables.cell_names import arranged_row, row_entries
from service.grading.reading.tables.column_headers import QUANTITIES
from service.grading.work_budget import MAX_SYMBOLS, WorkBudget
from service.kinematics.chain import COLUMNS

# Longer rows are not memoized: hardly any two students write the same one.
_LONGEST: Final = 60
_MEMOIZED: Final = 4096
_NO_SAMPLES: Final = Samples({})


def read_row(cells: Sequence[object], number: int | None, reader: Reader) -> tuple[Entry, ...]:
    """Read the cells of row ``number``, which is None if unknown.

    A cell is a JSON value, or the finding why it is unreadable.
    """
    found = arranged_row(cells, reader.vocabulary)
    ordered = [cells[i] for i in found.order] if found else cells

    def read(column: int) -> Entry:
        raw = ordered[column]
        if isinstance(raw, Finding):
            return unreadable(raw)
        return reader.read(raw, QUANTITIES[COLUMNS[column]], in_table=True)

    return row_entries(ordered, found, number, read, lambda _, entry: entry, reader.vocabulary)


def memoized_row(
    cells: Sequence[object], number: int | None, reader: Reader
) -> tuple[Entry, ...] | None:
    """Return the memoized entries of a row of short, readable texts; None for any other row.

    Most students of a class write the same rows, and a lookup takes a tenth of reading one.
    """
    a, alpha, d, theta = cells
    if not (type(a) is type(alpha) is type(d) is type(theta) is str):
        return None
    if len(a) + len(alpha) + len(d) + len(theta) > _LONGEST:
        return None
    found = _read_row(a, alpha, d, theta, number, reader.vocabulary, reader.angle_unit)
    if found is None or found.symbols > reader.budget.symbols:
        return None
    reader.budget.symbols -= found.symbols
    return found.entries


class _ReadRow(NamedTuple):
    """The entries of a row, and the number of symbols that were read."""

    entries: tuple[Entry, ...]
    symbols: int


@lru_cache(maxsize=_MEMOIZED)
def _read_row(
    a: str,
    alpha: str,
    d: str,
    theta: str,
    number: int | None,
    vocabulary: Vocabulary,
    angle_unit: AngleUnit,
) -> _ReadRow | None:
    budget = WorkBudget(repairs=0)
    reader = Reader(vocabulary, _NO_SAMPLES, angle_unit, None, budget)
    entries = read_row((a, alpha, d, theta), number, reader)
    # Rows that need repairs are not memoized: each submission must pay for its own repairs.
    is_plain = budget.repairs == 0 and all(entry.readable for entry in entries)
    return _ReadRow(entries, MAX_SYMBOLS - budget.symbols) if is_plain else None
