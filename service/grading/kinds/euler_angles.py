"""Answer kind ``euler_angles``: three angles that describe a rotation.

Every triple of angles that gives the rotation is correct. A wrong triple is compared with the
nearest correct triple.
"""

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from service.catalogue.parts.euler_angles import EulerAnglesSpec
from service.grading.diagnosis.lists.angle import is_arctangent
from service.grading.diagnosis.lists.euler_triple import WrongTriple, explain_triple
from service.grading.diagnosis.lists.value_list import slips_of
from service.grading.feedback import Finding
from service.grading.formula_text import value_formula
from service.grading.judging.content import known_cells, of_list
from service.grading.judging.expected import asked_pose, formula_values
from service.grading.judging.report_rows import value_rows
from service.grading.judging.value_list import ComparedValues
from service.grading.misconception import Explained
from service.grading.numerics.comparison import (
    Match,
    SharedDecimals,
    difference,
    entry_matches,
    fitted_shifts,
    rounding_slack,
)
from service.grading.numerics.tolerances import EXACT_VALUE, SAME_TRIPLE
from service.grading.part import Content, Grading, Judged
from service.grading.reading.entry import Entry
from service.grading.reading.lists.component_names import names_of_angles
from service.grading.reading.lists.value_list import StudentValues, read_list
from service.grading.report import Correction, Severity
from service.kinematics.rotations import (
    from_angles,
    is_singular,
    last_angle,
    other_triple,
    to_angles,
)
from service.kinematics.transforms import Matrices, Numbers
from service.translations import say

SINGULAR = Finding(
    "singular_orientation",
    say(
        "Here the first and the third axis lie in one line. Only the sum or the difference of the "
        "outer angles counts: any pair that fits is right."
    ),
    severity=Severity.INFO,
)


def read_euler_angles_answer(
    part: EulerAnglesSpec, answer: object, grading: Grading
) -> StudentValues:
    """Read the angles in a list or a pasted text."""
    names = names_of_angles(part.turns, fixed=part.axes == "fixed")
    return read_list(answer, names, grading.reader)


def judge_euler_angles_answer(
    part: EulerAnglesSpec, answer: StudentValues, grading: Grading
) -> Judged:
    """Judge the angles; the report has one row for each angle."""
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
    if not findings or findings[-1] is SINGULAR:
        slips = {**_slips(answer, expected, found, grading), **slips}
    rows = value_rows(answer, found, slips, grading)
    return Judged(rows, _content(expected, rotation, part), grading.messages(findings))


def _content(expected: Numbers, rotation: Matrices, part: EulerAnglesSpec) -> Content:
    # The angles that are not 0. At most as many count as in the simplest triple of the rotation.
    fixed = part.axes == "fixed"
    simplest = nearest_triple(np.zeros_like(expected), rotation, part.turns, fixed=fixed)
    known, most = (known_cells(triple, 0.0, angle=True) for triple in (expected, simplest))
    return of_list(known, most)


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
    # Angles that give the rotation all match.
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
    # In a singular orientation only a sum of angles matters, so that single angles may be
    # arbitrary.
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
    """Return the triple ``(3, SAMPLES)`` of ``rotation`` that is nearest to ``angles``.

    The nearest triple has the fewest different angles. ``slack`` is the rounding error of each
    angle.
    """
    # A NaN does not count as different.
    if fixed:
        return nearest_triple(angles[::-1], rotation, sequence[::-1], slack=slack[::-1])[::-1]
    one = to_angles(sequence, rotation)
    singular = is_singular(sequence, rotation)
    if singular.any():
        one = np.where(singular[:, None], _singular_triple(angles, one, rotation, sequence), one)
    both = np.stack([one, np.where(singular[:, None], one, other_triple(sequence, one))])
    off = np.nan_to_num(np.abs(difference(angles.T, both, angle=True)))
    hit = off <= np.maximum(slack, SAME_TRIPLE)
    return np.asarray(both[_family(off, hit), np.arange(len(one))].T)


def _family(off: Numbers, hit: NDArray[np.bool_]) -> NDArray[np.int_]:
    # For each of the two triples of a rotation, ``off`` is the distance of each angle from the
    # triple's angle, and ``hit`` is a mask of equal angles, both ``(2, SAMPLES, 3)``. The choice
    # makes as many angles as possible correct at all samples.
    total, samples = off.sum(axis=-1), np.arange(off.shape[1])
    for count in (3, 2, 1):
        fits = [hit[..., list(each)].all(axis=-1) for each in combinations(range(3), count)]
        sides = [
            np.where(fit, total, np.inf).argmin(axis=0) for fit in fits if fit.any(axis=0).all()
        ]
        if sides:
            return min(sides, key=lambda side: float(total[side, samples].sum()))
    return np.asarray(total.argmin(axis=0))


def _singular_triple(angles: Numbers, one: Numbers, rotation: Matrices, sequence: str) -> Numbers:
    # The first angle is as the student wrote it.
    first = np.where(np.isfinite(angles[0]), angles[0], one[:, 0])
    last = last_angle(sequence, np.stack([first, one[:, 1]], axis=-1), rotation)
    if not np.isfinite(angles[0]).all():
        last = np.where(np.isfinite(angles[2]), angles[2], last)
    return np.stack([first, one[:, 1], last], axis=-1)


def _arctangents(entries: Sequence[Entry]) -> list[bool]:
    expressions = [entry.expression for entry in entries]
    return [each is not None and is_arctangent(each.tree) for each in expressions]


def _explained(
    found: NDArray[np.int_], explained: Explained | None
) -> tuple[NDArray[np.int_], dict[tuple[int, int], Finding], tuple[Finding, ...]]:
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
    wrong = found < Match.ROUNDED
    corrections: list[Correction | None] = [None] * len(expected)
    if wrong.any() and grading.corrects:
        exercise, samples = grading.exercise, grading.samples
        spelling = grading.spelling(student.entries)
        corrections = [
            value_formula(angle, True, exercise, samples, spelling) if is_wrong else None
            for angle, is_wrong in zip(expected, wrong, strict=True)
        ]
    return slips_of(ComparedValues(student, expected, corrections), wrong, grading)
