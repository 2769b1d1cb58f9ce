"""Read joint variables with a star, such as θ1*."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Verdict

from tests.grading.support.submitting import cell, codes, graded_pose, graded_table


@pytest.fixture
def scara(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["scara"]


@pytest.mark.parametrize(
    ("d", "told"),
    [
        ("d3*", []),
        ("d3* + d4", []),
        ("d3*+d4", []),
        ("d3* - d4", ["marker_or_product"]),
        ("d3*-d4", ["marker_or_product"]),
        ("d3*+s1", ["joint_marker"]),
        ("a1*d3*+d4", ["ambiguous_star"]),
        ("a1*d3*", ["trailing_operator"]),
    ],
)
def test_in_a_table(d: str, told: list[str], scara: Exercise) -> None:
    rows = [("a1", "0", "0", "theta1"), ("a2", "180deg", "0", "theta2"), ("0", "0", d, "0")]
    found = set(codes(cell(graded_table(scara, rows), "3", "d")))
    stars = {"joint_marker", "marker_or_product", "ambiguous_star", "trailing_operator"}
    assert found & stars == set(told)


@pytest.mark.parametrize(
    ("entry", "verdict", "told"),
    [
        ("d3*+s1", Verdict.INCORRECT, "joint_marker"),
        ("theta1*-pi/2", Verdict.INCORRECT, "marker_or_product"),
        ("c1*d3*+s1", Verdict.UNREADABLE, "ambiguous_star"),
    ],
)
def test_in_a_matrix(entry: str, verdict: Verdict, told: str, scara: Exercise) -> None:
    pose = [[entry, "0", "0", "0"], ["0"] * 4, ["0"] * 4, ["0", "0", "0", "1"]]
    found = cell(graded_pose(scara, pose), "1", "1")
    assert found.verdict is verdict
    assert told in codes(found)
