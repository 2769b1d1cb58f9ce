"""The wrong answers that mistakes in the table or in symbols lead to."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from service.catalogue import Exercise, PartSpec, ReferenceTable, Robot, ScrewRobot, grid_values
from service.catalogue.part import PosePartSpec
from service.catalogue.robots.robot import at_home
from service.expressions.evaluation.samples import SymbolValues
from service.grading.diagnosis.upstream.joint_slips import (
    axis_direction,
    home_slip,
    joint_slips,
)
from service.grading.diagnosis.upstream.length_slips import length_slips
from service.grading.diagnosis.upstream.slip import Change, Slip, change_cells, changed_values
from service.grading.diagnosis.upstream.table_slips import table_slips
from service.grading.judging.expected import as_entries
from service.grading.numerics.samples import Samples
from service.grading.part import Grading
from service.kinematics.chain import Table, frames
from service.kinematics.transforms import Numbers, inverse

AnswersAt = Callable[[Sequence[Change], Samples], Numbers]


@dataclass(frozen=True)
class SlippedAnswers:
    """The wrong answers that ``slips`` lead to."""

    slips: tuple[Slip, ...]
    # Returns the answers (K, ..., samples) that K changes lead to.
    at: AnswersAt
    # True if every symbol can be changed, False if only joint variables can be changed.
    by_symbols: bool = True
    # True if all joint variables are 0 in the answers.
    at_home: bool = False

    def of(self, entries: Callable[[Numbers], Numbers]) -> "SlippedAnswers":
        """Return a copy of the answers with only some entries, such as the positions."""
        return replace(self, at=lambda changes, samples: entries(self.at(changes, samples)))


def slipped_answers(part: PartSpec, grading: Grading) -> SlippedAnswers | None:
    """Return the wrong answers that slips lead to, or None if they cannot be computed."""
    # With formulas for the part, the answers are (K, rows, columns, samples), otherwise they are
    # poses (K, 4, 4, samples) of the robot.
    exercise = grading.exercise
    if grading.following:
        return None
    if exercise.formulas.get(part.id) is not None:
        return _of_formulas(part, exercise, grading.samples)
    if exercise.reference is None or not isinstance(part, PosePartSpec):
        return None
    poses = _of_table if isinstance(exercise.reference, Robot) else _of_screws
    return poses(part, exercise, grading.samples)


def _of_table(part: PosePartSpec, exercise: Exercise, samples: Samples) -> SlippedAnswers:
    robot = exercise.robot
    table = robot.tables[robot.convention]
    start, to, last = *map(robot.frame_number, (part.start, part.to)), len(table.rows)

    def values_at(samples: Samples) -> SymbolValues:
        values = samples.values
        return at_home(robot.joints, values, samples.count) if part.home else values

    def at(changes: Sequence[Change], samples: Samples) -> Numbers:
        tables = slipped_tables(table, changes, values_at(samples), samples.count)
        reached = frames(tables, table.convention)
        # A slip may add a row at the end.
        return as_entries(inverse(reached[start]) @ reached[to if to < last else -1])

    few = samples.subset(1)
    constants = table.values(at_home(robot.joints, few.values, few.count), few.count)
    axis, whole = axis_direction(exercise, few), (start, to) == (0, last)
    slips = table_slips(table, constants, axis, home=part.home, whole=whole)
    return SlippedAnswers(tuple(slips), at, at_home=part.home)


def slipped_tables(
    table: ReferenceTable, changes: Sequence[Change], values: SymbolValues, count: int
) -> Table:
    """Return one changed table for each of K changes, in an array ``(rows, 4, K, samples)``."""
    # A change in a row that the table does not have adds rows.
    changed = changed_values(changes, values)
    tables = table.values(changed, len(changes) * count).reshape(len(table.rows), 4, -1, count)
    right = table.values(values, count)
    constants = table.values(at_home(table.joints, values, count), count)
    added = max((cell.row + 1 for each in changes for cell in each.cells), default=0) - len(tables)
    if added > 0:
        tables, right, constants = (
            np.concatenate([cells, np.zeros((added, *cells.shape[1:]))])
            for cells in (tables, right, constants)
        )
    change_cells(changes, tables, right, constants)
    return tables


def _of_screws(part: PosePartSpec, exercise: Exercise, samples: Samples) -> SlippedAnswers:
    robot = exercise.reference
    assert isinstance(robot, ScrewRobot)

    def pose(values: SymbolValues, count: int) -> Numbers:
        if part.home:
            values = at_home(robot.joints, values, count)
        start, to = (robot.frame(name, values, count) for name in (part.start, part.to))
        return as_entries(inverse(start) @ to)

    slips = _general_slips(exercise, samples)
    return SlippedAnswers(slips, _stacked(pose), at_home=part.home)


def _of_formulas(part: PartSpec, exercise: Exercise, samples: Samples) -> SlippedAnswers:
    grid = exercise.formulas[part.id]
    at = _stacked(lambda values, count: grid_values(grid, values, count))
    return SlippedAnswers(_general_slips(exercise, samples), at)


def _stacked(answer: Callable[[SymbolValues, int], Numbers]) -> AnswersAt:
    # The returned function calls answer once for all changes, and splits the result.
    def at(changes: Sequence[Change], samples: Samples) -> Numbers:
        values = changed_values(changes, samples.values)
        found = answer(values, len(changes) * samples.count)
        split = found.reshape(*found.shape[:-1], len(changes), samples.count)
        return np.moveaxis(split, -2, 0)

    return at


def _general_slips(exercise: Exercise, samples: Samples) -> tuple[Slip, ...]:
    joints = exercise.joints
    if not joints:
        return ()
    variables = {joint.variable for joint in joints}
    lengths = [
        variable.name
        for variable in exercise.variables
        if variable.kind == "length" and variable.name not in variables
    ]
    axis = axis_direction(exercise, samples.subset(1))
    return (*joint_slips(joints, joints, axis), *home_slip(joints), *length_slips(lengths))
