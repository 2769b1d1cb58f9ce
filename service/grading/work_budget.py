"""Limit the work for grading one submission.

Work is counted instead of timed, so that the same submission gives the same report.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final, Self

from service.expressions.reading_work import reading_cost
from service.grids.cutting.limits import GRID_LIMITS
from service.regex import regex
from service.time_slices import checkpoint

# The pose of a seven-joint arm, multiplied out without simplification and printed as LaTeX or
# JavaScript, has up to 13,900 symbols, weighted by their cost.
MAX_SYMBOLS = 14_000
# For reading a table again with its columns in another order; an ordinary table has 300 symbols.
MAX_SYMBOLS_AGAIN = 2_400
# Searching for the repair of an unreadable text costs more than any other reading.
MAX_REPAIRS = 24
# For each of these numbers of symbols that a repair reads, it counts as one more repair.
SYMBOLS_PER_REPAIR = 100

# The characters of pasted texts that are cut into cells; the symbols in the cells are counted again
# when they are read. The longest allowed text leaves half its length for the other parts.
MAX_PASTED = 36_000
# The brackets and quotation marks in these texts, for which partners are searched. The longest pose
# has 4,100 of them.
MAX_PASTED_SIGNS = 8_000

# The unit is the least work of a grading: multiplying out six links at all samples.
MAX_EXPLANATIONS = 145.0
# Enough to judge a table with unread cells in either convention, and to search for their values.
MAX_SEARCHES = 280.0
# The limit for reading, searches and explanations together.
MAX_WORK = 285.0
# The work of reading a symbol, of cutting a pasted character into a cell, of finding the partner of
# a pasted bracket, and of a repair.
SYMBOL_WORK, PASTED_WORK, SIGN_WORK, REPAIR_WORK = 1 / 100, 1 / 800, 1 / 200, 1.5

# The MathML of the pose of a seven-joint arm has 57,000 characters. Nobody reads longer formulas.
MAX_PRINTED = 60_000

# The limit for a drawing, as a number of symbols: the table, its figure, and the printed formulas.
# Those of a seven-joint arm cost 13,700.
MAX_SYMBOLS_DRAWN = 16_000
SYMBOLS_PER_FIGURE = 2_200
SYMBOLS_PER_PRINTED_NODE = 2.5


_SIGN: Final = regex(r"""[][(){}'"]""")


@dataclass(slots=True)
class WorkBudget:
    """The work that is still allowed for one submission."""

    # All its parts, pasted texts and angle units share it.

    # The names, numbers and signs that may still be read.
    symbols: int = MAX_SYMBOLS
    # The unreadable texts for which a repair may still be searched.
    repairs: int = MAX_REPAIRS
    # The characters that may still be cut into cells.
    pasted: int = MAX_PASTED
    # The brackets and quotation marks whose partners may still be searched.
    pasted_signs: int = MAX_PASTED_SIGNS
    # The work left for explaining mistakes, on which no verdict depends.
    explanations: float = MAX_EXPLANATIONS
    # The work left for finding the intended table: values of unread cells, other column orders.
    searches: float = MAX_SEARCHES
    # The characters of formulas that a preview may still print.
    printed: int = MAX_PRINTED
    # True if an explanation was too expensive.
    has_left_out: bool = False
    # The texts that could not be read.
    unreadable: set[object] = field(default_factory=set)
    # What was found in each pasted text, by the way of reading it; each text is charged once.
    found: dict[tuple[object, ...], Any] = field(default_factory=dict)
    # What was searched for in these texts and in their pieces.
    searched: dict[tuple[object, str], Any] = field(default_factory=dict)
    _charged: set[str] = field(default_factory=set)
    # The whole submission; the work for reading its later parts is reserved.
    answers: object = None
    _expected: int = -1

    @classmethod
    def of_drawing(cls, *, with_figure: bool) -> Self:
        """Return the budget for drawing the frames, formulas and figure of a table."""
        return cls(MAX_SYMBOLS_DRAWN - (SYMBOLS_PER_FIGURE if with_figure else 0))

    @property
    def left(self) -> float:
        """The work left for explanations."""
        # The total work minus that of searches and of reading, including the later parts.
        if self._expected < 0:
            self._expected = _symbols_of(self.answers)
        read = (
            SYMBOL_WORK * max(MAX_SYMBOLS - max(self.symbols, 0), self._expected)
            + PASTED_WORK * (MAX_PASTED - max(self.pasted, 0))
            + SIGN_WORK * (MAX_PASTED_SIGNS - max(self.pasted_signs, 0))
            + REPAIR_WORK * (MAX_REPAIRS - max(self.repairs, 0))
        )
        return MAX_WORK - read - (MAX_SEARCHES - self.searches)

    def affords(self, work: float) -> bool:
        """Charge ``work`` for an explanation; return True if enough work was left."""
        # The work is also taken if too little is left.
        checkpoint()
        self.explanations -= work
        left = min(self.explanations, self.left - (MAX_EXPLANATIONS - self.explanations))
        self.has_left_out |= left < 0
        return left >= 0

    def affords_search(self, work: float) -> bool:
        """Charge ``work`` for a search if enough is left; return True if it was charged."""
        # The result does not depend on earlier explanations.
        is_afforded = work <= min(self.searches, self.left)
        if is_afforded:
            self.charge_search(work)
        return is_afforded

    def charge_search(self, work: float) -> None:
        """Charge the work of a necessary search, even if not enough is left."""
        checkpoint()
        self.searches -= work

    def charge_reading(self, symbols: int) -> bool:
        """Charge the reading of a text; return True if it may be read."""
        self.symbols -= symbols
        return self.symbols >= 0

    def charge_pasted(self, text: str) -> bool:
        """Charge the cutting of a pasted text, only once; return True if it may be cut."""
        checkpoint()
        if text not in self._charged:
            self._charged.add(text)
            self.pasted -= len(text)
            self.pasted_signs -= len(_SIGN.findall(text))
        return self.pasted >= 0 and self.pasted_signs >= 0

    def charge_printing(self, nodes: int) -> bool:
        """Charge the printing of a formula of ``nodes``; return True if it may be printed."""
        return self.charge_reading(math.ceil(SYMBOLS_PER_PRINTED_NODE * nodes))

    def charge_repair(self, text: object, tried: int) -> None:
        """Charge the repair of an unreadable text, only once for each text."""
        # tried symbols were read for the repair.
        if text not in self.unreadable:
            self.unreadable.add(text)
            self.repairs -= 1 + tried // SYMBOLS_PER_REPAIR


def _symbols_of(answer: object) -> int:
    found, waiting = 0, [answer]
    # No recursion, because lists may be nested deeper than Python's call stack.
    while waiting and found < MAX_SYMBOLS:
        match waiting.pop():
            # Longer texts are never read.
            case str() as text if len(text) <= GRID_LIMITS.characters:
                found += reading_cost(text)
            case Mapping() as fields:
                waiting.extend(fields.values())
            case list() as items:
                waiting.extend(items)
    return min(found, MAX_SYMBOLS)
