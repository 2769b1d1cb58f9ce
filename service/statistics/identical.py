"""Groups of submissions with identical mistakes: the same wrong entries in the same cells.

Identical mistakes do not prove that anybody copied: a common mistake leads many students to the
same entries.
"""

from array import array
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from hashlib import blake2b

from service.grading import PartReport, Verdict
from service.statistics.success import shown_entry

# Row, cell, and the entry in the reader's notation.
Mistake = tuple[str, str, str]


@dataclass(slots=True)
class MistakeGroup:
    """Submissions with identical mistakes in a part; ``mistakes`` are its wrong cells."""

    exercise: str
    part: str
    mistakes: Sequence[Mistake]
    submissions: "array[int]" = field(default_factory=lambda: array("L"))


class IdenticalMistakes:
    """Finds submissions with identical mistakes in reports, which are added part by part."""

    def __init__(self) -> None:
        self._alone: dict[bytes, int] = {}
        self._groups: dict[bytes, MistakeGroup] = {}

    def add(self, submission: int, exercise: str, part: PartReport) -> None:
        """Add the wrong entries of a part; ignore unreadable cells."""
        mistakes = [
            (row.label, cell.label, cell.read.text)
            for row in part.rows
            for cell in row.cells
            if cell.verdict is Verdict.INCORRECT and cell.read is not None
        ]
        if not mistakes:
            return
        mark = _fingerprint(exercise, part.part, mistakes)
        if mark in self._groups:
            self._groups[mark].submissions.append(submission)
        elif mark in self._alone:
            shown = tuple((row, cell, shown_entry(text)) for row, cell, text in mistakes)
            pair = array("L", [self._alone.pop(mark), submission])
            self._groups[mark] = MistakeGroup(exercise, part.part, shown, pair)
        else:
            self._alone[mark] = submission

    @property
    def groups(self) -> Sequence[MistakeGroup]:
        """Return the groups of two or more submissions, the largest groups first."""
        return sorted(
            self._groups.values(), key=lambda group: (-len(group.submissions), -len(group.mistakes))
        )


def _fingerprint(exercise: str, part: str, mistakes: Iterable[Mistake]) -> bytes:
    text = repr((exercise, part, list(mistakes)))
    return blake2b(text.encode("utf-8", "surrogatepass"), digest_size=16).digest()
