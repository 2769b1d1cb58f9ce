"""The content cells of a table: the cells that need knowledge (see ``content``)."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np

from service.catalogue import Exercise, Joint
from service.catalogue.parts.dh_table import DhTableSpec
from service.grading.judging.content import KnownCells, known_cells, of_rows
from service.grading.judging.own_frames.nearest.nearest_table import nearest_for_roles
from service.grading.judging.own_frames.reference import reference_values
from service.grading.judging.own_frames.row_roles import (
    Role,
    freedom_of,
    joint_variables,
)
from service.grading.judging.table import Judgement, column_scales
from service.grading.numerics.samples import SAMPLES, draw
from service.grading.part import Content, Grading
from service.grading.reading.entry import Reader
from service.grading.reading.tables.table import (
    IS_ANGLE,
    computed_row,
)
from service.kinematics.chain import Table
from service.kinematics.dh import Convention


def table_content(
    part: DhTableSpec, judgement: Judgement, convention: Convention, grading: Grading
) -> Content:
    """Return the content cells of a table: the cells that need knowledge."""
    exercise = grading.exercise
    task = _Task(exercise.version, part.id, convention, part, exercise)
    # Unreadable cells alone do not increase the cost of a unit.
    is_spoiled = part.frames == "free" and bool(judgement.wrong_as_read or judgement.empty)
    most = _fewest(task) if is_spoiled else None
    if not judgement.roles:
        content = _of_reference(task)
        return replace(content, most=most) if is_spoiled else content
    joints = [judged.joint for judged in judgement.rows]
    expected = np.array([judged.expected for judged in judgement.rows])
    known = _differs_from_lazy(expected, joints, grading)
    of_robot = exercise.robot.convention
    same = task if convention is of_robot else replace(task, convention=of_robot)
    usual = _of_reference(same).usual
    return of_rows(known, most=most, usual=usual)


def _differs_from_lazy(
    table: Table, joints: Sequence[Joint | None], grading: Grading
) -> KnownCells:
    # Two samples with different links and joint values are enough to distinguish formulas.
    lazy = joint_variables(joints, grading.samples)[..., :: SAMPLES - 1]
    cells, angle = table[..., :: SAMPLES - 1], IS_ANGLE[:, None]
    # The joint variable with a minus sign is also lazy.
    either = known_cells(np.array([cells, -cells]), lazy, column_scales(grading), angle)
    return np.asarray(either.all(axis=0))


@dataclass(frozen=True)
class _Task:
    # A cache key: equal for the same exercise version, part and convention.
    version: str
    part_id: str
    convention: Convention
    part: DhTableSpec = field(compare=False)
    exercise: Exercise = field(compare=False)


@lru_cache(maxsize=256)
def _of_reference(task: _Task) -> Content:
    grading = _own_grading(task.exercise)
    table = reference_values(task.exercise.robot.tables[task.convention], grading.samples)
    joints = _joints_of_rows(task)
    content = _without_given(of_rows(_differs_from_lazy(table, joints, grading)), task.part)
    usual: tuple[int, int] | None = (sum(content.earning), content.count)
    if task.convention != task.exercise.robot.convention:
        usual = _of_reference(replace(task, convention=task.exercise.robot.convention)).usual
    return replace(content, usual=usual)


def _without_given(content: Content, part: DhTableSpec) -> Content:
    if not part.given:
        return content
    given = tuple(i + 1 in part.given for i in range(len(content.known)))
    first = content.groups[given.index(False)]
    rows = list(zip(content.known, content.groups, given, strict=True))
    return replace(
        content,
        known=tuple((False,) * len(row) if is_given else row for row, _, is_given in rows),
        groups=tuple(first if is_given else group for _, group, is_given in rows),
        given=given,
    )


def _own_grading(exercise: Exercise) -> Grading:
    samples = draw(exercise, None)
    reader = Reader.of(exercise, samples, "radians")
    return Grading(exercise, samples, reader)


def _joints_of_rows(task: _Task) -> list[Joint | None]:
    joints, reference = task.exercise.joints, task.exercise.robot.tables.get(task.convention)
    count = len(joints if reference is None else reference.rows)
    return [*joints, *[None] * (count - len(joints))]


@lru_cache(maxsize=256)
def _fewest(task: _Task) -> int:
    # Along parallel axes, a table may have the sum of two lengths in one cell, or arbitrary numbers
    # in other cells that cancel out. Such additional cells have no worth.
    grading, joints = _own_grading(task.exercise), _joints_of_rows(task)
    lazy = joint_variables(joints, grading.samples)
    roles = tuple(Role(computed_row(row), joint) for row, joint in zip(lazy, joints, strict=True))
    nearest = nearest_for_roles(roles, task.convention, freedom_of(task.part), grading)
    return int(np.count_nonzero(_differs_from_lazy(nearest.expected, joints, grading)))
