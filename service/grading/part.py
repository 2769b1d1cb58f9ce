"""An answer kind: how answers of it are read and judged. One file of ``kinds`` holds each."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any, Protocol

from service.catalogue import Exercise
from service.expressions import Expression, Vocabulary
from service.expressions.printing.spelling import Habits, Spelling, habits_of, spelling_of
from service.grading.feedback import Finding
from service.grading.numerics.samples import Samples
from service.grading.reading.entry import Entry, Reader
from service.grading.report import Feedback, Place, RowReport, Verdict
from service.kinematics.transforms import Matrices, inverse

# So many entries show how a student names symbols.
NAMING_ENTRIES = 4
# The characters of a cell of a table. What longer texts show is not remembered: their expressions
# would be kept with it.
_CELL = 40


@dataclass(frozen=True, slots=True)
class StudentChain:
    """An answer as a chain of links, which a later part may follow from.

    ``frames`` ``(k + 1, SAMPLES, 4, 4)`` are its frames in the base frame, from the base on; the
    last is the tool's. ``tool_at`` gives the tool's frame at other samples, NaN where it has none.
    ``nearest_links`` ``(k, SAMPLES, 4, 4)`` are the link transforms of the valid table nearest to
    the answer, None where it is no table.
    """

    frames: Matrices
    tool_at: Callable[[Samples], Matrices]
    nearest_links: Matrices | None = None

    @property
    def links(self) -> Matrices:
        """The link transforms as the student has them, ``(k, SAMPLES, 4, 4)``."""
        return inverse(self.frames[:-1]) @ self.frames[1:]


@dataclass(frozen=True, slots=True)
class Grading:
    """One submission being graded: everything that an answer kind may use.

    ``corrects`` says that corrections are told, so that they need to be worked out, ``explains``
    that what is wrong is explained, and not only judged.
    ``echo`` says that each cell is reported as it was understood. ``student_chain`` is the earlier
    answer that the part follows from, where there is one. With
    ``following`` the part is judged by that answer and not by the reference.
    """

    exercise: Exercise
    samples: Samples
    reader: Reader
    corrects: bool = False
    echo: bool = False
    student_chain: StudentChain | None = None
    following: bool = False
    explains: bool = True

    def affords(self, work: float) -> bool:
        """Whether the budget has so much work left for an explanation; it is taken from it."""
        return self.explains and self.reader.budget.affords(work)

    def messages(
        self, findings: tuple[Finding, ...], places: tuple[Place, ...] = ()
    ) -> tuple[Feedback, ...]:
        """The findings as messages; the feedback level decides later which of them are told.

        ``places`` are those that they are about, where they do not stand with them.
        """
        return tuple(finding.message(places, corrects=self.corrects) for finding in findings)

    def spelling(self, entries: Iterable[Entry]) -> Spelling:
        """The spelling of the entries of a part, in which the student is answered."""
        # Half the cells of a table are a bare 0, which shows nothing.
        expressions = [entry.expression for entry in entries]
        vocabulary = self.exercise.vocabulary
        habits = [
            _habits(each, vocabulary)
            for each in expressions
            if each is not None and each.source != "0"
        ]
        return spelling_of(habits, vocabulary, degrees=self.reader.angle_unit == "degrees")

    def symbol_names(self, entries: Iterable[Entry]) -> Callable[[str], str]:
        """The names of symbols as the entries of a part have them, found when one is asked for.

        The shortest entries show them as well as the longest, for less work.
        """

        @cache
        def spelling() -> Spelling:
            read = [each for each in entries if each.expression and each.expression.symbols]
            return self.spelling(sorted(read, key=_length)[:NAMING_ENTRIES])

        return lambda symbol: spelling().names.get(symbol, symbol)

    def unwritten(self, entries: Iterable[Entry]) -> frozenset[str]:
        """The constants of the exercise that none of the entries contains.

        A hint does not name them: which one is missing may be all that is asked for.
        """
        read = (each.expression.symbols for each in entries if each.expression is not None)
        joints = (joint.variable for joint in self.exercise.joints)
        names = {variable.name for variable in self.exercise.variables}
        return frozenset(names.difference(joints, *read))


def _habits(expression: Expression, vocabulary: Vocabulary) -> Habits:
    if len(expression.source) <= _CELL:
        return _habits_of_cell(expression, vocabulary)
    return habits_of(expression.typed, vocabulary)


# A class writes the same cells again and again, and each is one expression.
@lru_cache(maxsize=2048)
def _habits_of_cell(expression: Expression, vocabulary: Vocabulary) -> Habits:
    return habits_of(expression.typed, vocabulary)


def _length(entry: Entry) -> int:
    return len(entry.expression.source) if entry.expression else 0


def _no_chain() -> StudentChain | None:
    return None


@dataclass(frozen=True, slots=True)
class Content:
    """The cells of a right answer that one has to know something for: marks are earned by them.

    Both lists are ``(rows, cells)``, as the rows of the report. ``known`` says which cells these
    are. ``groups`` numbers the group of each cell: a wrong cell costs no more than its group has.
    With ``besides`` each group is worth a little besides its cells. With ``equal`` all groups are
    worth the same, however many cells they have. ``most`` is the number of cells that
    count, where a student's own choices may have added others. With ``empty_is_wrong`` an empty
    cell costs what a wrong one does, so that nobody gains by leaving a cell empty.
    """

    known: tuple[tuple[bool, ...], ...]
    groups: tuple[tuple[int, ...], ...]
    besides: bool = False
    equal: bool = False
    most: int | None = None
    empty_is_wrong: bool = False

    @property
    def count(self) -> int:
        """The number of these cells."""
        return sum(map(sum, self.known))


@dataclass(frozen=True, slots=True)
class Judged:
    """An answer that was judged: its rows, and the messages on the part as a whole.

    The rows have no points yet: ``content`` says what their cells are worth. ``slips`` counts those
    that no cell shows, such as a row too many. ``whole_cost`` is the share of the points that a
    slip of the whole answer costs, where one explains all its wrong cells; or all but those that
    are wrong in ``beside``, the same answer without that slip. ``stands_still`` says
    that no joint moves an answer that must move. ``at_most`` is the same answer judged
    without what must not help: it earns no more than that. ``lost`` are the units of content that
    are lost at most, whatever cells are blamed. ``chain`` gives the answer as a chain,
    if it is one; it is asked only where another part follows this one.
    """

    rows: tuple[RowReport, ...]
    content: Content
    feedback: tuple[Feedback, ...] = ()
    slips: int = 0
    whole_cost: float | None = None
    beside: "Judged | None" = None
    stands_still: bool = False
    at_most: "Judged | None" = None
    lost: float = math.inf
    chain: Callable[[], StudentChain | None] = _no_chain

    @property
    def is_right(self) -> bool:
        """Whether nothing is wrong, unread or missing."""
        return not self.slips and all(row.verdict is Verdict.CORRECT for row in self.rows)

    @property
    def is_wrong(self) -> bool:
        """Whether anything that was read is wrong."""
        cells = (cell.verdict for row in self.rows for cell in row.cells)
        return self.slips > 0 or Verdict.INCORRECT in cells


class AnswerKind(Protocol):
    """The reading and the judging of answers of one kind.

    Pure: the same part, answer and samples, the same result.
    """

    def read(self, part: Any, answer: object, grading: Grading) -> Any:
        """The answer as ``judge`` takes it, from whatever JSON value was handed in, never None.

        None where nothing is written. Raises UnreadableAnswerError where nothing can be read.
        """
        ...

    def judge(self, part: Any, answer: Any, grading: Grading) -> Judged:
        """The judgement on an answer that was read."""
        ...
