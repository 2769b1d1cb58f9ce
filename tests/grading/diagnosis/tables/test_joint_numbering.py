"""Recognise joint numbers that differ from the expected ones."""

from collections.abc import Iterator, Mapping, Sequence

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.grading import PartReport, Verdict
from dh_grader.grading.diagnosis.table_readings import by_other_numbering
from dh_grader.grading.judging import Grading
from dh_grader.grading.kinds.tables import read_dh_table_answer
from dh_grader.grading.numbers import draw
from dh_grader.grading.reading.entries import Reader
from dh_grader.grading.report import messages_of
from dh_grader.learning import ModelTable, changes_of, model_table

from tests.grading.support.submitting import graded_table, handed_in, not_correct, table
from tests.grading.support.submitting import part as report_part
from tests.shipped import shipped_exercises
from tests.together import together

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


Rows = Sequence[Sequence[str]]
TABLES = [
    (exercise, part)
    for exercise in shipped_exercises().values()
    for part in exercise.parts
    if isinstance(part, DhTableSpec)
]


def right_table(exercise: Exercise, part: DhTableSpec) -> ModelTable:
    robot = exercise.robot
    convention = robot.convention if part.convention == "either" else part.convention
    return model_table(robot, convention, exercise.symbols)


def shifted(rows: Rows) -> Iterator[Rows]:
    """Yield the table with its rows moved, in all ways that students move them."""
    rows = list(rows)
    for blank in (["0"] * 4, [""] * 4):
        for count in range(1, len(rows)):
            yield [*[blank] * count, *rows[:-count]]
            yield [*rows[count:], *[blank] * count]
        for i in range(len(rows)):
            yield [*rows[:i], blank, *rows[i:]][: len(rows)]
            yield [*rows[:i], blank, *rows[i:]]
            yield [*rows[:i], *rows[i + 1 :], blank]
    for i in range(len(rows)):
        yield [*rows[:i], *rows[i + 1 :]]


def is_renumbered(exercise: Exercise, part: DhTableSpec, rows: Rows) -> bool:
    samples = draw(exercise, "")
    grading = Grading(exercise, samples, Reader.of(exercise, samples, "radians"))
    answer = read_dh_table_answer(part, table(rows), grading)
    assert answer is not None
    return by_other_numbering(answer, grading) is not None


@together(("exercise", "part"), TABLES)
def test_rows_that_begin_one_row_too_late_are_no_numbering(
    exercise: Exercise, part: DhTableSpec
) -> None:
    rows = right_table(exercise, part).texts
    assert not is_renumbered(exercise, part, [["0"] * 4, *rows[:-1]])


@pytest.mark.long
@together(("exercise", "part"), TABLES)
def test_rows_shifted_in_any_way_are_no_numbering(exercise: Exercise, part: DhTableSpec) -> None:
    for rows in shifted(right_table(exercise, part).texts):
        assert not is_renumbered(exercise, part, rows), rows


@pytest.mark.long
@pytest.mark.parametrize(
    ("exercise", "part"), TABLES[::4], ids=[each.id for each, _ in TABLES[::4]]
)
def test_a_report_on_shifted_rows_does_not_tell_a_numbering(
    exercise: Exercise, part: DhTableSpec
) -> None:
    rows = right_table(exercise, part).texts
    for blank in (["0"] * 4, [""] * 4):
        for answer in ([blank, *rows[:-1]], [*rows[1:], blank]):
            report = report_part(handed_in(exercise, {part.id: table(answer)}), part.id)
            codes = {message.code for message, _, _ in messages_of(report)}
            assert not codes & {"joint_numbering", "joint_numbering_by_kind"}


@together(("exercise", "part"), [each for each in TABLES if not each[1].given])
def test_joints_that_are_numbered_from_0_are_a_numbering(
    exercise: Exercise, part: DhTableSpec
) -> None:
    right = right_table(exercise, part)
    from_0, _ = changes_of("joint_numbering", right)
    rows = [list(each) for each in right.texts]
    for (i, j), text in from_0.items():
        rows[i][j] = text
    assert is_renumbered(exercise, part, rows)
    # A row that the student left empty does not hide the numbering.
    rows[1] = [""] * 4
    assert is_renumbered(exercise, part, rows)


def test_one_wrong_index_is_no_numbering(catalogue: Mapping[str, Exercise]) -> None:
    rows = [("a1", "0", "0", "theta0"), ("a2", "0", "0", "theta2")]
    report = graded_table(catalogue["planar-rr"], rows)
    assert error_codes(report) == ["joint_variable_absent"]
