"""Recognise joint numbers that differ from the expected ones."""

from collections.abc import Mapping, Sequence

import pytest

from service.catalogue import Exercise
from service.grading import PartReport, Verdict
from service.grading.report import messages_of
from tests.grading.support.submitting import graded_table, not_correct

STANFORD = [
    ("0", "-90deg", "0"), ("0", "90deg", "d2"), ("0", "0", "d3"),
    ("0", "-90deg", "0"), ("0", "90deg", "0"), ("0", "0", "d6"),
]  # fmt: skip


def stanford(*theta: str, d3: str = "d3") -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = [
        (*row, angle) for row, angle in zip(STANFORD, theta, strict=True)
    ]
    rows[2] = ("0", "0", d3, theta[2])
    return rows


RRRP = [("l2", "0", "l1"), ("l3", "180deg", "0"), ("0", "0", "l4")]
WRIST = [("0", "-90deg", "0"), ("0", "90deg", "0"), ("0", "0", "d6")]

# The exercise, the table, the code, and the only cells that are not correct.
CASES: dict[str, tuple[str, Sequence[Sequence[str]], str, set[tuple[str, str]]]] = {
    "from 0": (
        "spatial-rrr",
        [("R", "90deg", "0", "theta0"), ("L1", "0", "0", "theta1"), ("L2", "0", "0", "theta2")],
        "joint_numbering",
        {("1", "theta"), ("2", "theta"), ("3", "theta")},
    ),
    "from 0, one of them slides": (
        "rrrp",
        [(*row, f"q{i}") for i, row in enumerate(RRRP)] + [("0", "0", "q3", "0")],
        "joint_numbering",
        {("1", "theta"), ("2", "theta"), ("3", "theta"), ("4", "d")},
    ),
    "from 0, with stars": (
        "rrrp",
        [(*row, f"θ{i}*") for i, row in enumerate(RRRP)] + [("0", "0", "d3*", "0")],
        "joint_numbering",
        {("1", "theta"), ("2", "theta"), ("3", "theta"), ("4", "d")},
    ),
    "the wrist from 1": (
        "spherical-wrist",
        [(*row, f"theta{i + 1}") for i, row in enumerate(WRIST)],
        "joint_numbering",
        {("4", "theta"), ("5", "theta"), ("6", "theta")},
    ),
    "the wrist from 3": (
        "spherical-wrist",
        [(*row, f"theta{i + 3}") for i, row in enumerate(WRIST)],
        "joint_numbering",
        {("4", "theta"), ("5", "theta"), ("6", "theta")},
    ),
    "turning joints by themselves": (
        "stanford-arm",
        stanford("theta1", "theta2", "0", "theta3", "theta4", "theta5"),
        "joint_numbering_by_kind",
        {("4", "theta"), ("5", "theta"), ("6", "theta")},
    ),
    "turning and sliding joints by themselves": (
        "stanford-arm",
        stanford("theta1", "theta2", "0", "theta3", "theta4", "theta5", d3="d1"),
        "joint_numbering_by_kind",
        {("3", "d"), ("4", "theta"), ("5", "theta"), ("6", "theta")},
    ),
    "the last joint of SCARA": (
        "scara",
        [("a1", "0", "0", "q1"), ("a2", "pi", "0", "q2"), ("0", "0", "d3", "0"),
         ("0", "0", "d4", "theta3")],
        "joint_numbering_by_kind",
        {("4", "theta")},
    ),
}  # fmt: skip


def error_codes(report: PartReport) -> list[str]:
    return [message.code for message, _, _ in messages_of(report) if message.severity == "error"]


@pytest.mark.parametrize("case", CASES)
def test_another_numbering_gets_one_message_with_its_places(
    catalogue: Mapping[str, Exercise], case: str
) -> None:
    exercise, rows, code, cells = CASES[case]
    report = graded_table(catalogue[exercise], rows)
    assert error_codes(report) == [code]
    assert not_correct(report) == dict.fromkeys(cells, Verdict.INCORRECT)
    [message] = [message for message in report.feedback if message.code == code]
    assert {(place.row, place.cell) for place in message.places or ()} == cells


def test_another_numbering_costs_a_quarter(catalogue: Mapping[str, Exercise]) -> None:
    exercise, rows, *_ = CASES["from 0"]
    report = graded_table(catalogue[exercise], rows)
    assert report.points == 0.75 * report.max_points


def test_another_slip_costs_points_and_is_named(catalogue: Mapping[str, Exercise]) -> None:
    rows = stanford("theta1", "theta2", "0", "theta3", "theta4", "theta5")
    alone = graded_table(catalogue["stanford-arm"], rows)
    rows[3] = ("0", "90deg", "0", "theta3")
    both = graded_table(catalogue["stanford-arm"], rows)
    assert sorted(error_codes(both)) == ["joint_numbering_by_kind", "sign"]
    assert both.points < alone.points


def test_the_first_joint_has_the_name_that_the_student_uses(
    catalogue: Mapping[str, Exercise],
) -> None:
    rows = [("R", "90°", "0", "q0"), ("L1", "0", "0", "q1"), ("L2", "0", "0", "q2")]
    [message] = graded_table(catalogue["spatial-rrr"], rows).feedback
    assert "from 0" in message.message
    assert message.message.endswith("is q1.")


@pytest.mark.parametrize(
    "angles",
    [
        ("theta2", "theta1", "theta3"),
        ("theta1", "theta1", "theta3"),
        ("theta0", "theta2", "theta3"),
    ],
)
def test_other_wrong_variables_are_no_numbering(
    catalogue: Mapping[str, Exercise], angles: tuple[str, ...]
) -> None:
    rows = [("R", "90deg", "0"), ("L1", "0", "0"), ("L2", "0", "0")]
    report = graded_table(
        catalogue["spatial-rrr"], [(*row, angle) for row, angle in zip(rows, angles, strict=True)]
    )
    assert "joint_numbering" not in error_codes(report)
    assert report.points < report.max_points


def test_a_lazy_table_gains_nothing_by_another_numbering(catalogue: Mapping[str, Exercise]) -> None:
    lazy = [("0", "0", "0", f"theta{i}") for i in range(3)]
    usual = [("0", "0", "0", f"theta{i + 1}") for i in range(3)]
    exercise = catalogue["spatial-rrr"]
    assert graded_table(exercise, lazy).points <= graded_table(exercise, usual).points
