"""Test that equal formulas and spellings get equal reports."""

from collections.abc import Callable, Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Correction, PartReport, Verdict
from dh_grader.grading.report import messages_of

from tests.grading.support.robots import (
    EXACT,
    PLANAR_RRR,
    ROBOTS,
    RRRP,
    SCARA,
    STANFORD,
    AngleUnit,
    Robot,
)
from tests.grading.support.submitting import (
    cell,
    full_marks,
    graded_pose,
    graded_table,
    not_correct,
)

# --- An answer that equals the expected one is right, and any other answer is wrong

# Each test grades an answer many times. Each time, another cell is written differently with the
# same value, so that the grading draws new samples.

# The number of tries for each of the four robots.
TIMES = [25, pytest.param(500, marks=pytest.mark.campaign)]

# The poses in closed form; of the Stanford arm only the bottom row.
POSES: dict[str, tuple[tuple[str, ...], ...]] = {
    PLANAR_RRR.exercise: (
        ("c123", "-s123", "0", "l1 c1 + l2 c12 + l3 c123"),
        ("s123", "c123", "0", "l1 s1 + l2 s12 + l3 s123"),
        ("0", "0", "1", "0"),
        ("0", "0", "0", "1"),
    ),
    RRRP.exercise: (
        ("cos(q1+q2-q3)", "sin(q1+q2-q3)", "0", "l2 c1 + l3 c12"),
        ("sin(q1+q2-q3)", "-cos(q1+q2-q3)", "0", "l2 s1 + l3 s12"),
        ("0", "0", "-1", "l1 - l4 - q4"),
        ("0", "0", "0", "1"),
    ),
    SCARA.exercise: (
        ("cos(q1+q2-q4)", "sin(q1+q2-q4)", "0", "a1 c1 + a2 c12"),
        ("sin(q1+q2-q4)", "-cos(q1+q2-q4)", "0", "a1 s1 + a2 s12"),
        ("0", "0", "-1", "-d3 - d4"),
        ("0", "0", "0", "1"),
    ),
    STANFORD.exercise: (("0",) * 4, ("0",) * 4, ("0",) * 4, ("0", "0", "0", "1")),
}
ZERO = "sin(q1)^2 + cos(q1)^2 - 1"
# Some entries (row, column) of each pose that are 0 for all joint values.
ZEROS = {
    "planar-rrr": [(0, 2), (1, 2), (2, 0), (2, 3), (3, 1)],
    "rrrp": [(0, 2), (1, 2), (2, 0), (3, 0), (3, 2)],
    "scara": [(0, 2), (1, 2), (2, 1), (3, 1), (3, 2)],
    "stanford-arm": [(3, 0), (3, 1), (3, 2)],
}


def pose_with(exercise: str, text: str, time: int) -> list[list[object]]:
    matrix: list[list[object]] = [list(line) for line in POSES[exercise]]
    for i, j in ZEROS[exercise]:
        matrix[i][j] = text
    matrix[3][3] = f"{time} - {time - 1}"
    return matrix


@pytest.mark.long
@pytest.mark.parametrize("times", TIMES)
@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.exercise)
def test_a_zero_written_as_an_identity_is_always_right_in_a_pose(
    robot: Robot, times: int, catalogue: Mapping[str, Exercise], figure: Callable[[str], None]
) -> None:
    right = 0
    for time in range(times):
        report = graded_pose(catalogue[robot.exercise], pose_with(robot.exercise, ZERO, time))
        wrong = not_correct(report)
        right += not any((str(i + 1), str(j + 1)) in wrong for i, j in ZEROS[robot.exercise])
    figure(f"{robot.exercise}: {ZERO} for an expected 0 is right in {right} of {times} gradings")
    assert right == times


@pytest.mark.parametrize("times", TIMES)
@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.exercise)
def test_a_zero_written_as_an_identity_is_always_right_in_a_table(
    robot: Robot, times: int, catalogue: Mapping[str, Exercise]
) -> None:
    right = 0
    for time in range(times):
        rows = [[ZERO if text == "0" else text for text in row] for row in EXACT.rows(robot)]
        rows[0][3] = f"{robot.joints[0]} + {time} - {time}"
        right += not not_correct(graded_table(catalogue[robot.exercise], rows))
    assert right == times


@pytest.mark.sampled(4)
@pytest.mark.parametrize("times", TIMES)
@pytest.mark.parametrize("small", ["0.05", "1e-4", "-0.000002"])
@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.exercise)
def test_a_small_number_for_a_zero_is_always_wrong_in_a_pose(
    robot: Robot,
    small: str,
    times: int,
    catalogue: Mapping[str, Exercise],
    figure: Callable[[str], None],
) -> None:
    times = times if small == "0.05" else times // 5
    wrong = 0
    for time in range(times):
        report = graded_pose(catalogue[robot.exercise], pose_with(robot.exercise, small, time))
        found = not_correct(report)
        wrong += all(
            found.get((str(i + 1), str(j + 1))) is Verdict.INCORRECT
            for i, j in ZEROS[robot.exercise]
        )
    figure(f"{robot.exercise}: {small} for an expected 0 is wrong in {wrong} of {times} gradings")
    assert wrong == times


@pytest.mark.long
def test_a_small_number_beside_large_entries_is_always_wrong(
    catalogue: Mapping[str, Exercise],
) -> None:
    # Other entries that are a thousand times the robot's size do not widen the tolerance.
    exercise = catalogue[RRRP.exercise]
    for time in range(40):
        matrix = pose_with(RRRP.exercise, "0.05", time)
        matrix[0][3] = "1000000*l1"
        matrix[2][3] = "1000000"
        report = graded_pose(exercise, matrix)
        assert all(
            cell(report, str(i + 1), str(j + 1)).verdict is Verdict.INCORRECT
            for i, j in ZEROS[RRRP.exercise]
        )


@pytest.mark.parametrize(
    "text",
    [
        "cos(q2 - 2*pi)*l1 - l1*cos(q2)",
        "sin(2*q1) - 2*sin(q1)*cos(q1)",
        "tan(q2)*cos(q2) - sin(q2)",
        "c12 - c1 c2 + s1 s2",
        "(l1+l2)^2 - l1^2 - l2^2 - 2 l1 l2",
        "sqrt(l1^2) - abs(l1)",
        "atan2(sin(1), cos(1)) - 1",
        "1/3 + 1/3 + 1/3 - 1",
        "acos(cos(l1)) - l1",
        "1000000*(s1^2 + c1^2) - 1000000",
    ],
)
def test_identities_that_equal_zero_are_right(text: str, catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue[PLANAR_RRR.exercise]
    for time in range(20):
        matrix = pose_with(PLANAR_RRR.exercise, text, time)
        assert not_correct(graded_pose(exercise, matrix)) == {}


@pytest.mark.parametrize(
    "text", ["1e16", "1e17", "1e20", "1e300", "2*pi*1e20", "q1*1e17", "q1 + 1e18"]
)
@pytest.mark.parametrize("column", [1, 3])
def test_a_huge_number_of_turns_is_wrong(
    text: str, column: int, catalogue: Mapping[str, Exercise]
) -> None:
    # A number beyond 1e16 rad has no figures left for its direction, so it is wrong.
    rows = [list(row) for row in EXACT.rows(STANFORD)]
    for row in rows:
        row[column] = text
    report = graded_table(catalogue[STANFORD.exercise], rows)
    assert len(not_correct(report)) == len(rows), not_correct(report)


@pytest.mark.parametrize("turns", ["2*pi", "-360deg", "720°", "6*pi"])
def test_whole_turns_do_not_matter(turns: str, catalogue: Mapping[str, Exercise]) -> None:
    rows = [
        (a, f"{alpha} + {turns}", d, f"{theta} - {turns}")
        for a, alpha, d, theta in EXACT.rows(STANFORD)
    ]
    assert not_correct(graded_table(catalogue[STANFORD.exercise], rows)) == {}


# --- Corrections use the student's notation


def corrected(report: PartReport, row: str, column: str) -> Correction | None:
    """Return the correction of a cell."""
    [found] = [
        place.correction or message.correction
        for message, places, _ in messages_of(report)
        for place in places
        if (place.row, place.cell) == (row, column)
    ]
    return found


@pytest.mark.parametrize(
    ("wrong", "others", "unit", "text", "latex"),
    [
        ("pi/2", "pi/2", "radians", "-pi/2", r"-\frac{\pi}{2}"),
        ("π/2", "π/2", "radians", "-π/2", r"-\frac{\pi}{2}"),
        ("90°", "90°", "radians", "-90°", r"-90^{\circ}"),
        ("90deg", "90deg", "radians", "-90deg", r"-90^{\circ}"),
        ("90", "90", "degrees", "-90", r"-90^{\circ}"),
        ("90deg", "pi/2", "radians", "-90deg", r"-90^{\circ}"),
        ("90", "pi/2", "radians", "-90deg", r"-90^{\circ}"),
        ("0", "90°", "radians", "-90°", r"-90^{\circ}"),
        ("0", "pi/2", "radians", "-pi/2", r"-\frac{\pi}{2}"),
        ("1.5708", "1.5708", "radians", "-pi/2", r"-\frac{\pi}{2}"),
    ],
)
def test_a_corrected_angle_has_the_students_spelling(
    wrong: str, others: str, unit: AngleUnit, text: str, latex: str,
    given_frames: Mapping[str, Exercise],
) -> None:  # fmt: skip
    rows = [
        [cell.replace("pi/2", others).replace("90deg", others) for cell in row]
        for row in EXACT.rows(STANFORD)
    ]
    rows[0][1] = wrong
    report = graded_table(given_frames[STANFORD.exercise], rows, unit)
    assert corrected(report, "1", "alpha") == Correction(text, latex)
    rows[0][1] = text
    assert full_marks(graded_table(given_frames[STANFORD.exercise], rows, unit)) or "1.5" in others


@pytest.mark.parametrize(
    ("typed", "text", "latex"),
    [
        ("theta{}", "theta1", r"\theta_{1}"),
        ("q{}", "q1", "q_{1}"),
        ("θ{}", "θ1", r"\theta_{1}"),
        ("θ_{}", "θ_1", r"\theta_{1}"),
        (r"\theta_{}", "theta1", r"\theta_{1}"),
        ("q{}*", "q1", "q_{1}"),
    ],
)
def test_a_corrected_joint_variable_has_the_students_spelling(
    typed: str, text: str, latex: str, given_frames: Mapping[str, Exercise]
) -> None:
    rows = [list(row) for row in EXACT.rows(STANFORD)]
    for i in (0, 1, 3, 4, 5):
        rows[i][3] = typed.format(i + 1)
    rows[0][3] = "0"
    report = graded_table(given_frames[STANFORD.exercise], rows)
    assert corrected(report, "1", "theta") == Correction(text, latex)


def test_a_corrected_formula_has_the_students_spelling(catalogue: Mapping[str, Exercise]) -> None:
    for cosine, text in (("c12", "c12"), ("cos(q1 + q2)", "cos(q1 + q2)")):
        pose = [["0"] * 4 for _ in range(4)]
        pose[0][3] = f"l1*{cosine.replace('12', '1').replace(' + q2', '')} - l2*{cosine}"
        pose[0][3] += f" + l3*{cosine.replace('12', '123').replace('q2', 'q2 + q3')}"
        report = graded_pose(catalogue[PLANAR_RRR.exercise], pose)
        found = corrected(report, "1", "4")
        assert found is not None
        assert f"+ l2*{text} +" in found.text


def test_a_hint_uses_the_students_name_of_a_joint_variable(
    given_frames: Mapping[str, Exercise],
) -> None:
    rows = [list(row) for row in EXACT.rows(STANFORD)]
    rows[1][3] = "θ_1"
    report = graded_table(given_frames[STANFORD.exercise], rows)
    [message] = report.rows[1].cells[3].feedback
    assert "the cell contains θ_1, the variable of joint 1" in message.message
