"""Test the shipped exercises."""

import tomllib
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from dh_grader.catalogue import Exercise, load_catalogue, load_exercise, shipped_folder
from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.catalogue.load import checked_digests
from dh_grader.grading import Verdict
from dh_grader.kinematics import Convention
from numpy.typing import NDArray

from tests.catalogue.checked import digests
from tests.grading.support.submitting import full_marks, handed_in, part, table
from tests.shipped import without_most_real_robots
from tests.together import together

# --- Test the shipped exercises

Numbers = NDArray[np.float64]
FILES = sorted(shipped_folder().glob("*.toml"))
# Some exercises have no robot, others one given by screw axes or no table as an answer.
WITH_TABLE = [
    file.stem
    for file in FILES
    if "table" in (content := tomllib.loads(file.read_text(encoding="utf-8"))).get("robot", {})
    and any(part["kind"] == "dh_table" for part in content["parts"])
]


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_a_shipped_file_loads(file: Path, catalogue: Mapping[str, Exercise]) -> None:
    exercise = load_exercise(file)
    assert exercise.id == file.stem
    assert exercise.title
    assert exercise.source
    assert exercise.statement.strip()
    assert exercise.parts
    assert exercise.version == catalogue[exercise.id].version


def test_the_catalogue_has_every_file_once_in_one_order(
    catalogue: Mapping[str, Exercise],
) -> None:
    assert {"planar-rrr", "rrrp", "scara", "stanford-arm"} <= set(catalogue)
    assert sorted(catalogue) == sorted(file.stem for file in FILES)
    assert list(load_catalogue(shipped_folder())) == list(catalogue)


@pytest.mark.parametrize("exercise_id", [file.stem for file in FILES])
def test_the_reference_gets_full_marks_as_the_file_writes_it(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue[exercise_id]
    for spec in exercise.parts:
        if not isinstance(spec, DhTableSpec):
            continue
        convention = exercise.robot.convention if spec.convention == "either" else spec.convention
        reference = exercise.robot.tables[convention]
        rows = [[cell.text() for cell in row] for row in reference.rows]
        answer = table(rows) | {"convention": convention.value}
        assert full_marks(part(handed_in(exercise, {spec.id: answer}), spec.id))


@pytest.mark.parametrize("exercise_id", WITH_TABLE)
def test_both_conventions_of_a_robot_reach_the_same_pose(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    robot = catalogue[exercise_id].robot
    assert robot.convention in robot.tables
    rng = np.random.default_rng(3)
    values = {
        variable.name: rng.uniform(variable.low, variable.high, 8)
        for variable in catalogue[exercise_id].variables
    }
    expected = robot.pose(values, 8)
    assert expected.shape == (8, 4, 4)
    for reference in robot.tables.values():
        product = np.tile(np.eye(4), (8, 1, 1))
        for a, alpha, d, theta in reference.values(values, 8):
            product = product @ elementary(reference.convention, a, alpha, d, theta)
        np.testing.assert_allclose(product, expected, atol=1e-12)


def elementary(
    convention: Convention, a: Numbers, alpha: Numbers, d: Numbers, theta: Numbers
) -> Numbers:
    """Return the link transforms of rows as products of elementary transforms."""
    z = np.tile(np.eye(4), (len(a), 1, 1))
    z[:, 0, 0] = z[:, 1, 1] = np.cos(theta)
    z[:, 1, 0] = np.sin(theta)
    z[:, 0, 1] = -np.sin(theta)
    z[:, 2, 3] = d
    x = np.tile(np.eye(4), (len(a), 1, 1))
    x[:, 1, 1] = x[:, 2, 2] = np.cos(alpha)
    x[:, 2, 1] = np.sin(alpha)
    x[:, 1, 2] = -np.sin(alpha)
    x[:, 0, 3] = a
    return z @ x if convention is Convention.STANDARD else x @ z


def test_rrrp_in_the_proximal_convention(catalogue: Mapping[str, Exercise]) -> None:
    # The in-class practice of Robotic Fundamentals has (a, α, d, θ) with α = 180° in row 3.
    reference = catalogue["rrrp"].robot.tables[Convention.MODIFIED]
    assert reference.labels == ("1", "2", "3", "4")
    texts = [tuple(cell.text() for cell in row) for row in reference.rows]
    assert texts == [
        ("0", "0", "l1", "q1"),
        ("l2", "0", "0", "q2"),
        ("l3", "180deg", "l4", "q3"),
        ("0", "0", "q4", "0"),
    ]


def test_planar_rrr_in_the_distal_convention(catalogue: Mapping[str, Exercise]) -> None:
    reference = catalogue["planar-rrr"].robot.tables[Convention.STANDARD]
    assert reference.labels == ("1", "2", "3")
    texts = [tuple(cell.text() for cell in row) for row in reference.rows]
    assert texts == [
        ("l1", "0", "0", "q1"),
        ("l2", "0", "0", "q2"),
        ("l3", "0", "0", "q3"),
    ]


@pytest.mark.long
@together("number", ["0", "1", "pi/2"])
@together("exercise_id", without_most_real_robots(WITH_TABLE))
def test_a_table_of_one_number_never_passes(
    exercise_id: str, number: str, catalogue: Mapping[str, Exercise]
) -> None:
    # This shows that the tests above for full marks can fail.
    exercise = catalogue[exercise_id]
    [spec] = [spec for spec in exercise.parts if isinstance(spec, DhTableSpec)]
    rows = exercise.robot.tables[exercise.robot.convention].rows
    report = part(handed_in(exercise, {spec.id: table([[number] * 4] * len(rows))}), spec.id)
    assert report.verdict in (Verdict.INCORRECT, Verdict.PARTIAL)
    assert report.points <= report.max_points * (0.75 if number == "0" else 0.5)


# --- The list of exercise files that the tests have checked


def test_the_list_has_the_shipped_exercises_as_they_are() -> None:
    assert dict(checked_digests()) == digests(), "an exercise has changed; run make pages"
