"""Say where an axis points only if no earlier joint turns the axis."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading.diagnosis.slips_of_the_table import axis_direction
from dh_grader.grading.numbers import draw


@pytest.mark.parametrize(
    ("name", "joint", "words"),
    [
        ("planar-rrr", 3, "Its axis points along z0."),
        # After two turns about z0, the axes of the SCARA arm still point down.
        ("scara", 3, "Its axis points opposite to z0."),
        # Joint 3 slides along z0 at home, but the joints before it turn its axis.
        ("stanford-arm", 3, "Check which way its axis points."),
        ("spherical-wrist", 6, "Check which way its axis points."),
        ("spherical-wrist", 4, "Its axis points along z3."),
    ],
)
def test_the_direction_is_true_in_every_position(
    name: str, joint: int, words: str, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue[name]
    direction = axis_direction(exercise, draw(exercise, "").subset(1))
    [found] = [each for each in exercise.joints if each.index == joint]
    assert str(direction(found)) == words
