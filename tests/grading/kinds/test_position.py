"""Positions, vectors and matrices of other sizes: shapes, angles, and what is said of slips."""

from collections.abc import Callable, Mapping
from typing import Any

import pytest

from service.catalogue import Exercise
from service.grading import Verdict
from tests.grading.exercise_texts import SPATIAL_RRR, graded, one_part, told
from tests.grading.submitting import cell, full_marks, handed_in, not_correct, part

Make = Callable[[str], Exercise]

# Robotic Fundamentals (UMFM4X-15-M), Forward Kinematics, Example 3.
SPATIAL = ["c1 (L2 c23 + L1 c2 + R)", "s1 (L2 c23 + L1 c2 + R)", "L2 s23 + L1 s2"]
POSITION = one_part("position", "", SPATIAL_RRR)


@pytest.mark.parametrize(
    "answer",
    [
        SPATIAL,
        [[text] for text in SPATIAL],
        [SPATIAL],
        "c1*(L2*c23+L1*c2+R)\ns1*(L2*c23+L1*c2+R)\nL2*s23+L1*s2",
        "[c1*(L2*c23+L1*c2+R), s1*(L2*c23+L1*c2+R), L2*s23+L1*s2]",
    ],
)
def test_a_position_in_each_shape(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(POSITION), answer)
    assert full_marks(report), report
    assert [(row.label, [cell.label for cell in row.cells]) for row in report.rows] == [
        ("1", ["1"]),
        ("2", ["1"]),
        ("3", ["1"]),
    ]


@pytest.mark.parametrize(
    ("answer", "blamed", "codes"),
    [
        ([SPATIAL[1], SPATIAL[0], SPATIAL[2]], {"1", "2"}, {"exchanged_coordinates"}),
        ([f"-({text})" for text in SPATIAL], {"1", "2", "3"}, {"reversed_position"}),
        (["c1 (L1 c2 + R)", "s1 (L1 c2 + R)", "L1 s2"], {"1", "2", "3"}, {"wrong_frame"}),
        ([SPATIAL[0], SPATIAL[1], "-L2 s23 - L1 s2"], {"3"}, {"sign"}),
        ([SPATIAL[0], SPATIAL[1], "L2 c23 + L1 c2"], {"3"}, {"sine_for_cosine"}),
        ([SPATIAL[0], SPATIAL[1], "1/0"], {"3"}, {"undefined"}),
    ],
)
def test_a_wrong_position(
    answer: list[str], blamed: set[str], codes: set[str], make_exercise: Make
) -> None:
    report = graded(make_exercise(POSITION), answer)
    assert {row for row, _ in not_correct(report)} == blamed
    assert told(report) == codes


@pytest.mark.parametrize("answer", [[], ["0"] * 4, [["0", "0", "0"]] * 2, {"x": "0"}, 1, None])
def test_a_position_of_another_shape(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(POSITION), answer)
    assert report.points == 0
    assert report.verdict in (Verdict.UNREADABLE, Verdict.MISSING)


COORDINATES_XY = one_part("position", 'coordinates = "xy"', SPATIAL_RRR)
POINT = one_part(
    "vector",
    """components = [
    { name = "x", quantity = "length", expected = "l" },
    { name = "y", quantity = "number", expected = "k" },
]""",
)


@pytest.mark.parametrize(
    "answer",
    [
        ["l", "k", 0],
        ["l", "k", 0.0],
        ["l", "k", " 0 "],
        [["l"], ["k"], [0]],
        [["l", "k", 0]],
        "l, k, 0",
        "[l; k; 0]",
        "l\nk\n0",
        "(l, k, 0)",
        r"\begin{bmatrix} l \\ k \\ 0 \end{bmatrix}",
    ],
)
def test_a_third_zero_is_left_aside_and_said_to_be(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(POINT), answer)
    assert full_marks(report), report
    assert [row.label for row in report.rows] == ["1", "2"]
    assert told(report) == {"zero_left_aside"}
    [message] = cell(report, "2", "1").feedback
    if isinstance(answer, str):
        assert message.span is not None
        assert answer[slice(*message.span)].strip() == "0"


def test_a_third_zero_of_a_planar_position_is_left_aside(make_exercise: Make) -> None:
    report = graded(make_exercise(COORDINATES_XY), [*SPATIAL[:2], 0])
    assert full_marks(report)
    assert told(report) == {"zero_left_aside"}


@pytest.mark.parametrize(
    "answer",
    [
        ["l", "k", 1],
        ["l", "k", "0.0"],
        ["l", "k", "0*l"],
        ["l", "k", False],
        ["l", "k", None],
        ["l", 0, "k"],
        ["l", "k", 0, 0],
        ["l", "k", 0, 1],
        "l, k, 0, 1",
        "l, k, l",
    ],
)
def test_any_other_third_value_is_refused(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(POINT), answer)
    assert (report.verdict, told(report)) == (Verdict.UNREADABLE, {"wrong_shape"})


@pytest.mark.parametrize("coordinates", ["xz", "yz"])
def test_which_coordinate_a_zero_is_may_not_be_plain(coordinates: str, make_exercise: Make) -> None:
    """[x, y, 0], handed in for x and z, must not be read with y for z."""
    text = one_part("position", f'coordinates = "{coordinates}"', SPATIAL_RRR)
    assert told(graded(make_exercise(text), ["0", "0", 0])) == {"wrong_shape"}


def test_three_values_with_a_zero_behind_them_are_refused(make_exercise: Make) -> None:
    report = graded(make_exercise(POSITION), [*SPATIAL, 0])
    assert told(report) == {"wrong_shape"}
    [message] = report.feedback
    assert message.message.endswith("; this one has 4.")


@pytest.mark.parametrize(
    "text",
    [
        "(2 l, k k)",
        "[2 l, k k]",
        "[2 l + 0, k k]",
        "2 l; k k",
        "2 l\nk k",
        "  2 l ;  k k",
        "(2 l, sqrt((k k)^2))",
    ],
)
def test_products_may_be_written_with_blanks(text: str, make_exercise: Make) -> None:
    """Where only one reading has as many values as are asked for, it is that one."""
    vector = one_part(
        "vector",
        """components = [
    { name = "x", quantity = "length", expected = "2*l" },
    { name = "y", quantity = "number", expected = "k^2" },
]""",
    )
    assert full_marks(graded(make_exercise(vector), text))


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("no", "wrong_shape"),
        ("l", "wrong_shape"),
        ("l k", "wrong_shape"),
        # MATLAB reads three values here.
        ("[l -l, k]", "mixed_separators"),
        ("[l k, k, l k]", "mixed_separators"),
        ('{"x": 1, "y": 2, "z": 3}', "mixed_separators"),
        ("1 2 3\n4 5\n6 7", "ambiguous_columns"),
    ],
)
def test_what_is_no_list_is_not_told_of_tables(text: str, code: str, make_exercise: Make) -> None:
    report = graded(make_exercise(POINT), text)
    assert (report.verdict, told(report)) == (Verdict.UNREADABLE, {code})
    [message] = report.feedback
    assert "list of 2 values" in message.message
    for word in ("row", "column", "table", "matrix"):
        assert word not in message.message


@pytest.mark.parametrize("answer", [[["l"], ["k"], ["l"]], [["l", "k"], ["l", "k"]], [["l"], []]])
def test_lists_in_a_list_are_no_list_of_values(answer: object, make_exercise: Make) -> None:
    assert told(graded(make_exercise(POINT), answer)) == {"wrong_shape"}


def test_equations_in_a_list_are_repaired_one_by_one(make_exercise: Make) -> None:
    report = graded(make_exercise(POINT), "x = l\ny = k")
    assert not_correct(report) == {
        ("1", "1"): Verdict.UNREADABLE,
        ("2", "1"): Verdict.UNREADABLE,
    }
    assert told(report) == {"equation"}


def test_two_coordinates_leave_the_third_missing(make_exercise: Make) -> None:
    report = graded(make_exercise(POSITION), SPATIAL[:2])
    assert not_correct(report) == {("3", "1"): Verdict.MISSING}


@pytest.mark.parametrize("coordinates", ["xy", "xz", "yz"])
def test_some_coordinates_only(coordinates: str, make_exercise: Make) -> None:
    text = one_part("position", f'coordinates = "{coordinates}"', SPATIAL_RRR)
    answer = [SPATIAL["xyz".index(letter)] for letter in coordinates]
    assert full_marks(graded(make_exercise(text), answer))


def test_the_chain_of_rigid_motions(catalogue: Mapping[str, Exercise]) -> None:
    """Equations 2.13 to 2.15, with R_1^0 = Rz(φ), R_2^1 = Rx(θ) multiplied out by hand."""
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
    assert "left_handed_rotation" in told(misread)


TASK = ["a1 c1 + a2 c12", "a1 s1 + a2 s12"]


@pytest.mark.parametrize("angle", ["theta1 + theta2", "θ1 + θ2 - 2π", "atan2(s12, c12)"])
def test_an_angle_of_a_vector_counts_modulo_whole_turns(
    angle: str, catalogue: Mapping[str, Exercise]
) -> None:
    report = handed_in(catalogue["planar-rr"], {"task-space": [*TASK, angle]})
    assert full_marks(part(report, "task-space"))


@pytest.mark.parametrize(
    ("answer", "row", "code"),
    [
        ([*TASK, "-theta1 - theta2"], "3", "sign"),
        ([*TASK, "theta1 + theta2 + pi"], "3", "half_turn"),
        ([*TASK, "theta1 + theta2 + pi/2"], "3", "quarter_turn"),
        ([*TASK, "atan(s12/c12)"], "3", "lost_quadrant"),
        ([*TASK, "pi/2 - theta1 - theta2"], "3", "swapped_atan2"),
        ([*TASK, "theta2"], "3", "value"),
        (["a1 c1 + a2 c2", TASK[1], "theta1 + theta2"], "1", "relative_angle"),
    ],
)
def test_a_slip_in_a_vector(
    answer: list[str], row: str, code: str, catalogue: Mapping[str, Exercise]
) -> None:
    report = part(handed_in(catalogue["planar-rr"], {"task-space": answer}), "task-space")
    assert not_correct(report) == {(row, "1"): Verdict.INCORRECT}
    assert report.points == 2
    assert [message.code for message in cell(report, row, "1").feedback] == [code]


def test_a_length_is_no_angle(catalogue: Mapping[str, Exercise]) -> None:
    answer = [f"{TASK[0]} + 2*pi", TASK[1], "theta1 + theta2"]
    report = part(handed_in(catalogue["planar-rr"], {"task-space": answer}), "task-space")
    assert not_correct(report) == {("1", "1"): Verdict.INCORRECT}


MATRIX = one_part("matrix", 'expected = [["1", "l", "phi"], ["k^2", "sin(phi)", "0"]]')


def test_a_matrix_of_any_size(make_exercise: Make) -> None:
    exercise = make_exercise(MATRIX)
    assert full_marks(graded(exercise, [[1, "l", "phi"], ["k*k", "sin phi", 0]]))
    assert full_marks(graded(exercise, "[1 l phi; k^2 sin(phi) 0]"))
    report = graded(exercise, [[1, "l", "-phi"], ["k", "sin phi", 0]])
    assert set(not_correct(report)) == {("1", "3"), ("2", "1")}
    assert report.points == 4


@pytest.mark.parametrize("answer", [[[1, 2, 3]] * 3, [], 4, [["1"]] * 2])
def test_a_matrix_of_another_size(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(MATRIX), answer)
    assert (report.verdict, report.points) == (Verdict.UNREADABLE, 0)


def test_the_twists_of_the_lecture(catalogue: Mapping[str, Exercise]) -> None:
    """Screw Theory, Example: Simple Twist: S_ω = (0, 0, 1), S_v = (0, −2, 0)."""
    answers: dict[str, Any] = {
        "zero-pitch": [[0, 0, 1, 0, -2, 0]],
        "twist": [0, 0, "w", 0, "-2 w", 0],
        "pitch": [0, 0, 1, 0, -2, "h"],
        "infinite-pitch": [[0, 0, 0, 1, 0, 0]],
        "exponential": [
            ["cos theta", "-sin theta", 0, "2 - 2 cos theta"],
            ["sin theta", "cos theta", 0, "-2 sin theta"],
            [0, 0, 1, 0],
            [0, 0, 0, 1],
        ],
    }
    report = handed_in(catalogue["simple-twist"], answers)
    for part_id in answers:
        assert full_marks(part(report, part_id)), part(report, part_id)


def test_a_line_that_cannot_be_read_is_shown_where_it_stands(make_exercise: Make) -> None:
    text = "c1*(L2*c23+L1*c2+R)\n\n(s1\nL2*s23+L1*s2"
    report = graded(make_exercise(POSITION), text)
    assert not_correct(report) == {("2", "1"): Verdict.UNREADABLE}
    [message] = cell(report, "2", "1").feedback
    assert message.span is not None
    assert text[slice(*message.span)].startswith("(")
