"""The alternatives to a correct table describe the same robot as the table."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.expressions import read
from dh_grader.grading import Submission
from dh_grader.hints import MOST, other_choices

from tests.shipped import sampled, shipped_exercises
from tests.solutions.solved import solved

COLUMNS = ("a", "alpha", "d", "theta")


def table_of(exercise: Exercise) -> DhTableSpec | None:
    tables = (part for part in exercise.parts if isinstance(part, DhTableSpec))
    free = (each for each in tables if each.frames == "free" and each.convention != "either")
    return next(free, None)


FREE = [name for name, exercise in shipped_exercises().items() if table_of(exercise)]


def model_rows(exercise: Exercise, part: DhTableSpec) -> list[dict[str, str]]:
    [found] = [each for each in solved(exercise).parts if each.part == part.id]
    answer: Any = found.answer
    return [{name: str(row[name]) for name in COLUMNS} for row in answer["rows"]]


def turn(axis: int, angle: float) -> Any:
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    matrix = np.eye(4)
    matrix[[i, j], [i, j]] = np.cos(angle)
    matrix[j, i] = np.sin(angle)
    matrix[i, j] = -np.sin(angle)
    return matrix


def move(axis: int, length: float) -> Any:
    matrix = np.eye(4)
    matrix[axis, 3] = length
    return matrix


def pose(
    rows: Sequence[Mapping[str, str]], exercise: Exercise, convention: str, numbers: Any
) -> Any:
    product = np.eye(4)
    for row in rows:
        a, alpha, d, theta = (
            float(np.squeeze(read(row[name], exercise.vocabulary).evaluate(numbers)))
            for name in COLUMNS
        )
        about_z, about_x = turn(2, theta) @ move(2, d), move(0, a) @ turn(0, alpha)
        product = product @ (about_z @ about_x if convention == "standard" else about_x @ about_z)
    return product


@pytest.mark.parametrize("exercise_id", sampled(FREE, 6))
def test_each_choice_is_another_table_of_the_same_robot(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue[exercise_id]
    part = table_of(exercise)
    assert part is not None
    rows = model_rows(exercise, part)
    found = other_choices(exercise, part, rows, Submission({}))
    assert len(found) == MOST, exercise.id
    tables = [rows, *([dict(row) for row in each.rows] for each in found)]
    assert len({str(table) for table in tables}) == MOST + 1
    draw = np.random.default_rng(7)
    values = {name: draw.uniform(0.2, 1.4, 1) for name in exercise.symbols}
    if part.base == part.tool == part.directions == "given":
        expected = pose(rows, exercise, part.convention, values)
        for table in tables[1:]:
            np.testing.assert_allclose(
                pose(table, exercise, part.convention, values), expected, atol=1e-9
            )


@pytest.mark.parametrize("cell", COLUMNS)
def test_a_wrong_table_has_no_choices(cell: str, catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue["planar-rr"]
    part = exercise.part("table")
    assert isinstance(part, DhTableSpec)
    rows = model_rows(exercise, part)
    rows[1] = {**rows[1], cell: "0.7"}
    assert other_choices(exercise, part, rows, Submission({})) == []


def test_given_frames_have_no_choices(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue["planar-rrr-drawn"]
    part = exercise.part("table")
    assert isinstance(part, DhTableSpec)
    assert part.frames == "given"
    assert other_choices(exercise, part, model_rows(exercise, part), Submission({})) == []


def test_the_choices_of_the_planar_arm(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue["planar-rr"]
    part = exercise.part("table")
    assert isinstance(part, DhTableSpec)
    rows = [
        {"a": "a1", "alpha": "0", "d": "0", "theta": "theta1"},
        {"a": "a2", "alpha": "0", "d": "0", "theta": "theta2"},
    ]
    found = other_choices(exercise, part, rows, Submission({}))
    assert [[tuple(row.values()) for row in each.rows] for each in found] == [
        [("-a1", "0", "0", "theta1 + 180°"), ("a2", "0", "0", "theta2 + 180°")],
        [("a1", "180°", "0", "theta1"), ("a2", "180°", "0", "-theta2")],
        [("a1", "0", "a1", "theta1"), ("a2", "0", "-a1", "theta2")],
    ]
