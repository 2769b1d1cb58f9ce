"""The work that the reading of one submission may set going, counted and never timed.

Counted work is the same on every machine, so that the same submission gives the same report.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Self

from service.expressions.reading_work import reading_cost
from service.grids.cutting.limits import GRID_LIMITS
from service.time_slices import checkpoint

# The pose of a seven-joint arm, multiplied out, not simplified and printed as LaTeX or JavaScript,
# has up to 13,900, each symbol counted by what it costs.
MAX_SYMBOLS = 14_000
# A table is read a second time with its columns in another order; an ordinary one has 300.
MAX_SYMBOLS_AGAIN = 2_400
# To look for the repaired text of an unreadable one costs more than any other reading.
MAX_REPAIRS = 24
# A repair that reads so many symbols counts as another one.
SYMBOLS_PER_REPAIR = 100

# Pasted texts are cut into cells, whose characters are counted once more when they are read. The
# longest text leaves half as much for the other parts.
MAX_PASTED = 36_000

# In units of the least work that a grading can be: six links multiplied out at all samples.
MAX_EXPLANATIONS = 145.0
# Enough to judge a table with unread cells in either convention, and to look for their values.
MAX_SEARCHES = 280.0
# All of it together. What was read and searched leaves so much less for explanations.
MAX_WORK = 285.0
# The work of reading a symbol, of cutting a character out of a pasted text, of a repair.
SYMBOL_WORK, PASTED_WORK, REPAIR_WORK = 1 / 100, 1 / 800, 1.5

# The pose of a seven-joint arm has 57,000 as MathML. Nobody looks at longer formulas.
MAX_PRINTED = 60_000

# What a request for a drawing may cost, all of it in symbols that are read: the table itself, its
# figure, and the formulas printed for it. Those of a seven-joint arm cost 13,700.
MAX_SYMBOLS_DRAWN = 16_000
SYMBOLS_PER_FIGURE = 2_200
SYMBOLS_PER_PRINTED_NODE = 2.5


@dataclass(slots=True)
class WorkBudget:
    """The work left for a submission: one object for all its parts, pasted texts and units.

    ``symbols`` counts the names, numbers and signs that may still be read, ``repairs`` the
    unreadable texts for which a repaired one may still be looked for. ``pasted`` counts the
    characters of texts that may still be cut into cells. ``explanations`` is the work that may
    still be spent on what is wrong and why: no verdict depends on it. ``searches`` is that for what
    a table may have been meant to be: with what was not read, in another order of its columns.
    ``printed`` counts the characters of formulas that may still be drawn for a preview.
    ``answers`` is the whole submission: what later parts have to read is kept back for them.
    ``has_left_out`` says that an explanation was not afforded. ``unreadable`` are the texts that
    could not be read.
    """

    symbols: int = MAX_SYMBOLS
    repairs: int = MAX_REPAIRS
    pasted: int = MAX_PASTED
    explanations: float = MAX_EXPLANATIONS
    searches: float = MAX_SEARCHES
    printed: int = MAX_PRINTED
    has_left_out: bool = False
    unreadable: set[object] = field(default_factory=set)
    answers: object = None
    _expected: int = -1

    @classmethod
    def of_drawing(cls, *, with_figure: bool) -> Self:
        """The budget of a request for the frames, the formulas and the figure of a table."""
        return cls(MAX_SYMBOLS_DRAWN - (SYMBOLS_PER_FIGURE if with_figure else 0))

    @property
    def left(self) -> float:
        """How much of all work the reading, also that to come, and the searches have left."""
        if self._expected < 0:
            self._expected = _symbols_of(self.answers)
        read = (
            SYMBOL_WORK * max(MAX_SYMBOLS - max(self.symbols, 0), self._expected)
            + PASTED_WORK * (MAX_PASTED - max(self.pasted, 0))
            + REPAIR_WORK * (MAX_REPAIRS - max(self.repairs, 0))
        )
        return MAX_WORK - read - (MAX_SEARCHES - self.searches)

    def affords(self, work: float) -> bool:
        """Whether there is so much left for explanations. It is taken, and what is gone is gone."""
        checkpoint()
        self.explanations -= work
        left = min(self.explanations, self.left - (MAX_EXPLANATIONS - self.explanations))
        self.has_left_out |= left < 0
        return left >= 0

    def affords_search(self, work: float) -> bool:
        """Whether there is so much left for searches; if so, it is taken.

        It does not depend on what was explained.
        """
        is_afforded = work <= min(self.searches, self.left)
        if is_afforded:
            self.charge_search(work)
        return is_afforded

    def charge_search(self, work: float) -> None:
        """Count a search that has to be made, whatever it costs."""
        checkpoint()
        self.searches -= work

    def charge_reading(self, symbols: int) -> bool:
        """Count a text that is to be read; whether it may be."""
        self.symbols -= symbols
        return self.symbols >= 0

    def charge_printing(self, nodes: int) -> bool:
        """Count a formula of so many nodes that is to be printed; whether it may be."""
        return self.charge_reading(math.ceil(SYMBOLS_PER_PRINTED_NODE * nodes))

    def charge_repair(self, text: object, tried: int) -> None:
        """Count an unreadable text, once, for which texts of so many symbols were tried."""
        if text not in self.unreadable:
            self.unreadable.add(text)
            self.repairs -= 1 + tried // SYMBOLS_PER_REPAIR


def _symbols_of(answer: object) -> int:
    """The names, numbers and signs in all texts of a JSON value, up to the most that is read."""
    found, waiting = 0, [answer]
    # Without recursion: lists may stand in each other deeper than Python calls.
    while waiting and found < MAX_SYMBOLS:
        match waiting.pop():
            # A longer text is read neither as a formula nor as a grid.
            case str() as text if len(text) <= GRID_LIMITS.characters:
                found += reading_cost(text)
            case Mapping() as fields:
                waiting.extend(fields.values())
            case list() as items:
                waiting.extend(items)
    return min(found, MAX_SYMBOLS)
