"""Success: how many of those who answered were right, for each part, row and cell."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from service.grading import CellReport, PartReport, RowReport, Verdict

# Longer entries are cut, and of each cell so many different ones are told apart: what a class
# writes is counted, and what floods it is not kept.
LONGEST_ENTRY: Final = 120
DIFFERENT_ENTRIES: Final = 300


@dataclass(slots=True)
class Share:
    """How many were right, of those who answered. What could not be read was answered."""

    correct: int = 0
    answered: int = 0

    def add(self, verdict: Verdict, times: int = 1) -> None:
        """Count an answer, or as many with the same verdict; a missing one is none."""
        self.answered += times * (verdict is not Verdict.MISSING)
        self.correct += times * (verdict is Verdict.CORRECT)

    @property
    def value(self) -> float | None:
        """The share, 0..1; None where nobody answered."""
        return self.correct / self.answered if self.answered else None


class FrequentEntry(NamedTuple):
    """A wrong entry of a cell as it was read, and how many wrote it."""

    row: str
    cell: str
    text: str
    times: int


@dataclass(slots=True)
class CellSuccess:
    """A cell in all reports; ``wrong`` counts the wrong entries by their texts as read."""

    share: Share = field(default_factory=Share)
    wrong: Counter[str] = field(default_factory=Counter)

    def add(self, cell: CellReport) -> None:
        """Count the cell of a report."""
        self.share.add(cell.verdict)
        if cell.verdict is Verdict.INCORRECT and cell.read is not None:
            text = shown_entry(cell.read.text)
            if text in self.wrong or len(self.wrong) < DIFFERENT_ENTRIES:
                self.wrong[text] += 1


def shown_entry(text: str) -> str:
    """The entry as it is shown: cut where it is very long."""
    return text if len(text) <= LONGEST_ENTRY else f"{text[: LONGEST_ENTRY - 1]}…"


@dataclass(slots=True)
class RowSuccess:
    """A row in all reports; ``seen`` counts the reports that have it."""

    share: Share = field(default_factory=Share)
    cells: dict[str, CellSuccess] = field(default_factory=dict)
    seen: int = 0

    def add(self, row: RowReport) -> None:
        """Count the row of a report."""
        self.seen += 1
        self.share.add(row.verdict)
        for cell in row.cells:
            self.cells.setdefault(cell.label, CellSuccess()).add(cell)


@dataclass(slots=True)
class PartSuccess:
    """A part in all reports: ``seen`` of them, of which ``detailed`` tell of rows.

    ``points`` are summed over those who answered.
    """

    share: Share = field(default_factory=Share)
    points: float = 0.0
    seen: int = 0
    detailed: int = 0
    _rows: dict[str, RowSuccess] = field(default_factory=dict)

    def add(self, part: PartReport) -> None:
        """Count the part of a report."""
        self.seen += 1
        self.share.add(part.verdict)
        self.points += part.points
        self.detailed += bool(part.rows)
        for row in part.rows:
            self._rows.setdefault(row.label, RowSuccess()).add(row)

    @property
    def mean_points(self) -> float | None:
        """The mean points of those who answered; None where nobody did."""
        return self.points / self.share.answered if self.share.answered else None

    @property
    def rows(self) -> Mapping[str, RowSuccess]:
        """The rows that most reports have: a row too many is no row of the answer."""
        return {label: row for label, row in self._rows.items() if 2 * row.seen > self.detailed}

    def commonest_wrong(self, most: int, at_least: int = 2) -> list[FrequentEntry]:
        """The wrong entries that ``at_least`` so many have, the commonest first."""
        found = [entry for entry in self._wrong() if entry.times >= at_least]
        return sorted(found, key=lambda entry: -entry.times)[:most]

    def _wrong(self) -> Iterator[FrequentEntry]:
        for label, row in self.rows.items():
            for column, cell in row.cells.items():
                for text, count in cell.wrong.items():
                    yield FrequentEntry(label, column, text, count)


def columns(rows: Iterable[RowSuccess]) -> list[str]:
    """The labels of all cells of the rows, in order."""
    return list(dict.fromkeys(label for row in rows for label in row.cells))
