"""The search for the slips of which a wrong answer follows, and the finding on them."""

from collections.abc import Callable, Sequence, Set
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from service.grading.diagnosis.upstream.slip import Slip
from service.grading.diagnosis.upstream.slip_kinds import HOME_POSITION
from service.grading.diagnosis.upstream.slipped_answers import SlippedAnswers
from service.grading.diagnosis.wrong_value import Mask
from service.grading.feedback import Finding
from service.grading.misconception import Explained, Hypothesis, says
from service.grading.numerics.comparison import nearly_equal
from service.grading.numerics.samples import HALF, Samples
from service.kinematics.transforms import Numbers

# An axis that is turned moves several entries, and so do wrong signs throughout a table; of one
# entry alone, the sign is wrong or a term.
OF_SEVERAL_ENTRIES = {"quarter_turn", "half_turn", "parameter_sign"}
# Slips that are far-fetched where signs explain the answer itself: it is reversed, or a column is.
BEHIND_SIGNS = {"half_turn", "parameter_sign"}
# A slip of rows or columns, and those that are a part of it: they are all that is sure.
PARTS_OF = {
    "columns_swapped": {"distance_left_out"},
    "parameter_sign": {"sign"},
    "row_order": {"lengths_exchanged"},
}
# More slips that lead to the same answer are not told one by one.
MOST_TOLD = 4


@dataclass(frozen=True)
class SlipSearch:
    """A wrong answer, held against the answers that slips lead to.

    ``actual`` and ``expected`` are ``(..., L)`` at the first samples of each half of ``samples``,
    NaN where nothing could be read; ``wrong`` ``(...)`` marks the wrong entries. ``scale``
    broadcasts to ``(...)``, ``angle`` to ``(..., 1)``. ``name`` gives the student's name of a
    symbol; ``unwritten`` are the constants that the student did not write.
    """

    answers: SlippedAnswers
    samples: Samples
    actual: Numbers
    expected: Numbers
    wrong: Mask
    scale: ArrayLike
    angle: ArrayLike = False
    name: Callable[[str], str] = str
    unwritten: Set[str] = frozenset()

    def explanation(self, entries: Mask) -> Explained | None:
        """What the slips say that explain these entries; None where none does."""
        slips = self.explaining(entries)
        finding = _finding(slips, self.name, self._gives_away)
        return None if finding is None else Hypothesis(None, finding, entries, record=slips[0].kind)

    def _gives_away(self, symbol: str) -> bool:
        """Whether to name a symbol would answer what is asked.

        It is a constant that the student did not write, or the whole of a wrong entry; or the
        answer stands still, and any variable moves it.
        """
        if symbol in self.unwritten:
            return True
        count = self.actual.shape[-1] // 2
        value = Samples.subset_of(self.samples.values[symbol], count)
        whole = nearly_equal(np.abs(self.expected[self.wrong]), np.abs(value)).any()
        before, after = self.actual[..., :count], self.actual[..., count:]
        return bool(whole or nearly_equal(before, after)[self.wrong].all())

    def explaining(self, entries: Mask) -> list[Slip]:
        """The slips that explain all of these entries ``(...)`` that were read, likeliest first."""
        if not self.answers.slips:
            return []
        read = entries & np.isfinite(self.actual).all(axis=-1)
        fits, changes = self._at_first
        found = np.flatnonzero(fits[:, read].all(axis=1) & changes[:, read].any(axis=1))
        slips = [self.answers.slips[k] for k in found]
        if (self.wrong & read).sum() == 1:
            slips = [slip for slip in slips if slip.code not in OF_SEVERAL_ENTRIES]
        if not slips:
            return []
        fits, changes = self._compared(slips, self.actual.shape[-1] // 2)
        sure = np.flatnonzero(fits[:, read].all(axis=1) & changes[:, read].any(axis=1))
        found_slips = sorted((slips[k] for k in sure), key=lambda slip: slip.kind.rank)
        # Where all joints stand still, no single one of them is to blame.
        at_home = [slip for slip in found_slips if slip.kind is HOME_POSITION]
        return at_home or _sure(found_slips)

    @cached_property
    def _at_first(self) -> tuple[Mask, Mask]:
        """All slips at two samples, which few but the right ones pass."""
        return self._compared(self.answers.slips, 1)

    def _compared(self, slips: Sequence[Slip], count: int) -> tuple[Mask, Mask]:
        """Which entries ``(K, ...)`` K slips explain and which they change, at some samples."""
        samples = self.samples if count == HALF else self.samples.subset(count)
        half = self.actual.shape[-1] // 2
        some = [*range(count), *range(half, half + count)]
        answers = self.answers.at(slips, samples)
        fits = nearly_equal(self.actual[..., some], answers, self.scale, self.angle)
        same = nearly_equal(self.expected[..., some], answers, self.scale, self.angle)
        return fits, ~same


def _sure(slips: list[Slip]) -> list[Slip]:
    """The slips without those of which another is a part.

    A link that is missing in the product is told here only beside rows in another order. By itself
    it is told as such a product (``link_products``).
    """
    codes = {slip.code for slip in slips}
    covered = {code for code in codes if PARTS_OF.get(code, set()) & codes}
    if codes != {"row_order", "missing_link"}:
        covered.add("missing_link")
    return [slip for slip in slips if slip.code not in covered]


def _finding(
    slips: Sequence[Slip], name: Callable[[str], str], gives_away: Callable[[str], bool]
) -> Finding | None:
    """The finding on slips that lead to the same answer: one, or those of which it is one."""
    clauses = list(dict.fromkeys(slip.clause for slip in slips))
    if not clauses or len(clauses) > MOST_TOLD:
        return None
    likeliest, correction = slips[0], ""
    hint = f"One of these slips explains it: {'; '.join(clauses[:-1])}; or {clauses[-1]}. "
    hint += "Check each of them."
    if len(clauses) == 1:
        hint = f"{clauses[0]}: {likeliest.advice}"
        correction = likeliest.correction.format_map(_Names(name, lambda _: False))
    hint = hint.format_map(_Names(name, gives_away))
    return says(f"{hint[0].upper()}{hint[1:]}", correction)


class _Names(dict[str, "_Name"]):
    """The names of symbols, each looked up when it is asked for."""

    def __init__(self, name: Callable[[str], str], gives_away: Callable[[str], bool]) -> None:
        self._name, self._gives_away = name, gives_away

    def __missing__(self, symbol: str) -> "_Name":
        return _Name(self._name(symbol), self._gives_away(symbol))


@dataclass(frozen=True, slots=True)
class _Name:
    """A symbol's name, with other words in its place where it would give too much away."""

    name: str
    gives_away: bool

    def __format__(self, otherwise: str) -> str:
        return otherwise if self.gives_away else self.name
