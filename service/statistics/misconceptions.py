"""Slips by their codes: how many submissions have each, and which."""

from array import array
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Final

from service.grading import Feedback, PartReport, Severity, Verdict
from service.grading.report import messages_of

# What costs points or may have been a slip; notes and hints are not counted.
COUNTED: Final = (Severity.ERROR, Severity.WARNING)
# So many different sentences of a code are told apart.
_SENTENCES: Final = 50


@dataclass(slots=True)
class CountedSlip:
    """A code in answers of one kind.

    ``is_unreadable`` says that something could not be read, which is no misconception.
    ``submissions`` has each submission once, ``parts`` how many have it in each part, by the ids of
    exercise and part.
    """

    slip_code: str
    kind: str
    is_unreadable: bool
    submissions: "array[int]" = field(default_factory=lambda: array("L"))
    parts: Counter[tuple[str, str]] = field(default_factory=Counter)
    _sentences: Counter[str] = field(default_factory=Counter)

    def add(self, submission: int, part: tuple[str, str], sentence: str) -> None:
        """Count the slip in a part of a submission; submissions come one by one."""
        if not self.submissions or self.submissions[-1] != submission:
            self.submissions.append(submission)
        self.parts[part] += 1
        if sentence in self._sentences or len(self._sentences) < _SENTENCES:
            self._sentences[sentence] += 1

    @property
    def count(self) -> int:
        """The number of submissions that have it."""
        return len(self.submissions)

    @property
    def sentence(self) -> str:
        """The message that most were told; the first of those that are equally many."""
        return self._sentences.most_common(1)[0][0]


class SlipCounts:
    """The codes of reports, added part by part: each counts once for a part of a submission.

    The same code is another slip in an answer of another kind.
    """

    def __init__(self) -> None:
        self._found: dict[tuple[str, str, bool], CountedSlip] = {}

    def add(self, submission: int, exercise: str, part: PartReport) -> None:
        """Count the slips of a part; one that is missing has none."""
        if part.verdict is Verdict.MISSING:
            return
        for (code, is_unreadable), sentence in _slips(part).items():
            key = (part.kind, code, is_unreadable)
            slip = self._found.setdefault(key, CountedSlip(code, part.kind, is_unreadable))
            slip.add(submission, (exercise, part.part), sentence)

    def counted(self, *, unreadable: bool = False) -> Sequence[CountedSlip]:
        """The slips of what was read, or of what was ``unreadable``; the commonest first."""
        found = (slip for slip in self._found.values() if slip.is_unreadable is unreadable)
        return sorted(found, key=lambda slip: (-slip.count, slip.slip_code, slip.kind))


def _slips(part: PartReport) -> dict[tuple[str, bool], str]:
    """Each code of the part, and whether nothing could be read there, with its first sentence."""
    found: dict[tuple[str, bool], str] = {}
    for message, verdict in _counted(part):
        found.setdefault((message.code, verdict is Verdict.UNREADABLE), message.message)
    return found


def _counted(part: PartReport) -> Iterator[tuple[Feedback, Verdict]]:
    for message, _, verdict in messages_of(part):
        if message.severity in COUNTED:
            yield message, verdict
