"""Answer kind ``screw_axes``: the screw axis (ω; v) of each joint, seen from base or tool."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from service.catalogue.formulas import SCREW
from service.catalogue.parts.screw_axes import ScrewAxesSpec
from service.catalogue.robot import at_home
from service.grading.comparison import Match, matches
from service.grading.diagnosis.screw_axis import WrongScrew, explain_screw
from service.grading.feedback import Finding
from service.grading.judging.expected import own_values
from service.grading.judging.report_rows import entry_rows
from service.grading.judging.value_list import WrittenValues, slips_of
from service.grading.kinds.matrix_rows import (
    UnreadableMatrixError,
    constant_text,
    numbers_of,
    read_matrix,
)
from service.grading.part import Grading, PartTerms
from service.grading.reading.entry import Entry
from service.grading.report import PartReport, RowReport, Severity, Verdict, rounded_points
from service.grading.samples import SAMPLES
from service.kinematics.screws import moved
from service.kinematics.transforms import Numbers, inverse


@dataclass(frozen=True, slots=True)
class ExpectedScrews:
    """The axes asked for, and the same seen from the other frame: ``(joints, 6, SAMPLES)``.

    ``labels`` are the joints' numbers.
    """

    axes: Numbers
    elsewhere: Numbers | None
    labels: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ScrewAxesKind:
    """Grades screw axes joint by joint and number by number."""

    def grade(self, part: ScrewAxesSpec, answer: object, grading: Grading) -> PartReport:
        """The report on a list of six-vectors, one row for each joint."""
        terms = PartTerms(part.id, part.kind, part.points, part.all_or_nothing)
        expected = _expected(part, grading)
        quantities = (SCREW,) * len(expected.axes)
        try:
            entries = read_matrix(_as_rows(answer, len(quantities)), quantities, grading.reader)
        except UnreadableMatrixError as error:
            return terms.unread(Verdict.UNREADABLE, grading.visible((error.finding,)))
        actual = numbers_of(entries, quantities, grading.reader)
        found = _matches(actual, expected.axes, entries, grading)
        axes = expected.axes
        told: dict[int, Finding] = {}
        if part.directions == "free":
            turned = _matches(actual, -axes, entries, grading)
            better = (turned >= Match.ROUNDED).sum(axis=1) > (found >= Match.ROUNDED).sum(axis=1)
            found = np.where(better[:, None], turned, found)
            axes = np.where(better[:, None, None], -axes, axes)
            told = {int(i): REVERSED for i in np.flatnonzero(better)}
        wrong = found < Match.ROUNDED
        remarks = _remarks(actual, axes, wrong, expected, part, grading)
        slips = {
            (i, j): slip
            for i in np.flatnonzero(wrong.any(axis=1)).tolist()
            if i not in remarks
            for (j, _), slip in _slips(entries[i], axes[i], wrong[i], grading).items()
        }
        rows = entry_rows(
            entries,
            found,
            slips,
            part.points,
            grading,
            labels=expected.labels,
            remarks={**told, **remarks},
        )
        return terms.report(tuple(map(_marked_by_vectors, rows)))


def _marked_by_vectors(row: RowReport) -> RowReport:
    """The row with its points for ω and for v, each as a whole.

    Most numbers of an axis are 0: number by number, six zeros would earn nearly all of them.
    """
    right = [cell.verdict is Verdict.CORRECT for cell in row.cells]
    share = (all(right[:3]) + all(right[3:])) / 2
    return replace(row, points=rounded_points(row.max_points * share))


REVERSED = Finding(
    "own_direction",
    "You let this axis point the opposite way; that is a valid choice, if its variable counts so.",
    severity=Severity.INFO,
)


def _as_rows(answer: object, count: int) -> object:
    """The answer, where one single axis may be handed in without a list around it."""
    if count == 1 and isinstance(answer, list) and len(answer) == len(SCREW):
        return [answer]
    return answer


def _expected(part: ScrewAxesSpec, grading: Grading) -> ExpectedScrews:
    exercise, samples = grading.exercise, grading.samples
    own, robot = own_values(part.id, exercise, samples), exercise.reference
    if own is not None:
        return ExpectedScrews(own, None, tuple(str(i + 1) for i in range(len(own))))
    if robot is None:
        raise LookupError(f"exercise {exercise.id!r} has no robot")
    home = robot.frame("tool", at_home(robot.joints, samples.values, SAMPLES), SAMPLES)
    space = robot.screws(samples.values, SAMPLES)
    body = moved(inverse(home), space)
    asked, other = (space, body) if part.frame == "space" else (body, space)
    return ExpectedScrews(
        np.swapaxes(asked, 1, 2),
        np.swapaxes(other, 1, 2),
        tuple(str(joint.index) for joint in robot.joints),
    )


def _matches(
    actual: Numbers, expected: Numbers, entries: list[list[Entry]], grading: Grading
) -> NDArray[np.int_]:
    """The Match of each number, ``(joints, 6)``."""
    scale = np.repeat([1.0, grading.exercise.length_scale], 3)
    rounded = [[entry.may_be_rounded for entry in row] for row in entries]
    return matches(actual, expected, scale, rounded=rounded)


def _remarks(
    actual: Numbers,
    axes: Numbers,
    wrong: NDArray[np.bool_],
    expected: ExpectedScrews,
    part: ScrewAxesSpec,
    grading: Grading,
) -> dict[int, Finding]:
    """What explains the whole of a wrong axis, by its place."""
    remarks: dict[int, Finding] = {}
    for i in np.flatnonzero(wrong.any(axis=1)).tolist():
        elsewhere = None if expected.elsewhere is None else expected.elsewhere[i]
        case = WrongScrew(actual[i], axes[i], elsewhere, part.frame, grading.exercise.length_scale)
        finding = explain_screw(case)
        if finding is not None:
            remarks[i] = finding
    return remarks


def _slips(
    entries: Sequence[Entry], axis: Numbers, wrong: NDArray[np.bool_], grading: Grading
) -> dict[tuple[int, int], Finding]:
    texts = [constant_text(values) for values in axis]
    return slips_of(WrittenValues(entries, axis, SCREW, texts), wrong, grading)
