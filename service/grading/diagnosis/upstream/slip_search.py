"""The search for slips that explain a wrong answer."""

from collections.abc import Callable, Sequence, Set
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from service.grading.diagnosis.upstream.slip import Names, Slip
from service.grading.diagnosis.upstream.slip_kinds import HOME_POSITION
from service.grading.diagnosis.upstream.slipped_answers import SlippedAnswers
from service.grading.diagnosis.wrong_value import Mask
from service.grading.feedback import Finding
from service.grading.misconception import Explained, Hypothesis, says
from service.grading.numerics.comparison import nearly_equal
from service.grading.numerics.samples import HALF, Samples
from service.kinematics.transforms import Numbers
from service.translations import say

# These slips change several entries. If only one is wrong, its sign or a term is the cause.
OF_SEVERAL_ENTRIES = {"quarter_turn", "half_turn", "parameter_sign"}
# Far-fetched slips if signs of the answer explain it: of the whole vector, or of a column.
AFTER_SIGNS = {"half_turn", "parameter_sign"}
# A slip of rows or columns, and the slips that it includes: only these are certain.
PARTS_OF = {
    "columns_swapped": {"distance_left_out"},
    "parameter_sign": {"sign"},
    "row_order": {"lengths_exchanged"},
}
# If more slips lead to the same answer, the message does not list them.
MAX_LISTED = 4


@dataclass(frozen=True)
class SlipSearch:
    """A student's wrong answer, and the wrong answers that possible slips lead to.

    A slip is a mistake in the table, the joints or the lengths.
    """

    answers: SlippedAnswers
    samples: Samples
    # (..., L) at some of the samples, like expected; NaN if unreadable.
    actual: Numbers
    expected: Numbers
    # The wrong entries, (...).
    wrong: Mask
    # Broadcasts to (...).
    scale: ArrayLike
    # Broadcasts to (..., 1).
    angle: ArrayLike = False
    # Returns the name that the student uses for a symbol.
    name: Callable[[str], str] = str
    # The constants that the student did not write.
    unwritten: Set[str] = frozenset()

    def explanation(self, entries: Mask) -> Explained | None:
        """Return the finding on the slips that explain these entries, or None."""
        slips = self.explaining(entries)
        finding = _finding(slips, Names(self.name, self._gives_away))
        return None if finding is None else Hypothesis(None, finding, entries, record=slips[0].kind)

    def _gives_away(self, symbol: str) -> bool:
        if symbol in self.unwritten:
            return True
        count = self.actual.shape[-1] // 2
        value = Samples.subset_of(self.samples.values[symbol], count)
        whole = nearly_equal(np.abs(self.expected[self.wrong]), np.abs(value)).any()
        before, after = self.actual[..., :count], self.actual[..., count:]
        return bool(whole or nearly_equal(before, after)[self.wrong].all())

    def explaining(self, entries: Mask) -> list[Slip]:
        """Return the slips that explain all readable ``entries``, likeliest first."""
        read = entries & np.isfinite(self.actual).all(axis=-1)
        # Nobody has calculated an answer of zeros from a table.
        if not self.answers.slips or not self.actual[np.isfinite(self.actual)].any():
            return []
        fits, changes = self._at_two_samples
        found = np.flatnonzero(fits[:, read].all(axis=1) & changes[:, read].any(axis=1))
        slips = [self.answers.slips[k] for k in found]
        if (self.wrong & read).sum() == 1:
            slips = [slip for slip in slips if slip.code not in OF_SEVERAL_ENTRIES]
        if not slips:
            return []
        fits, changes = self._compared(slips, self.actual.shape[-1] // 2)
        sure = np.flatnonzero(fits[:, read].all(axis=1) & changes[:, read].any(axis=1))
        found_slips = sorted((slips[k] for k in sure), key=lambda slip: slip.kind.rank)
        # If all joints stand still, no single joint is to blame.
        at_home = [slip for slip in found_slips if slip.kind is HOME_POSITION]
        return at_home or _certain(found_slips)

    @cached_property
    def _at_two_samples(self) -> tuple[Mask, Mask]:
        # The entries that each slip explains, and those that it changes: two masks (K, ...). All
        # slips are compared at only two samples, which is a quick first test.
        return self._compared(self.answers.slips, 1)

    def _compared(self, slips: Sequence[Slip], count: int) -> tuple[Mask, Mask]:
        # The entries that K slips explain, and those that they change: two masks (K, ...).
        samples = self.samples if count == HALF else self.samples.subset(count)
        half = self.actual.shape[-1] // 2
        some = [*range(count), *range(half, half + count)]
        answers = self.answers.at(slips, samples)
        fits = nearly_equal(self.actual[..., some], answers, self.scale, self.angle)
        same = nearly_equal(self.expected[..., some], answers, self.scale, self.angle)
        return fits, ~same


def _certain(slips: list[Slip]) -> list[Slip]:
    # A slip is removed if it includes another slip of the list as a part. A missing link is kept
    # only together with exchanged rows.
    codes = {slip.code for slip in slips}
    covered = {code for code in codes if PARTS_OF.get(code, set()) & codes}
    if codes != {"row_order", "missing_link"}:
        covered.add("missing_link")
    return [slip for slip in slips if slip.code not in covered]


def _finding(slips: Sequence[Slip], names: Names) -> Finding | None:
    # Slips with the same clause are the same to a student.
    plain = Names(names.name, lambda _: False)
    different: dict[str, Slip] = {}
    for slip in slips:
        different.setdefault(slip.words(plain).clause, slip)
    if not different or len(different) > MAX_LISTED:
        return None
    if len(different) == 1:
        hint = slips[0].words(names).hint
        return says(hint, slips[0].words(plain).correction)
    *clauses, last = [slip.words(names).clause for slip in different.values()]
    listed: str = clauses[0]
    for each in clauses[1:]:
        listed = say("{first}; {second}", first=listed, second=each)
    hint = say(
        "One of these slips explains it: {slips}; or {last}. Check each of them.",
        slips=listed,
        last=last,
    )
    return says(hint)
