"""How far a cell may be off, and that a student cannot widen it."""

from collections.abc import Mapping

from service.catalogue import Exercise
from tests.grading.support.submitting import graded_table


def test_an_offset_of_one_s_own_does_not_widen_the_tolerance(
    catalogue: Mapping[str, Exercise],
) -> None:
    """Along parallel axes any offset may be written, but not to be lost in its own rounding."""
    for first, second in (("1000.0", "-999.5"), ("5.0", "-4.996"), ("5000.0", "-5000.0 + a1")):
        rows = [["a1", "0", first, "theta1"], ["a2", "0", second, "theta2"]]
        report = graded_table(catalogue["planar-rr"], rows)
        assert report.points < report.max_points
    exact = [["a1", "0", "1000.0", "theta1"], ["a2", "0", "-1000.0", "theta2"]]
    report = graded_table(catalogue["planar-rr"], exact)
    assert report.points == report.max_points
