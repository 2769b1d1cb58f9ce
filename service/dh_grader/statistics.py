"""The statistics of a class, counted from its reports one by one, without the answers."""

from array import array
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import blake2b
from statistics import fmean, median
from typing import Final, NamedTuple

from dh_grader.grading import (
    CellReport,
    Feedback,
    FeedbackLevel,
    PartReport,
    Report,
    RowReport,
    Severity,
    Verdict,
)
from dh_grader.grading.report import messages_of

# --- The statistics of a class, counted from its reports


__all__ = [
    "CellSuccess",
    "ClassStatistics",
    "CountedSlip",
    "FrequentEntry",
    "IdenticalMistakes",
    "MistakeGroup",
    "PartSuccess",
    "RowSuccess",
    "ScoreBin",
    "ScoreDistribution",
    "Share",
    "SlipCounts",
]


# --- The distribution of scores


BINS: Final = 10
# A score on the edge of two bins belongs to the upper one, although it is rounded to six digits.
_EDGE: Final = 1e-6


@dataclass(frozen=True, slots=True)
class ScoreBin:
    """The submissions with a score from ``low`` to below ``high``; the last bin includes 1."""

    low: float
    high: float
    count: int
    # The number of these submissions that reach the pass mark.
    passed: int


class ScoreDistribution:
    """Counts scores from 0 to 1."""

    def __init__(self) -> None:
        self._scores = array("d")
        self._counts = [0] * BINS
        self._passed = [0] * BINS

    def add(self, score: float, *, passed: bool) -> None:
        """Count a submission with this score."""
        self._scores.append(score)
        place = min(int((score + _EDGE) * BINS), BINS - 1)
        self._counts[place] += 1
        self._passed[place] += passed

    @property
    def count(self) -> int:
        """The number of scores."""
        return len(self._scores)

    @property
    def passed(self) -> int:
        """The number of submissions that reach the pass mark."""
        return sum(self._passed)

    @property
    def mean(self) -> float:
        """The mean score. Raises StatisticsError without scores."""
        return fmean(self._scores)

    @property
    def median(self) -> float:
        """The median score. Raises StatisticsError without scores."""
        return median(self._scores)

    @property
    def bins(self) -> list[ScoreBin]:
        """Return ten bins of equal width, from 0 to 1."""
        counted = enumerate(zip(self._counts, self._passed, strict=True))
        return [ScoreBin(i / BINS, (i + 1) / BINS, *counts) for i, counts in counted]


# --- The number of submissions with each kind of mistake (message code)


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


# --- The fraction of right answers in each part, row and cell


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


# --- All statistics of a class


_NO_MESSAGES: Final = (FeedbackLevel.VERDICTS, FeedbackLevel.SCORE)


class ClassStatistics:
    """Counts the reports of a class, one by one.

    The caller adds the score of each submission to ``scores``.
    """

    def __init__(self) -> None:
        self.scores = ScoreDistribution()
        self.slips = SlipCounts()
        self.identical = IdenticalMistakes()
        self.untold = 0
        self._parts: dict[tuple[str, str], PartSuccess] = {}

    def add(self, submission: int, report: Report) -> None:
        """Count a report; ``submission`` is the number of its submission."""
        # These reports hide mistakes.
        self.untold += report.feedback in _NO_MESSAGES
        for part in report.parts:
            self._parts.setdefault((report.exercise, part.part), PartSuccess()).add(part)
            self.slips.add(submission, report.exercise, part)
            self.identical.add(submission, report.exercise, part)

    @property
    def parts(self) -> Mapping[tuple[str, str], PartSuccess]:
        """The success in each part, by the ids of exercise and part."""
        return self._parts


# --- Groups of submissions with identical mistakes: the same wrong entries in the same cells
#
# Identical mistakes do not prove that anybody copied: a common mistake leads many students to the
# same entries.


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
