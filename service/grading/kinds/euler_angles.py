"""Answer kind ``euler_angles``: three angles that describe a rotation.

Every triple of the same rotation is right. Where the triple is wrong, it is held against the
nearest of those that are right, so that a single slip costs a single angle.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from service.catalogue.parts.euler_angles import EulerAnglesSpec
from service.expressions import Kind
from service.expressions.tree import Call
from service.grading.comparison import EXACT, ROUNDED, Match, difference, matches
from service.grading.diagnosis.angle import (
    ARCTANGENTS,
    AnglesExplained,
    WrongAngles,
    diagnose_angle,
    explain_angles,
)
from service.grading.diagnosis.formula_rewriting import nodes
from service.grading.diagnosis.wrong_value import UNEXPLAINED, WrongValue
from service.grading.feedback import Finding
from service.grading.formula_text import formula_text
from service.grading.judging.expected import asked_pose, own_values
from service.grading.judging.report_rows import entry_rows
from service.grading.kinds.matrix_rows import UnreadableMatrixError
from service.grading.part import Grading, PartTerms
from service.grading.reading.entry import Entry
from service.grading.reading.value_list import read_list
from service.grading.report import PartReport, Severity, Verdict
from service.kinematics.rotations import (
    from_angles,
    is_singular,
    last_angle,
    other_triple,
    to_angles,
)
from service.kinematics.transforms import Matrices, Numbers

QUANTITIES: tuple[Kind, ...] = ("angle",) * 3

SINGULAR = Finding(
    "singular_orientation",
    "Here the first and the third axis lie in one line, so that only the sum or the difference of "
    "the outer angles is determined: any pair that fits is right.",
    severity=Severity.INFO,
)


@dataclass(frozen=True, slots=True)
class EulerAnglesKind:
    """Grades three angles by the rotation that they describe."""

    def grade(self, part: EulerAnglesSpec, answer: object, grading: Grading) -> PartReport:
        """The report on a list of three angles, one row for each."""
        terms = PartTerms(part.id, part.kind, part.points, part.all_or_nothing)
        try:
            entries = read_list(answer, QUANTITIES, grading.reader)
        except UnreadableMatrixError as error:
            return terms.unread(Verdict.UNREADABLE, grading.visible((error.finding,)))
        turns, fixed = part.turns, part.axes == "fixed"
        rotation = _expected_rotation(part, grading)
        angles = grading.reader.numbers(entries, QUANTITIES)
        expected = nearest_triple(angles, rotation, turns, fixed=fixed)
        found = _found(angles, expected, rotation, entries, part)
        slips: dict[tuple[int, int], Finding] = {}
        told: tuple[Finding, ...] = ()
        if is_singular(turns, rotation, fixed=fixed).all():
            told = (SINGULAR,)
        if (found < Match.ROUNDED).any() and np.isfinite(angles).all():
            case = WrongAngles(angles, rotation, turns, fixed, _arctangents(entries))
            found, slips, explained = _explained(found, explain_angles(case))
            told += explained
        slips = {**_slips(entries, angles, expected, found, grading), **slips}
        if told and told[-1] is not SINGULAR:
            slips = {place: slip for place, slip in slips.items() if slip.code != UNEXPLAINED}
        rows = entry_rows(
            [[entry] for entry in entries], found[:, None], slips, part.points, grading
        )
        return terms.report(rows, grading.visible(told))


def _expected_rotation(part: EulerAnglesSpec, grading: Grading) -> Matrices:
    own = own_values(part.id, grading.exercise, grading.samples)
    if own is None:
        return asked_pose(part, grading)[:, :3, :3]
    return from_angles(part.turns, own[0].T, fixed=part.axes == "fixed")


def _found(
    angles: Numbers,
    expected: Numbers,
    rotation: Matrices,
    entries: list[Entry],
    part: EulerAnglesSpec,
) -> NDArray[np.int_]:
    """The Match of each angle, ``(3,)``: all are right where they describe the rotation."""
    rounded = [entry.may_be_rounded for entry in entries]
    found = matches(angles, expected, 1.0, angle=True, rounded=rounded)
    if np.isfinite(angles).all():
        described = from_angles(part.turns, angles.T, fixed=part.axes == "fixed")
        if np.abs(described - rotation).max() < EXACT:
            return np.full(3, int(Match.EXACT))
    return found


def nearest_triple(
    angles: Numbers, rotation: Matrices, sequence: str, *, fixed: bool = False
) -> Numbers:
    """Of all triples ``(3, SAMPLES)`` that describe ``rotation``, the one nearest to ``angles``.

    Nearest is the one that the fewest angles differ from. A NaN differs from nothing.
    """
    if fixed:
        return nearest_triple(angles[::-1], rotation, sequence[::-1])[::-1]
    one = to_angles(sequence, rotation)
    singular = is_singular(sequence, rotation)
    if singular.any():
        one = np.where(singular[:, None], _singular_triple(angles, one, rotation, sequence), one)
    both = np.stack([one, np.where(singular[:, None], one, other_triple(sequence, one))])
    off = np.nan_to_num(np.abs(difference(angles.T, both, angle=True)))
    hit = off <= ROUNDED * np.maximum(1.0, np.abs(both))
    samples = np.arange(len(one))
    # The samples may take sides differently: an atan2 is of one family, a robot's own angle of
    # both.
    by_sample = np.lexsort((off.sum(axis=-1), -hit.sum(axis=-1)), axis=0)[0]
    sides = [np.zeros_like(by_sample), np.ones_like(by_sample), by_sample]
    best = min(
        sides,
        key=lambda side: (
            np.count_nonzero(~hit[side, samples].all(axis=0)),
            float(off[side, samples].sum()),
        ),
    )
    return np.asarray(both[best, samples].T)


def _singular_triple(angles: Numbers, one: Numbers, rotation: Matrices, sequence: str) -> Numbers:
    """The triple with the first angle as written: the last makes up for it."""
    first = np.where(np.isfinite(angles[0]), angles[0], one[:, 0])
    last = last_angle(sequence, np.stack([first, one[:, 1]], axis=-1), rotation)
    if not np.isfinite(angles[0]).all():
        last = np.where(np.isfinite(angles[2]), angles[2], last)
    return np.stack([first, one[:, 1], last], axis=-1)


def _arctangents(entries: list[Entry]) -> tuple[bool, bool, bool]:
    one, two, three = (
        entry.expression is not None
        and any(
            isinstance(node, Call) and node.function in ARCTANGENTS
            for node in nodes(entry.expression.tree)
        )
        for entry in entries
    )
    return one, two, three


def _explained(
    found: NDArray[np.int_], explained: AnglesExplained | None
) -> tuple[NDArray[np.int_], dict[tuple[int, int], Finding], tuple[Finding, ...]]:
    """The matches, the slips of single angles and the findings on all three together."""
    if explained is None:
        return found, {}, ()
    if explained.blamed is None:
        return found, {}, (explained.finding,)
    blamed = explained.blamed
    matched = np.where(blamed, int(Match.DIFFERENT), int(Match.EXACT))
    slips = {(int(i), 0): explained.finding for i in np.flatnonzero(blamed)}
    return matched, slips, ()


def _slips(
    entries: list[Entry],
    angles: Numbers,
    expected: Numbers,
    found: NDArray[np.int_],
    grading: Grading,
) -> dict[tuple[int, int], Finding]:
    """What is to be said of single wrong angles."""
    return {
        (i, 0): diagnose_angle(
            WrongValue(
                expression=entry.expression,
                actual=angles[i],
                expected=expected[i],
                expected_text=formula_text(expected[i], True, grading.exercise, grading.samples),
                samples=grading.samples,
                scale=1.0,
                angle=True,
            )
        )
        for i, entry in enumerate(entries)
        if entry.expression is not None and found[i] < Match.ROUNDED
    }
