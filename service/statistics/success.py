"""The fraction of right answers in each part, row and cell."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from service.grading import CellReport, PartReport, RowReport, Verdict

# The longest stored entry, and the most different entries of a cell: enough for a class, and a
# limit against floods.
LONGEST_ENTRY: Final = 120
DIFFERENT_ENTRIES: Final = 300


@dataclass(slots=True)
class Share:
    """The numbers of all answers and of right answers."""

    correct: int = 0
    answered: int = 0

    def add(self, verdict: Verdict, times: int = 1) -> None:
        """Count ``times`` answers with this verdict; missing answers do not count."""
        self.answered += times * (verdict is not Verdict.MISSING)
        self.correct += times * (verdict is Verdict.CORRECT)

    @property
    def value(self) -> float | None:
        """The fraction of right answers, 0..1; None without answers."""
        return self.correct / self.answered if self.answered else None


class FrequentEntry(NamedTuple):
    """A wrong entry of a cell, and how often it occurs."""

    row: str
    cell: str
    text: str
    times: int


@dataclass(slots=True)
class CellSuccess:
    """The answers to a cell, counted from reports."""

    share: Share = field(default_factory=Share)
    # Wrong entries by their text.
    wrong: Counter[str] = field(default_factory=Counter)

    def add(self, cell: CellReport) -> None:
        """Add the cell of one report to the counts."""
        self.share.add(cell.verdict)
        if cell.verdict is Verdict.INCORRECT and cell.read is not None:
            text = shown_entry(cell.read.text)
            if text in self.wrong or len(self.wrong) < DIFFERENT_ENTRIES:
                self.wrong[text] += 1


def shown_entry(text: str) -> str:
    """Return the entry, truncated if it is very long."""
    return text if len(text) <= LONGEST_ENTRY else f"{text[: LONGEST_ENTRY - 1]}…"


@dataclass(slots=True)
class RowSuccess:
    """The answers to a row, counted from reports."""

    share: Share = field(default_factory=Share)
    cells: dict[str, CellSuccess] = field(default_factory=dict)
    # The number of reports with this row.
    seen: int = 0

    def add(self, row: RowReport) -> None:
        """Add the row of one report to the counts."""
        self.seen += 1
        self.share.add(row.verdict)
        for cell in row.cells:
            self.cells.setdefault(cell.label, CellSuccess()).add(cell)


@dataclass(slots=True)
class PartSuccess:
    """The answers to a part, counted from reports."""

    share: Share = field(default_factory=Share)
    # The sum of all points.
    points: float = 0.0
    # The number of reports; ``detailed`` is the number of those with rows.
    seen: int = 0
    detailed: int = 0
    _rows: dict[str, RowSuccess] = field(default_factory=dict)

    def add(self, part: PartReport) -> None:
        """Add the part of one report to the counts."""
        self.seen += 1
        self.share.add(part.verdict)
        self.points += part.points
        self.detailed += bool(part.rows)
        for row in part.rows:
            self._rows.setdefault(row.label, RowSuccess()).add(row)

    @property
    def mean_points(self) -> float | None:
        """The mean points of an answer; None without answers."""
        return self.points / self.share.answered if self.share.answered else None

    @property
    def rows(self) -> Mapping[str, RowSuccess]:
        """Return the rows that are in more than half of the reports with rows."""
        # A few students added the other rows.
        return {label: row for label, row in self._rows.items() if 2 * row.seen > self.detailed}

    def commonest_wrong(self, most: int, at_least: int = 2) -> list[FrequentEntry]:
        """Return the ``most`` commonest wrong entries that occur at least ``at_least`` times."""
        found = [entry for entry in self._wrong() if entry.times >= at_least]
        return sorted(found, key=lambda entry: -entry.times)[:most]

    def _wrong(self) -> Iterator[FrequentEntry]:
        for label, row in self.rows.items():
            for column, cell in row.cells.items():
                for text, count in cell.wrong.items():
                    yield FrequentEntry(label, column, text, count)


def columns(rows: Iterable[RowSuccess]) -> list[str]:
    """Return the distinct labels of the cells in these rows, in order."""
    return list(dict.fromkeys(label for row in rows for label in row.cells))
