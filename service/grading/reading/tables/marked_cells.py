"""Read which cells of a table a student marks: ``2.alpha``, or row ``2``, or several."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from service.grading.feedback import Finding, reading_error
from service.grading.report import Verdict
from service.kinematics.chain import COLUMNS
from service.kinematics.factors import CellIndex
from service.regex import regex
from service.translations import say

_NAMES: Final = {
    **{name: column for column, name in enumerate(COLUMNS)},
    "α": 1,
    "θ": 3,
}
# A row's label, a column's name, or both: "2.alpha", "row 2, alpha" is two marks.
_MARK: Final = regex(r"(?:row\s*)?([0-9]{1,3}|e2?)(?:\s*[./:\s]\s*([a-zα-ω]+))?")
_SEPARATORS: Final = regex(r"[,;\n]")
MAX_MARKS: Final = 64
MAX_CHARACTERS: Final = 1000


@dataclass(frozen=True, slots=True)
class MarkedCells:
    """The marked cells by row and column; ``findings`` say why a mark could not be read."""

    cells: frozenset[CellIndex] = frozenset()
    findings: tuple[Finding, ...] = ()

    @property
    def verdict(self) -> Verdict | None:
        """The verdict MISSING or UNREADABLE, or None if there are readable marks."""
        if self.findings:
            return Verdict.UNREADABLE
        return None if self.cells else Verdict.MISSING


def read_marks(answer: object, labels: Sequence[str]) -> MarkedCells:
    """Read marks in a table whose rows have these labels."""
    # One unreadable mark makes all of them unreadable, because the student may have meant any cell.
    marks = _split(answer)
    if marks is None:
        return MarkedCells(findings=(_NOT_MARKS,))
    cells: set[CellIndex] = set()
    for mark in marks:
        found = _cells_of(mark, labels)
        if found is None:
            return MarkedCells(findings=(_unknown(labels),))
        cells |= found
    return MarkedCells(frozenset(cells))


def _split(answer: object) -> list[str] | None:
    if answer is None:
        return []
    if isinstance(answer, int) and not isinstance(answer, bool):
        return [str(answer)] if 0 <= answer <= 999 else None
    if isinstance(answer, str):
        if len(answer) > MAX_CHARACTERS:
            return None
        marks = [mark.strip().lower() for mark in _SEPARATORS.split(answer)]
        return [mark for mark in marks if mark][: MAX_MARKS + 1]
    if not isinstance(answer, list) or len(answer) > MAX_MARKS:
        return None
    split = [None if isinstance(each, list) else _split(each) for each in answer]
    if None in split:
        return None
    return [mark for marks in split for mark in marks or ()]


def _cells_of(mark: str, labels: Sequence[str]) -> set[CellIndex] | None:
    found = _MARK.fullmatch(mark)
    if found is None or found[1] not in labels:
        return None
    row = labels.index(found[1])
    if found[2] is None:
        return {(row, column) for column in range(len(COLUMNS))}
    return {(row, _NAMES[found[2]])} if found[2] in _NAMES else None


def _unknown(labels: Sequence[str]) -> Finding:
    return reading_error(
        "unknown_place",
        say(
            "Write each place as its row and column: {row}.alpha. The rows are {rows}, the columns "
            "a, alpha, d, theta.",
            row=labels[-1],
            rows=", ".join(labels),
        ),
    )


_NOT_MARKS: Final = reading_error(
    "wrong_shape", say('Write the places that are wrong: "2.alpha", or several of them in a list.')
)
