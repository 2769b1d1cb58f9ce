"""The number of submissions with each kind of mistake (message code)."""

from array import array
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Final

from service.grading import Feedback, PartReport, Severity, Verdict
from service.grading.report import messages_of

# Messages about lost points or possible slips; notes and hints are not counted.
COUNTED: Final = (Severity.ERROR, Severity.WARNING)
# The most different sentences that are counted for a code.
_SENTENCES: Final = 50


@dataclass(slots=True)
class CountedSlip:
    """The occurrences of a message code in answers of one kind."""

    slip_code: str
    kind: str
    # True if the code is about an unreadable entry, which is not a misconception.
    is_unreadable: bool
    # Each submission once.
    submissions: "array[int]" = field(default_factory=lambda: array("L"))
    # The number of submissions by ids of exercise and part.
    parts: Counter[tuple[str, str]] = field(default_factory=Counter)
    _sentences: Counter[str] = field(default_factory=Counter)

    def add(self, submission: int, part: tuple[str, str], sentence: str) -> None:
        """Count a mistake in a part of a submission."""
        # All parts of a submission come before the next submission.
        if not self.submissions or self.submissions[-1] != submission:
            self.submissions.append(submission)
        self.parts[part] += 1
        if sentence in self._sentences or len(self._sentences) < _SENTENCES:
            self._sentences[sentence] += 1

    @property
    def count(self) -> int:
        """The number of submissions with this mistake."""
        return len(self.submissions)

    @property
    def sentence(self) -> str:
        """The most frequent message with this code."""
        return self._sentences.most_common(1)[0][0]


class SlipCounts:
    """Counts the message codes in reports, separately for each kind of answer.

    A code counts once in each part of a submission.
    """

    def __init__(self) -> None:
        self._found: dict[tuple[str, str, bool], CountedSlip] = {}

    def add(self, submission: int, exercise: str, part: PartReport) -> None:
        """Count the message codes of a part, unless its answer is missing."""
        if part.verdict is Verdict.MISSING:
            return
        for (code, is_unreadable), sentence in _slips(part).items():
            key = (part.kind, code, is_unreadable)
            slip = self._found.setdefault(key, CountedSlip(code, part.kind, is_unreadable))
            slip.add(submission, (exercise, part.part), sentence)

    def counted(self, *, unreadable: bool = False) -> Sequence[CountedSlip]:
        """Return the mistakes in readable or ``unreadable`` entries, the most common first."""
        found = (slip for slip in self._found.values() if slip.is_unreadable is unreadable)
        return sorted(found, key=lambda slip: (-slip.count, slip.slip_code, slip.kind))


def _slips(part: PartReport) -> dict[tuple[str, bool], str]:
    found: dict[tuple[str, bool], str] = {}
    for message, verdict in _counted(part):
        found.setdefault((message.code, verdict is Verdict.UNREADABLE), message.message)
    return found


def _counted(part: PartReport) -> Iterator[tuple[Feedback, Verdict]]:
    for message, _, verdict in messages_of(part):
        if message.severity in COUNTED:
            yield message, verdict
