"""Test transforms, rotations, and other matrices."""

from collections.abc import Callable, Mapping
from typing import Any

import pytest
import sympy as sp
from dh_grader.catalogue import Exercise
from dh_grader.grading import Place, Verdict
from dh_grader.grading.report import messages_of

from tests.grading.support.robots import (
    A1,
    A3,
    A4,
    IDENTITY,
    LINKS,
    PLANAR_RRR,
    TABLE,
    a2_with,
    table,
    wrong_cells,
)
from tests.grading.support.robots import SCARA_EXERCISE as SCARA
from tests.grading.support.robots import graded as graded_links
from tests.grading.support.submitting import (
    SPATIAL_RRR,
    Make,
    all_codes,
    cell,
    codes_at,
    full_marks,
    graded,
    graded_pose,
    handed_in,
    not_correct,
    one_part,
    part,
)
from tests.together import together

# --- Grade transforms, inverse poses and home poses

# The planar RPR arm by product of exponentials.
RPR = [
    ["c13", "-s13", "0", "(L1 + theta2) c1 + L2 c13"],
    ["s13", "c13", "0", "(L1 + theta2) s1 + L2 s13"],
    ["0", "0", "1", "0"],
    ["0", "0", "0", "1"],
]
HOME = [[1, 0, 0, "L1 + L2"], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


@pytest.fixture
def rpr(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["planar-rpr-poe"]


def test_the_poses_of_the_lecture_are_right(rpr: Exercise) -> None:
    report = handed_in(rpr, {"home": HOME, "pose": RPR, "position": [RPR[0][3], RPR[1][3]]})
    for part_id in ("home", "pose", "position"):
        assert full_marks(part(report, part_id)), part(report, part_id)


# The exponentials of the planar RPR arm, by hand.
one, three = sp.symbols("theta1 theta3")
two, l1, l2 = sp.symbols("theta2 L1 L2")


def planar(angle: Any, x: Any, y: Any) -> Any:
    c, s = sp.cos(angle), sp.sin(angle)
    return sp.Matrix([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, 0], [0, 0, 0, 1]])


def about(angle: Any, x: Any) -> Any:
    # Return the turn about the axis along z through (x, 0, 0).
    return planar(angle, x - x * sp.cos(angle), -x * sp.sin(angle))


E1, E2, E3 = about(one, 0), planar(0, two, 0), about(three, l1)
M = planar(0, l1 + l2, 0)


def entries(matrix: Any) -> list[list[str]]:
    return [[str(matrix[i, j]) for j in range(4)] for i in range(4)]


def test_the_product_by_hand_is_right(rpr: Exercise) -> None:
    assert full_marks(part(handed_in(rpr, {"pose": entries(E1 * E2 * E3 * M)}), "pose"))


@pytest.mark.parametrize(
    ("matrix", "code"),
    [
        (M * E1 * E2 * E3, "home_on_wrong_side"),
        (E1 * E2 * E3, "missing_home"),
        (E3 * E2 * E1 * M, "reversed_product"),
        (E1 * E2 * about(three, -l1) * M, "moment_sign"),
    ],
)
def test_another_product_is_named(matrix: Any, code: str, rpr: Exercise) -> None:
    report = part(handed_in(rpr, {"pose": entries(matrix)}), "pose")
    assert all_codes(report) == {code}
    assert report.verdict is Verdict.PARTIAL


def test_a_transform_given_by_the_exercise_is_right(catalogue: Mapping[str, Exercise]) -> None:
    inverse = [
        ["cos(phi)", "sin(phi)", "0", "-px cos(phi) - py sin(phi)"],
        ["-sin(phi)", "cos(phi)", "0", "px sin(phi) - py cos(phi)"],
        ["0", "0", "1", "-pz"],
        ["0", "0", "0", "1"],
    ]
    exercise = catalogue["homogeneous-inverse"]
    assert full_marks(part(handed_in(exercise, {"about-z": inverse}), "about-z"))
    inverse[0][3], inverse[1][3] = "-px", "-py"
    report = part(handed_in(exercise, {"about-z": inverse}), "about-z")
    assert set(not_correct(report)) == {("1", "4"), ("2", "4")}
    not_inverted = [
        ["cos(phi)", "-sin(phi)", "0", "px"],
        ["sin(phi)", "cos(phi)", "0", "py"],
        ["0", "0", "1", "pz"],
        ["0", "0", "0", "1"],
    ]
    report = part(handed_in(exercise, {"about-z": not_inverted}), "about-z")
    assert all_codes(report) == {"inverse_transform"}


def test_the_inverse_of_a_robots_pose_is_right(make_exercise: Make) -> None:
    exercise = make_exercise(
        one_part("transform", 'from = 2\nto = "base"\nhome = true', SPATIAL_RRR)
    )
    # Frame 2 of the spatial RRR at home: x out, y up, z along −y0, at R + L1.
    answer = [[1, 0, 0, "-R - L1"], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]]
    assert full_marks(graded(exercise, answer))


def test_an_unexplained_product_is_reported_entry_by_entry(rpr: Exercise) -> None:
    report = part(handed_in(rpr, {"pose": entries(E1 * E2 * about(three, l2) * M)}), "pose")
    assert set(not_correct(report)) == {("1", "4"), ("2", "4")}
    assert all_codes(report).isdisjoint(
        {"home_on_wrong_side", "missing_home", "reversed_product", "moment_sign"}
    )


@pytest.mark.parametrize("first", ["0", "", None])
def test_a_pose_that_no_joint_moves_earns_nothing_with_an_empty_entry(
    catalogue: Mapping[str, Exercise], first: str | None
) -> None:
    # The tool points down, which is the only constant in the rotation of the RRRP arm.
    pose = [[first, 0, 0, 0], [0, 0, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]
    report = part(handed_in(catalogue["rrrp"], {"pose": pose}), "pose")
    assert "no_joint_variable" in {message.code for message in report.feedback}
    assert report.points == 0


# --- Grade rotation matrices

phi, theta, psi = sp.symbols("phi theta psi")


def turn(axis: str, angle: Any) -> Any:
    """Return the elementary rotation about an axis."""
    # Source: *Direct Kinematics (Part 2)*, §1.4.
    c, s = sp.cos(angle), sp.sin(angle)
    return {
        "x": sp.Matrix([[1, 0, 0], [0, c, -s], [0, s, c]]),
        "y": sp.Matrix([[c, 0, s], [0, 1, 0], [-s, 0, c]]),
        "z": sp.Matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]]),
    }[axis]


def rotation_entries(matrix: Any) -> list[list[str]]:
    return [[str(matrix[i, j]) for j in range(3)] for i in range(3)]


Z, X, Y = turn("z", phi), turn("x", theta), turn("y", psi)
COMPOSITES = {"fixed": Y * X * Z, "mobile": Z * X * Y, "mixed": Y * Z * X}


@pytest.mark.parametrize("axis", "xyz")
def test_the_fundamental_rotations_are_right(axis: str, catalogue: Mapping[str, Exercise]) -> None:
    part_id = f"about-{axis}"
    answers = {part_id: rotation_entries(turn(axis, phi))}
    assert full_marks(part(handed_in(catalogue["fundamental-rotations"], answers), part_id))
    back = part(
        handed_in(
            catalogue["fundamental-rotations"], {part_id: rotation_entries(turn(axis, -phi))}
        ),
        part_id,
    )
    assert back.verdict is Verdict.PARTIAL
    assert all_codes(back) == {"turn_sign"}


@pytest.mark.parametrize("part_id", COMPOSITES)
def test_the_composite_rotations_are_right(part_id: str, catalogue: Mapping[str, Exercise]) -> None:
    answers = {part_id: rotation_entries(COMPOSITES[part_id])}
    assert full_marks(part(handed_in(catalogue["composite-rotations"], answers), part_id))


@pytest.mark.parametrize(
    ("part_id", "matrix", "code", "said"),
    [
        ("fixed", Z * X * Y, "fixed_for_moving_axes", "Every turn"),
        ("mobile", Y * X * Z, "fixed_for_moving_axes", "Every turn"),
        ("mixed", Z * X * Y, "fixed_for_moving_axes", "Turn 3"),
        ("fixed", Y * turn("x", -theta) * Z, "turn_sign", "Turn 2"),
        ("fixed", Y * turn("z", theta) * Z, "turn_axis", "Turn 2"),
        ("mobile", turn("y", phi) * X * Y, "turn_axis", "Turn 1"),
        ("mobile", Z * X, "missing_turn", "Turn 3"),
    ],
)
def test_a_wrong_composition_is_named(
    part_id: str, matrix: Any, code: str, said: str, catalogue: Mapping[str, Exercise]
) -> None:
    answers = {part_id: rotation_entries(matrix)}
    report = part(handed_in(catalogue["composite-rotations"], answers), part_id)
    [message] = report.feedback
    assert (message.code, said in message.message) == (code, True)
    assert all_codes(report) == {code}


def test_a_slip_in_one_entry_is_named_there(catalogue: Mapping[str, Exercise]) -> None:
    matrix = rotation_entries(COMPOSITES["fixed"])
    matrix[2][0] = f"-({matrix[2][0]})"
    report = part(handed_in(catalogue["composite-rotations"], {"fixed": matrix}), "fixed")
    assert not_correct(report) == {("3", "1"): Verdict.INCORRECT}
    assert "sign" in all_codes(report)


# Robotic Fundamentals (UMFM4X-15-M), Forward Kinematics, Example 3.
SPATIAL = [["c1 c23", "-c1 s23", "s1"], ["s1 c23", "-s1 s23", "-c1"], ["s23", "c23", "0"]]


def test_the_rotation_of_a_robot_is_right(make_exercise: Make) -> None:
    exercise = make_exercise(one_part("rotation", "", SPATIAL_RRR))
    assert full_marks(graded(exercise, SPATIAL))
    transposed = [list(column) for column in zip(*SPATIAL, strict=True)]
    assert all_codes(graded(exercise, transposed)) == {"transposed_rotation"}


def test_the_rotation_between_two_frames_is_right(make_exercise: Make) -> None:
    exercise = make_exercise(one_part("rotation", "from = 1\nto = 2", SPATIAL_RRR))
    assert full_marks(graded(exercise, [["c2", "-s2", 0], ["s2", "c2", 0], [0, 0, 1]]))
    back = make_exercise(one_part("rotation", 'from = "tool"\nto = "base"', SPATIAL_RRR))
    transposed = [list(column) for column in zip(*SPATIAL, strict=True)]
    assert full_marks(graded(back, transposed))


@pytest.mark.parametrize("answer", [[], "", [[1] * 3] * 4, {"rows": []}, 7])
def test_an_answer_of_another_shape_is_unreadable(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(one_part("rotation", "", SPATIAL_RRR)), answer)
    assert report.points == 0
    assert report.verdict in (Verdict.UNREADABLE, Verdict.MISSING)


# --- Grade matrices of any size

MATRIX = one_part("matrix", 'expected = [["1", "l", "phi"], ["k^2", "sin(phi)", "0"]]')


def test_a_matrix_of_any_size_is_graded(make_exercise: Make) -> None:
    exercise = make_exercise(MATRIX)
    assert full_marks(graded(exercise, [[1, "l", "phi"], ["k*k", "sin phi", 0]]))
    assert full_marks(graded(exercise, "[1 l phi; k^2 sin(phi) 0]"))
    report = graded(exercise, [[1, "l", "-phi"], ["k", "sin phi", 0]])
    assert set(not_correct(report)) == {("1", "3"), ("2", "1")}
    # Five entries are not 0. They are worth 1.25 points each, the last one 1. Two are wrong.
    assert report.points == 6 - 2 * 1.25


@pytest.mark.parametrize("answer", [[[1, 2, 3]] * 3, [], 4, [["1"]] * 2])
def test_a_matrix_of_the_wrong_size_is_unreadable(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(MATRIX), answer)
    assert (report.verdict, report.points) == (Verdict.UNREADABLE, 0)


def test_the_chain_of_rigid_motions(catalogue: Mapping[str, Exercise]) -> None:
    # Source: Robot kinematics lecture notes, equations 2.13 to 2.15, multiplied out by hand.
    c, s, ct, st = "cos(phi)", "sin(phi)", "cos(theta)", "sin(theta)"
    rotation: list[list[Any]] = [
        [c, f"-{s}*{ct}", f"{s}*{st}"],
        [s, f"{c}*{ct}", f"-{c}*{st}"],
        [0, st, ct],
    ]
    origin = [f"l1 - l2*{s}", f"l2*{c}", "h"]
    answers: dict[str, Any] = {
        "rotation": rotation,
        "origin": origin,
        "transform": [[*row, d] for row, d in zip(rotation, origin, strict=True)] + [[0, 0, 0, 1]],
        "point": [f"{d} + l3*({row[2]})" for row, d in zip(rotation, origin, strict=True)],
        "parallel-axes": [[1, 0, 0], [0, 0, -1], [0, 1, 0]],
    }
    report = handed_in(catalogue["rigid-motion-chain"], answers)
    for part_id in answers:
        assert full_marks(part(report, part_id)), part(report, part_id)
    literal = {"parallel-axes": [[1, 0, 0], [0, 0, 1], [0, 1, 0]]}
    misread = part(handed_in(catalogue["rigid-motion-chain"], literal), "parallel-axes")
    assert "left_handed_rotation" in all_codes(misread)


# --- Grade link transforms, also in the frames of the student's own table


@pytest.fixture
def scara(make_exercise: Callable[[str], Exercise]) -> Exercise:
    return make_exercise(SCARA)


def test_the_printed_link_transforms_are_right(scara: Exercise) -> None:
    parts = graded_links(scara, table=table(TABLE), links=LINKS)
    assert parts["links"].verdict is Verdict.CORRECT
    assert parts["links"].points == 8
    assert not parts["links"].follow_through
    assert [row.label for row in parts["links"].rows][:5] == [
        "A1.1",
        "A1.2",
        "A1.3",
        "A1.4",
        "A2.1",
    ]


def test_links_are_graded_in_the_frames_of_the_table(scara: Exercise) -> None:
    # The student's z2 points up, so that α2 is 0, α3 is 180°, and row 3 has −d3.
    own = [TABLE[0], ("a2", "0", "0", "q2"), ("0", "pi", "-d3", "0"), TABLE[3]]
    own_links = [
        A1,
        [["c2", "-s2", "0", "a2*c2"], ["s2", "c2", "0", "a2*s2"], *A1[2:]],
        [list("1000"), ["0", "-1", "0", "0"], ["0", "0", "-1", "-d3"], list("0001")],
        A4,
    ]
    assert graded_links(scara, table=table(own), links=own_links)["links"].points == 8
    assert graded_links(scara, links=own_links)["links"].points == 8
    in_other_frames = graded_links(scara, table=table(own), links=LINKS)["links"]
    assert in_other_frames.points < 8
    assert {row.split(".")[0] for row, _ in wrong_cells(in_other_frames)} == {"A2", "A3"}


def test_without_a_table_a_wrong_matrix_is_named(scara: Exercise) -> None:
    part = graded_links(scara, links=[A1, a2_with("a1"), A3, A4])["links"]
    assert wrong_cells(part) == {("A2.1", "4"), ("A2.2", "4")}


def test_an_omitted_matrix_is_missing_and_others_are_graded(scara: Exercise) -> None:
    part = graded_links(scara, table=table(TABLE), links=LINKS[:3])["links"]
    assert {row for row, _ in wrong_cells(part)} == {"A4.1", "A4.2", "A4.3", "A4.4"}
    # The entries that differ from the joint's motion: 2 of A1, 5 of A2, 0 of A3 and 1 of A4. With a
    # fifth for each matrix these are 8.8 units of 0.91 points; 8 - 8 * 0.91 = 4 * 0.18 are left.
    assert part.points == pytest.approx(8 - (0.91 + 0.18))


@pytest.mark.parametrize(
    "long", [[*A4, list("0000")], [list("0000")] * 40, [list("00000")] * 4, [], None, 5, {}]
)
def test_a_matrix_of_the_wrong_size_affects_only_itself(scara: Exercise, long: object) -> None:
    part = graded_links(scara, table=table(TABLE), links=[*LINKS[:3], long])["links"]
    assert {row for row, _ in wrong_cells(part)} == {"A4.1", "A4.2", "A4.3", "A4.4"}
    # As without the fourth matrix.
    assert part.points == pytest.approx(8 - (0.91 + 0.18))


@pytest.mark.parametrize("answer", [5, "x", {}, [5], [[["1"]] * 9], [IDENTITY] * 5, [[]], [5] * 4])
def test_an_answer_without_matrices_is_unreadable(scara: Exercise, answer: object) -> None:
    part = graded_links(scara, links=answer)["links"]
    assert part.verdict is Verdict.UNREADABLE
    assert part.points == 0


@pytest.mark.parametrize("first", ["0", "", None])
def test_links_that_no_joint_moves_earn_nothing_with_an_empty_entry(
    catalogue: Mapping[str, Exercise], first: str | None
) -> None:
    # The third row of a standard link is (0, sin α, cos α, d); α is -90°, 90°, 0, -90°, 90°, 0.
    thirds = [(-1, 0), (1, 0), (0, 1)] * 2
    links: list[Any] = [
        [[0] * 4, [0] * 4, [0, sine, cosine, 0], [0, 0, 0, 1]] for sine, cosine in thirds
    ]
    report = graded_links(
        catalogue["stanford-arm"], links=[[[first, 0, 0, 0], *links[0][1:]], *links[1:]]
    )
    assert "no_joint_variable" in {message.code for message in report["links"].feedback}
    assert report["links"].points == 0


# --- Grade matrices entry by entry

POSE = [
    ["c123", "-s123", "0", "l1 c1 + l2 c12 + l3 c123"],
    ["s123", "c123", "0", "l1 s1 + l2 s12 + l3 s123"],
    ["0", "0", "1", "0"],
    ["0", "0", "0", "1"],
]


@pytest.fixture
def arm(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue[PLANAR_RRR.exercise]


def with_entry(i: int, j: int, text: object) -> list[list[object]]:
    matrix: list[list[object]] = [list(line) for line in POSE]
    matrix[i][j] = text
    return matrix


PLACES = [(i, j) for i in range(4) for j in range(4)]


@together(("i", "j"), PLACES)
@together(
    ("text", "verdict", "code"),
    [
        ("0.05", Verdict.INCORRECT, "value"),
        ("q1 + l1", Verdict.INCORRECT, "quantity"),
        ("sqrt(-1)", Verdict.INCORRECT, "undefined"),
        ("c124", Verdict.UNREADABLE, "not_revolute"),
        ("(c1", Verdict.UNREADABLE, "unbalanced_bracket"),
        ("", Verdict.MISSING, "missing"),
        (None, Verdict.MISSING, "missing"),
        (["0"], Verdict.UNREADABLE, "wrong_type"),
        (True, Verdict.UNREADABLE, "wrong_type"),
    ],
)
def test_a_bad_entry_affects_only_itself(
    i: int, j: int, text: object, verdict: Verdict, code: str, arm: Exercise
) -> None:
    report = graded_pose(arm, with_entry(i, j, text))
    place = (str(i + 1), str(j + 1))
    assert not_correct(report) == {place: verdict}
    # Four entries of the rotation and two of the position differ from the identity; each half is
    # worth 4 points. A wrong or empty entry costs a unit. In the bottom row, it costs a fifth: 0.2
    # and 0.4 points, in quarters; so does an unread entry that is no content cell.
    known = POSE[i][j] not in ("0", "1")
    unit, fifth = (2.0, 0.5) if j == 3 else (1.0, 0.25)
    is_cheap = i == 3 or (verdict is Verdict.UNREADABLE and not known)
    cost = fifth if is_cheap else unit
    assert report.points == report.max_points - cost
    assert sum(row.points for row in report.rows) == pytest.approx(report.points, abs=1e-5)
    if i == 3 and verdict is Verdict.INCORRECT and code != "undefined":
        code = "bottom_row"
    elif code == "value" and known:
        code = "independent_of"
    elif code == "quantity" and POSE[i][j] == "0":
        # An expected 0 fits every quantity: the message is on the joint variable.
        code = "joint_variable_extra"
    assert (code, (Place(*place),)) in [(m.code, places) for m, places, _ in messages_of(report)]


SLIPS = [
    (0, 3, "l1 c1 + l2 c2 + l3 c3"),
    (0, 3, "l1 s1 + l2 s12 + l3 s123"),
    (0, 3, "l1 c1 + l2 c12"),
    (0, 3, "l1 c1 + l2 c12 - l3 c123"),
    (1, 3, "-(l1 s1 + l2 s12 + l3 s123)"),
    (0, 0, "c1 c2 c3"),
    (0, 0, "c1 + c2 + c3"),
    (0, 0, "s123"),
    (0, 1, "s123"),
    (2, 2, "-1"),
    (3, 3, "0"),
    (3, 3, "2"),
    (2, 3, "l1"),
]


@pytest.mark.parametrize(("i", "j", "text"), SLIPS)
def test_a_slip_in_an_entry_is_named(i: int, j: int, text: str, arm: Exercise) -> None:
    report = graded_pose(arm, with_entry(i, j, text))
    assert not_correct(report) == {(str(i + 1), str(j + 1)): Verdict.INCORRECT}
    codes_said = {m.code for m in (*report.rows[i].cells[j].feedback, *report.feedback)}
    assert codes_said
    negated = f"-({POSE[i][j]})".replace("-(-s123)", "s123").replace("-(1)", "-1")
    assert ("sign" in codes_said) is (text == negated)


def test_a_whole_matrix_of_unreadable_entries_is_not_gradable(arm: Exercise) -> None:
    report = graded_pose(arm, [["?"] * 4] * 4)
    assert report.verdict is Verdict.UNREADABLE
    assert [row.verdict for row in report.rows] == [Verdict.UNREADABLE] * 4


def test_three_rows_leave_the_fourth_missing(arm: Exercise) -> None:
    # The missing bottom row of a 3×4 matrix is reported; the other rows are graded.
    report = graded_pose(arm, POSE[:3])
    assert [row.verdict for row in report.rows] == [Verdict.CORRECT] * 3 + [Verdict.MISSING]
    # The row has no content cell, so that it costs a fifth of a unit in each half.
    assert report.points == 8 - (0.25 + 0.5)
    assert report.verdict is Verdict.PARTIAL


@pytest.mark.parametrize("entries", [["0", "0", "0"], ["0"] * 5, "0 0 0 1", 1, {"1": "0"}])
def test_a_row_of_the_wrong_length_affects_only_itself(entries: object, arm: Exercise) -> None:
    report = graded_pose(arm, [*POSE[:3], entries])
    assert [row.verdict for row in report.rows] == [Verdict.CORRECT] * 3 + [Verdict.UNREADABLE]
    assert codes_at(report, "4", "1") == ["row_length"]


@pytest.mark.parametrize("matrix", [[*POSE, ["0", "0", "0", "1"]], [[*line, "0"] for line in POSE]])
def test_a_fifth_row_or_column_is_refused(matrix: object, arm: Exercise) -> None:
    report = graded_pose(arm, matrix)
    assert report.verdict is Verdict.UNREADABLE
    assert report.points == 0


def test_numbers_need_not_be_text(arm: Exercise) -> None:
    matrix = [[int(text) if text in ("0", "1") else text for text in line] for line in POSE]
    assert full_marks(graded_pose(arm, matrix))


def test_a_counterexample_shows_the_students_own_number(arm: Exercise) -> None:
    report = graded_pose(arm, with_entry(2, 3, "2 l1"))
    [feedback] = cell(report, "3", "4").feedback
    assert feedback.values is not None
    assert set(feedback.values) == {"l1", "yours", "expected"}
    assert feedback.values["expected"] == 0
    assert feedback.values["yours"] == pytest.approx(2 * float(feedback.values["l1"]), abs=2e-3)


def test_an_undefined_entry_is_shown_with_its_joint_values(arm: Exercise) -> None:
    report = graded_pose(arm, with_entry(0, 0, "sqrt(q1) + l2"))
    [feedback] = cell(report, "1", "1").feedback
    assert feedback.code == "undefined"
    assert feedback.values is not None
    assert set(feedback.values) == {"q1", "l2"}
    assert float(feedback.values["q1"]) < 0
    assert f"q1 = {feedback.values['q1']:g}" in feedback.message
