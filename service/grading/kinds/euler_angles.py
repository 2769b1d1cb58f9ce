"""Answer kind ``euler_angles``: three angles that describe a rotation.

Every triple of the same rotation is right. Where the triple is wrong, it is held against the
nearest of those that are right, so that a single slip costs a single angle.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from service.catalogue.parts.euler_angles import EulerAnglesSpec
from service.expressions import Kind
from service.grading.comparison import (
    Match,
    SharedDecimals,
    difference,
    entry_matches,
    fitted_shifts,
    rounding_slack,
)
from service.grading.diagnosis.angle import has_arctangent
from service.grading.diagnosis.euler_triple import RepairedTriple, WrongTriple, explain_triple
from service.grading.diagnosis.value_list import slips_of
from service.grading.diagnosis.wrong_value import UNEXPLAINED
from service.grading.feedback import Finding
from service.grading.formula_text import formula_text
from service.grading.judging.expected import asked_pose, formula_values
from service.grading.judging.report_rows import value_rows
from service.grading.judging.value_list import ComparedValues
from service.grading.part import Grading, Judged
from service.grading.reading.entry import Entry
from service.grading.reading.value_list import StudentValues, read_list
from service.grading.report import Severity
from service.grading.tolerances import EXACT_VALUE, SAME_TRIPLE
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


def read(part: EulerAnglesSpec, answer: object, grading: Grading) -> StudentValues:
    """The angles in a list or a pasted text."""
    return read_list(answer, QUANTITIES, grading.reader)


def judge(part: EulerAnglesSpec, answer: StudentValues, grading: Grading) -> Judged:
    """The list with one row for each angle."""
    turns, fixed = part.turns, part.axes == "fixed"
    angles, rotation = answer.values, _expected_rotation(part, grading)
    slack = [rounding_slack(each, grading.samples) if each else 0.0 for each in answer.expressions]
    expected = nearest_triple(angles, rotation, turns, fixed=fixed, slack=slack)
    found = _found(answer, expected, rotation, part, grading)
    slips: dict[tuple[int, int], Finding] = {}
    findings: tuple[Finding, ...] = ()
    if is_singular(turns, rotation, fixed=fixed).all():
        findings = (SINGULAR,)
    if (found < Match.ROUNDED).any() and np.isfinite(angles).all():
        case = WrongTriple(angles, rotation, turns, fixed, _arctangents(answer.entries))
        found, slips, explained = _explained(found, explain_triple(case))
        findings += explained
    slips = {**_slips(answer, expected, found, grading), **slips}
    if findings and findings[-1] is not SINGULAR:
        slips = {place: slip for place, slip in slips.items() if slip.code != UNEXPLAINED}
    rows = value_rows(answer, found, slips, part.points, grading)
    return Judged(rows, grading.visible(findings))


def _expected_rotation(part: EulerAnglesSpec, grading: Grading) -> Matrices:
    given = formula_values(part, grading)
    if given is None:
        return asked_pose(part, grading)[:, :3, :3]
    return from_angles(part.turns, given[0].T, fixed=part.axes == "fixed")


def _found(
    student: StudentValues,
    expected: Numbers,
    rotation: Matrices,
    part: EulerAnglesSpec,
    grading: Grading,
) -> NDArray[np.int_]:
    """The Match of each angle, ``(3,)``: all are right where they describe the rotation."""
    angles = student.values
    found = entry_matches(student.expressions, angles, expected, 1.0, grading.samples, angle=True)
    if np.isfinite(angles).all():
        described = from_angles(part.turns, angles.T, fixed=part.axes == "fixed")
        if np.abs(described - rotation).max() < EXACT_VALUE:
            return np.full(3, int(Match.EXACT))
        if (found < Match.ROUNDED).any() and _are_rounded(student, rotation, part, grading):
            return np.where(found == Match.EXACT, found, int(Match.ROUNDED))
    return found


def _are_rounded(
    student: StudentValues, rotation: Matrices, part: EulerAnglesSpec, grading: Grading
) -> bool:
    """Whether the angles describe the rotation but for their decimals, which are rounded.

    In a singular orientation each by itself need not be a rounded angle: their sum counts.
    """
    decimals = SharedDecimals(student.expressions, grading.samples)
    if not decimals.count:
        return False

    def errors(shifts: Numbers) -> Numbers:
        angles = decimals.shifted(shifts, student.values)
        described = from_angles(part.turns, np.swapaxes(angles, 1, 2), fixed=part.axes == "fixed")
        return np.asarray((described - rotation).reshape(len(shifts), -1))

    return fitted_shifts(errors, decimals.units, EXACT_VALUE) is not None


def nearest_triple(
    angles: Numbers,
    rotation: Matrices,
    sequence: str,
    *,
    fixed: bool = False,
    slack: Sequence[float] = (0.0, 0.0, 0.0),
) -> Numbers:
    """Of all triples ``(3, SAMPLES)`` that describe ``rotation``, the one nearest to ``angles``.

    Nearest is the one that the fewest angles differ from by more than ``slack``, what rounding may
    have done to each of them. A NaN differs from nothing.
    """
    if fixed:
        return nearest_triple(angles[::-1], rotation, sequence[::-1], slack=slack[::-1])[::-1]
    one = to_angles(sequence, rotation)
    singular = is_singular(sequence, rotation)
    if singular.any():
        one = np.where(singular[:, None], _singular_triple(angles, one, rotation, sequence), one)
    both = np.stack([one, np.where(singular[:, None], one, other_triple(sequence, one))])
    off = np.nan_to_num(np.abs(difference(angles.T, both, angle=True)))
    hit = off <= np.maximum(slack, SAME_TRIPLE)
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


def _arctangents(entries: Sequence[Entry]) -> list[bool]:
    expressions = [entry.expression for entry in entries]
    return [each is not None and has_arctangent(each.tree) for each in expressions]


def _explained(
    found: NDArray[np.int_], explained: RepairedTriple | None
) -> tuple[NDArray[np.int_], dict[tuple[int, int], Finding], tuple[Finding, ...]]:
    """The matches, the slips of single angles and the findings on all three together."""
    if explained is None:
        return found, {}, ()
    slipped = explained.entries
    if not isinstance(slipped, np.ndarray):
        return found, {}, explained.findings
    [finding] = explained.findings
    matched = np.where(slipped, int(Match.DIFFERENT), int(Match.EXACT))
    return matched, {(int(i), 0): finding for i in np.flatnonzero(slipped)}, ()


def _slips(
    student: StudentValues, expected: Numbers, found: NDArray[np.int_], grading: Grading
) -> dict[tuple[int, int], Finding]:
    """The findings on single wrong angles."""
    wrong = found < Match.ROUNDED
    texts = [
        formula_text(angle, True, grading.exercise, grading.samples) if is_wrong else ""
        for angle, is_wrong in zip(expected, wrong, strict=True)
    ]
    return slips_of(ComparedValues(student, expected, texts), wrong, grading)
