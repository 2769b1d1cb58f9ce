"""Answer kind ``position``: the coordinates of a point, such as the end effector's."""

from dataclasses import dataclass

import numpy as np

from service.catalogue import Robot
from service.catalogue.parts.position import PositionSpec
from service.expressions import Kind
from service.grading.comparison import Match
from service.grading.diagnosis.matrix_case import chains_of
from service.grading.diagnosis.position import WrongPosition, explain_position
from service.grading.feedback import Finding
from service.grading.judging.expected import as_entries, asked_pose, is_whole_chain, own_values
from service.grading.judging.report_rows import entry_rows
from service.grading.judging.value_list import WrittenValues, slips_of
from service.grading.kinds.matrix_rows import UnreadableMatrixError, constant_text
from service.grading.part import Grading, PartTerms
from service.grading.reading.value_list import read_list
from service.grading.report import PartReport, Verdict
from service.kinematics.transforms import Numbers


@dataclass(frozen=True, slots=True)
class PositionKind:
    """Grades the coordinates of a point one by one."""

    def grade(self, part: PositionSpec, answer: object, grading: Grading) -> PartReport:
        """The report on a list of coordinates, one row for each."""
        terms = PartTerms(part.id, part.kind, part.points, part.all_or_nothing)
        quantities: list[Kind] = ["length"] * len(part.coordinates)
        try:
            # Of [x, y, 0] for x and z nobody could say whether z is the second or the third.
            planar = part.coordinates == "xy"
            entries = read_list(answer, quantities, grading.reader, planar=planar)
        except UnreadableMatrixError as error:
            return terms.unread(Verdict.UNREADABLE, grading.visible((error.finding,)))
        expected = _expected(part, grading)
        texts = [constant_text(values) for values in expected]
        written = WrittenValues(entries, expected, quantities, texts)
        found = written.matches(grading)
        wrong = found < Match.ROUNDED
        explained = _explained(part, written, grading) if wrong.any() else None
        slips = {} if explained else slips_of(written, wrong, grading)
        column = [[entry] for entry in entries]
        rows = entry_rows(column, found[:, None], slips, part.points, grading)
        return terms.report(rows, grading.visible((explained,) if explained else ()))


def _expected(part: PositionSpec, grading: Grading) -> Numbers:
    """The coordinates asked for, ``(n, SAMPLES)``."""
    own = own_values(part.id, grading.exercise, grading.samples)
    if own is not None:
        return np.asarray(own[0])
    pose = as_entries(asked_pose(part, grading))
    return pose[_axes(part), 3]


def _axes(part: PositionSpec) -> list[int]:
    return ["xyz".index(letter) for letter in part.coordinates]


def _explained(part: PositionSpec, written: WrittenValues, grading: Grading) -> Finding | None:
    exercise = grading.exercise
    by_links = is_whole_chain(part, exercise) and isinstance(exercise.reference, Robot)
    return explain_position(
        WrongPosition(
            actual=written.actual(grading),
            expected=written.expected,
            axes=tuple(_axes(part)),
            scale=exercise.length_scale,
            chains=chains_of(exercise, grading.samples) if by_links else (),
        )
    )
