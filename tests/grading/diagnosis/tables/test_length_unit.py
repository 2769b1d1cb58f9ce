"""Recognise tables whose lengths are in the wrong unit."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Submission, grade
from dh_grader.grading.report import PartReport, Verdict

# The lengths of the UR5e: a2, a3, d1, d4, d5 and d6.
METRES = (-0.425, -0.3922, 0.1625, 0.1333, 0.0997, 0.0996)


def table(lengths: tuple[float, ...], first_alpha: str = "90deg", sign: int = 1) -> str:
    a2, a3, d1, d4, d5, d6 = lengths
    return (
        "a, alpha, d, theta\n"
        f"0, {first_alpha}, {d1:.7g}, theta1\n{sign * a2:.7g}, 0, 0, theta2\n"
        f"{a3:.7g}, 0, 0, theta3\n0, 90deg, {d4:.7g}, theta4\n"
        f"0, -90deg, {d5:.7g}, theta5\n0, 0, {d6:.7g}, theta6\n"
    )


def graded(catalogue: Mapping[str, Exercise], text: str) -> PartReport:
    report = grade(catalogue["ur5e"], Submission({"table": text}))
    return next(part for part in report.parts if part.part == "table")


def codes(part: PartReport) -> set[str]:
    found = [*part.feedback]
    for row in part.rows:
        found += [*row.feedback, *(message for cell in row.cells for message in cell.feedback)]
    return {message.code for message in found}


@pytest.mark.parametrize("factor", [1000, 100, 0.001], ids=["mm", "cm", "km"])
def test_lengths_in_another_unit_are_one_mistake(
    catalogue: Mapping[str, Exercise], factor: float
) -> None:
    part = graded(catalogue, table(tuple(factor * each for each in METRES)))
    assert codes(part) == {"other_length_unit"}
    # A slip of the whole table costs a quarter.
    assert part.points == 0.75 * part.max_points
    wrong = [c.label for row in part.rows for c in row.cells if c.verdict is Verdict.INCORRECT]
    assert sorted(wrong) == ["a", "a", "d", "d", "d", "d"]


def test_another_slip_beside_the_unit_is_named(catalogue: Mapping[str, Exercise]) -> None:
    millimetres = tuple(1000 * each for each in METRES)
    turned = graded(catalogue, table(millimetres, "-90deg"))
    assert {"other_length_unit", "sign"} <= codes(turned)
    negated = graded(catalogue, table(millimetres, sign=-1))
    assert codes(negated) == {"other_length_unit", "sign"}
    assert negated.points < 0.75 * negated.max_points


def test_a_table_of_numbers_in_metres_has_no_other_unit(catalogue: Mapping[str, Exercise]) -> None:
    assert graded(catalogue, table(METRES)).verdict is Verdict.CORRECT
    # One length is ten times too large, and one is wrong.
    for wrong in ((-4.25, *METRES[1:]), (-0.5, *METRES[1:])):
        assert "other_length_unit" not in codes(graded(catalogue, table(wrong)))
