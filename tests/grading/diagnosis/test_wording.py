"""Test phrases that several kinds of messages contain."""

import pytest
from dh_grader.grading.misconception import axes_of_row


@pytest.mark.parametrize(
    ("label", "axes"),
    [
        ("1", "z0 and z1"),
        ("4", "z3 and z4"),
        ("e", "z6 and the last z axis"),
        ("e2", "the two z axes"),
        ("", "the two z axes"),
    ],
)
def test_the_axes_of_a_row_are_named(label: str, axes: str) -> None:
    assert axes_of_row("z", label, last=6) == axes
