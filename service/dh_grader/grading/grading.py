"""The interface for reading and judging a kind of answer."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any

from dh_grader.catalogue import Exercise
from dh_grader.expressions import Expression, Vocabulary
from dh_grader.expressions.printing import Habits, Spelling, habits_of, spelling_of
from dh_grader.grading.numbers import Samples
from dh_grader.grading.reading.entries import Entry, Reader
from dh_grader.grading.report import Feedback, Finding, Place, RowReport, Verdict
from dh_grader.kinematics import Matrices, inverse

# Each kind is a file in kinds.


# The number of entries that show how a student names symbols.
NAMING_ENTRIES = 4
# The length of a table cell. Longer texts are not memoized, because the memo would keep their
# expressions.
_CELL = 40


@dataclass(frozen=True, slots=True)
class StudentChain:
    """A student's answer as a chain of links, with which later answers can be compared."""

    # (k + 1, SAMPLES, 4, 4), from the base to the tool, in the base frame.
    frames: Matrices
    # Returns the frames at other samples, NaN where a frame is undefined.
    frames_at: Callable[[Samples], Matrices]
    # The link transforms (k, SAMPLES, 4, 4) of the correct table nearest to the answer, or None if
    # the answer consists of matrices.
    nearest_links: Matrices | None = None

    def tool_at(self, samples: Samples) -> Matrices:
        """Return the tool's frame at these samples, ``(samples, 4, 4)``."""
        tool: Matrices = self.frames_at(samples)[-1]
        return tool

    @property
    def links(self) -> Matrices:
        """The k link transforms of the student's answer, ``(k, SAMPLES, 4, 4)``."""
        return inverse(self.frames[:-1]) @ self.frames[1:]


@dataclass(frozen=True, slots=True)
class Grading:
    """The state of grading one submission."""

    exercise: Exercise
    samples: Samples
    reader: Reader
    # True if the report shows corrections, which then must be computed.
    corrects: bool = False
    # True if the report shows how each cell was read.
    echo: bool = False
    # The earlier answer that the part follows from, if there is one.
    student_chain: StudentChain | None = None
    # True if the part is judged by student_chain instead of the reference.
    following: bool = False
    # True if wrong cells are explained, not only judged.
    explains: bool = True

    def affords(self, work: float) -> bool:
        """Charge ``work`` for an explanation; return True if enough of the budget was left."""
        return self.explains and self.reader.budget.affords(work)

    def messages(
        self, findings: tuple[Finding, ...], places: tuple[Place, ...] = ()
    ) -> tuple[Feedback, ...]:
        """Return the findings as messages about ``places`` (rows and cells)."""
        # The feedback level later decides which messages are visible.
        return tuple(finding.message(places, corrects=self.corrects) for finding in findings)

    def spelling(self, entries: Iterable[Entry]) -> Spelling:
        """Return how the student writes symbols and angles in these entries."""
        # Half the cells of a table are a bare 0, which shows no spelling.
        expressions = [entry.expression for entry in entries]
        vocabulary = self.exercise.vocabulary
        habits = [
            _habits(each, vocabulary)
            for each in expressions
            if each is not None and each.source != "0"
        ]
        return spelling_of(habits, vocabulary, degrees=self.reader.angle_unit == "degrees")

    def symbol_names(self, entries: Iterable[Entry]) -> Callable[[str], str]:
        """Return a function that gives the student's name for each symbol."""

        # On its first call, the returned function reads the shortest entries: they show the names
        # with the least work.
        @cache
        def spelling() -> Spelling:
            read = [each for each in entries if each.expression and each.expression.symbols]
            return self.spelling(sorted(read, key=_length)[:NAMING_ENTRIES])

        return lambda symbol: spelling().names.get(symbol, symbol)

    def unwritten(self, entries: Iterable[Entry]) -> frozenset[str]:
        """Return the constants of the exercise that no entry contains."""
        # A hint must not name them, because a missing constant may be the whole answer.
        read = (each.expression.symbols for each in entries if each.expression is not None)
        joints = (joint.variable for joint in self.exercise.joints)
        names = {variable.name for variable in self.exercise.variables}
        return frozenset(names.difference(joints, *read))


def _habits(expression: Expression, vocabulary: Vocabulary) -> Habits:
    if len(expression.source) <= _CELL:
        return _habits_of_cell(expression, vocabulary)
    return habits_of(expression.typed, vocabulary)


# Memoized, because the students of a class write the same cells.
@lru_cache(maxsize=2048)
def _habits_of_cell(expression: Expression, vocabulary: Vocabulary) -> Habits:
    return habits_of(expression.typed, vocabulary)


def _length(entry: Entry) -> int:
    return len(entry.expression.source) if entry.expression else 0


def _no_chain() -> StudentChain | None:
    return None


@dataclass(frozen=True, slots=True)
class Content:
    """The cells of a correct answer that need knowledge and so earn points."""

    # The cells that need knowledge, (rows, cells) like the rows of the report.
    known: tuple[tuple[bool, ...], ...]
    # The number of each cell's group, (rows, cells); a group cannot lose more than it is worth.
    groups: tuple[tuple[int, ...], ...]
    # True if each group is worth something even without these cells.
    besides: bool = False
    # True if all groups are worth the same.
    equal: bool = False
    # The largest number of cells that count, because a student's own choices may add such cells.
    most: int | None = None
    # The rows that are the same in every correct answer: the last rows of homogeneous matrices.
    bottom: tuple[int, ...] = ()
    # The numbers of rows and of these cells of the reference, if an answer may have other numbers.
    usual: tuple[int, int] | None = None
    # True for the rows that the exercise gives, which earn nothing; empty if it gives no rows.
    given: tuple[bool, ...] = ()

    @property
    def earning(self) -> tuple[bool, ...]:
        """True for each row that can earn points."""
        return tuple(not given for given in self.given) or (True,) * len(self.known)

    @property
    def count(self) -> int:
        """The number of cells that need knowledge."""
        return sum(map(sum, self.known))


@dataclass(frozen=True, slots=True)
class Judged:
    """The judgement of an answer: its rows, and the messages on the whole answer."""

    # The rows have no points yet.
    rows: tuple[RowReport, ...]
    # Determines the worth of the cells.
    content: Content
    feedback: tuple[Feedback, ...] = ()
    # The number of slips that no cell shows, such as an extra row.
    slips: int = 0
    # The share of the points that a slip of the whole answer costs, if such a slip explains all
    # wrong cells.
    whole_cost: float | None = None
    # The answer without that slip; cells that are wrong here, too, cost extra.
    beside: "Judged | None" = None
    # True if no joint moves an answer that must move.
    stands_still: bool = False
    # Its points are an upper limit.
    at_most: "Judged | None" = None
    # Its points are a lower limit.
    at_least: "Judged | None" = None
    # True if the answer needs more rows than at_most has: because of the upper limit, the wrong
    # cells of the answer lose at most a unit each.
    needs_all: bool = False
    # An upper limit of the lost units of content.
    lost: float = math.inf
    # The number of cells that the student wrote and that are not lazy, or None if unknown; a wrong
    # answer earns at most a unit for each of these cells.
    written: int | None = None
    # Returns the answer as a chain, or None; called only if another part follows this part.
    chain: Callable[[], StudentChain | None] = _no_chain

    @property
    def is_right(self) -> bool:
        """True if nothing is wrong, unread or missing."""
        return not self.slips and all(row.verdict is Verdict.CORRECT for row in self.rows)

    @property
    def count_wrong(self) -> int:
        """The number of cells that are not right."""
        return sum(cell.verdict is not Verdict.CORRECT for row in self.rows for cell in row.cells)

    @property
    def is_wrong(self) -> bool:
        """True if anything that was read is wrong."""
        cells = (cell.verdict for row in self.rows for cell in row.cells)
        return self.slips > 0 or Verdict.INCORRECT in cells


@dataclass(frozen=True, slots=True)
class AnswerKind:
    """The functions that read and judge a kind of answer."""

    # Pure: the result depends only on part, answer and samples.

    # Takes a part and a JSON value, and returns the form that ``judge`` expects, or None for an
    # empty answer. Raises UnreadableAnswerError if nothing can be read.
    read: Callable[[Any, object, Grading], Any]
    # Takes a part and an answer that ``read`` has returned.
    judge: Callable[[Any, Any, Grading], Judged]
