"""Choose the convention of a table if the exercise allows both."""

from collections.abc import Callable, Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport, Severity, Verdict

from tests.grading.support.submitting import full_marks, handed_in, not_correct, part, table

ANTHROPOMORPHIC = """
title = "Anthropomorphic arm"
source = "Siciliano et al., Robotics, 2.9.3"
statement = "Frames are free."
[robot]
structure = "RRR"
convention = "standard"
joints = ["theta1", "theta2", "theta3"]
table = [
    ["0", "90deg", "0", "theta1"], ["a2", "0", "0", "theta2"], ["a3", "0", "0", "theta3"],
]
[symbols]
a2 = { kind = "length", description = "first link" }
a3 = { kind = "length", description = "second link" }
[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
convention = "either"
frames = "FRAMES"
"""
STANDARD = [
    ("0", "90deg", "0", "theta1"),
    ("a2", "0", "0", "theta2"),
    ("a3", "0", "0", "theta3"),
]
# Converted by hand: the columns a and alpha are one row lower, and the last row is fixed.
MODIFIED = [
    ("0", "0", "0", "theta1"),
    ("0", "90deg", "0", "theta2"),
    ("a2", "0", "0", "theta3"),
    ("a3", "0", "0", "0"),
]


def pasted(rows: list[tuple[str, ...]]) -> str:
    return "\n".join(map(", ".join, [("a", "alpha", "d", "theta"), *rows]))


@pytest.fixture(params=["given", "free"])
def arm(request: pytest.FixtureRequest, make_exercise: Callable[[str], Exercise]) -> Exercise:
    return make_exercise(ANTHROPOMORPHIC.replace("FRAMES", request.param))


def graded(exercise: Exercise, answer: object) -> PartReport:
    return part(handed_in(exercise, {"table": answer}), "table")


def taken(report: PartReport) -> list[str]:
    found = [each for each in report.feedback if each.code == "convention_taken"]
    assert all(each.severity is Severity.INFO for each in found)
    return [name for each in found for name in ("standard", "modified") if name in each.message]


@pytest.mark.parametrize(("rows", "name"), [(STANDARD, "standard"), (MODIFIED, "modified")])
def test_the_convention_that_fits_is_chosen_and_named(
    rows: list[tuple[str, ...]], name: str, arm: Exercise
) -> None:
    for answer in (table(rows), pasted(rows), {"rows": pasted(rows)}):
        report = graded(arm, answer)
        assert full_marks(report)
        assert taken(report) == [name]
        slip = [*rows[:-1], ("2*a3", *rows[-1][1:])]
        wrong = graded(arm, table(slip))
        assert list(not_correct(wrong)) == [("3" if name == "standard" else "e", "a")]
        assert taken(wrong) == [name]


def test_a_tie_is_judged_in_the_convention_of_the_reference(arm: Exercise) -> None:
    assert taken(graded(arm, table([("7", "7", "7", "7")] * 3))) == ["standard"]


def test_a_named_convention_is_used(arm: Exercise) -> None:
    report = graded(arm, {**table(MODIFIED), "convention": "standard"})
    assert report.verdict is not Verdict.CORRECT
    assert taken(report) == []
    assert full_marks(graded(arm, {**table(MODIFIED), "convention": "modified"}))


def test_a_script_names_its_convention(arm: Exercise) -> None:
    links = [f"Link([0 {d} {a} {alpha.replace('90deg', 'pi/2')}])" for a, alpha, d, _ in STANDARD]
    report = graded(arm, f"SerialLink([{' '.join(links)}])")
    assert full_marks(report)
    assert taken(report) == []
    modified = {"rows": f"SerialLink([{' '.join(links)}])", "convention": "modified"}
    assert not full_marks(graded(arm, modified))


def test_a_part_with_a_fixed_convention_chooses_none(catalogue: Mapping[str, Exercise]) -> None:
    rows = [("a1", "0", "0", "theta1"), ("a2", "0", "0", "theta2")]
    assert taken(graded(catalogue["planar-rr"], table(rows))) == []
