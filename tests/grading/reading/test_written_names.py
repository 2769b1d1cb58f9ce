"""Sort values with names: ``y = 2, x = 1`` is read as x, then y."""

import time
from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport, Severity, Verdict

from tests.grading.support.exercise_texts import SPATIAL_RRR, Make, all_codes, graded, one_part
from tests.grading.support.submitting import cell, full_marks, handed_in, not_correct, part

ORDERED = {"ordered_by_names"}
# l along x, k·l along y, 2 l along z.
POINT = one_part("position", 'expected = ["l", "k*l", "2*l"]')
PLANE = one_part("position", 'coordinates = "xy"\nexpected = ["l", "k*l"]')
POSTURE = one_part(
    "vector",
    """components = [
    { name = "p_x", quantity = "length", expected = "l" },
    { name = "p_y", quantity = "length", expected = "k*l" },
    { name = "φ", quantity = "angle", expected = "phi + pi/6" },
]""",
)
TWIST = one_part(
    "vector",
    """components = [
    { name = "v_x", quantity = "number", expected = "1" },
    { name = "v_y", quantity = "number", expected = "2" },
    { name = "ω_x", quantity = "number", expected = "3" },
    { name = "ω_y", quantity = "number", expected = "4" },
]""",
)


def euler(sequence: str, expected: str, axes: str = "moving") -> str:
    fields = f'sequence = "{sequence}"\naxes = "{axes}"\nexpected = {expected}'
    return one_part("euler_angles", fields)


def only(report: PartReport, code: str) -> None:
    """Assert that the report has exactly one message, with this code."""
    messages = [*report.feedback]
    for row in report.rows:
        messages += (*row.feedback, *(each for cell in row.cells for each in cell.feedback))
    assert [message.code for message in messages] == [code]


@pytest.mark.parametrize(
    "answer",
    [
        ["y = k l", "x = l", "z = 2 l"],
        ["z = 2 l", "x = l", "y = k l"],
        [["pz = 2 l"], ["px = l"], ["py = k l"]],
        ["p_{e,z} = 2 l", "p_{e,x} = l", "p_{e,y} = k l"],
        ["Z := 2 l", "Y := k l", "X := l"],
        [r"{}^0p_z = 2 l", r"{}^0p_y = k l", r"{}^0p_x = l"],
        ["z_e = 2 l", "y_{ee} = k l", "x_e = l"],
        ["p.y = k*l", "p.x = l", "p.z = 2*l"],
        ["y_3 = k l", "x_3 = l", "z_3 = 2 l"],
        ["y(q1) = k l", "x(q1) = l", "z(q1) = 2 l"],
        "y = k l, x = l, z = 2 l",
        "y = k l\nx = l\nz = 2 l",
        "[y = k*l; x = l; z = 2*l]",
        r"\begin{bmatrix} y = k l \\ x = l \\ z = 2 l \end{bmatrix}",
    ],
)
def test_named_coordinates_are_put_in_order(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(POINT), answer)
    assert full_marks(report), report
    only(report, "ordered_by_names")
    [note] = report.feedback
    assert (note.message, note.span) == ("The values were ordered by their names.", None)


def test_an_omitted_named_value_is_missing_in_its_place(make_exercise: Make) -> None:
    report = graded(make_exercise(POINT), ["z = 2 l", None, "x = l"])
    assert not_correct(report) == {("2", "1"): Verdict.MISSING}


@pytest.mark.parametrize(
    ("answer", "messages"),
    [
        # Not all values have a name, so the order of the others is ambiguous.
        (
            ["y = k l", "l", "z = 2 l"],
            {"1": "This is named `y`, but x is asked for here."},
        ),
        (
            ["x = l", "x_e = k l", "z = 2 l"],
            {"2": "This is named `x_e`, but y is asked for here."},
        ),
        (["phi = l", "k l", "2 l"], {"1": "This is named `phi`, but x is asked for here."}),
        ("l\nz = k l\n2 l", {"2": "This is named `z`, but y is asked for here."}),
    ],
)
def test_a_contradicting_name_gets_a_message(
    answer: object, messages: Mapping[str, str], make_exercise: Make
) -> None:
    report = graded(make_exercise(POINT), answer)
    assert {key: verdict for key, verdict in not_correct(report).items() if key[0] in messages} == {
        (row, "1"): Verdict.UNREADABLE for row in messages
    }
    for row, sentence in messages.items():
        [message] = cell(report, row, "1").feedback
        assert (message.code, message.message) == ("misnamed_value", sentence)
        assert message.severity is Severity.ERROR
        assert message.span is not None
        if isinstance(answer, str):
            assert answer[slice(*message.span)] == "z ="


def test_an_unexpected_coordinate_is_named(make_exercise: Make) -> None:
    report = graded(make_exercise(PLANE), ["l", "z = k l"])
    assert not_correct(report) == {("2", "1"): Verdict.UNREADABLE}


def test_a_named_zero_after_two_values_is_ignored(make_exercise: Make) -> None:
    for answer in (
        ["x = l", "y = k l", "z = 0"],
        "x = l, y = k l, z = 0",
        r"x = l,\quad y = k l,\quad z = 0",
    ):
        report = graded(make_exercise(PLANE), answer)
        assert full_marks(report), report
        assert all_codes(report) == {"equation", "zero_left_aside"}


@pytest.mark.parametrize(
    "answer",
    [
        ["x_1 = l", "x_2 = k l", "x_3 = 2 l"],
        ["first = l", "second = k l", "third = 2 l"],
        ["l = l", "k l", "2 l"],
        ["= l", "= k l", "= 2 l"],
        ["xy = l", "p_{yx} = k l", "zz = 2 l"],
    ],
)
def test_other_names_are_read_with_one_note(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(POINT), answer)
    assert full_marks(report), report
    only(report, "equation")


@pytest.mark.parametrize("phi", ["φ", r"\phi", "phi", r"\varphi", "Phi"])
def test_components_are_ordered_by_the_names_in_the_exercise(phi: str, make_exercise: Make) -> None:
    # The bare 30 is read as an angle in degrees, although it is in the place of a length.
    answer = [f"{phi} = phi + 30", "p_y = k l", "px = l"]
    report = graded(make_exercise(POSTURE), answer, "degrees")
    assert full_marks(report), report
    only(report, "ordered_by_names")


def test_a_bare_coordinate_of_two_vectors_is_ambiguous(
    make_exercise: Make,
) -> None:
    # In (v_x, v_y, ω_x, ω_y) the full names are known, but a bare x is ambiguous.
    exercise = make_exercise(TWIST)
    full = ["omega_x = 3", "ω_y = 4", "vx = 1", "v_{y} = 2"]
    assert full_marks(graded(exercise, full))
    bare = graded(exercise, ["x = 1", "y = 2", "x = 3", "y = 4"])
    assert full_marks(bare), bare
    only(bare, "equation")


@pytest.mark.parametrize(
    ("exercise", "answer"),
    [
        (euler("RPY", '["phi", "psi", "1"]'), ["gamma = 1", "beta = psi", "alpha = phi"]),
        (euler("ZYX", '["phi", "psi", "1"]'), ["γ = 1", "α = phi", "β = psi"]),
        (euler("ZYX", '["phi", "psi", "1"]'), ["θ_x = 1", "θ_y = psi", "θ_z = phi"]),
        (euler("ZYZ", '["phi", "0.5", "1"]'), ["theta = 0.5", "psi = 1", "phi = phi"]),
    ],
)
def test_named_angles_are_put_in_order(exercise: str, answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(exercise), answer)
    assert full_marks(report), report
    assert all_codes(report) == ORDERED


@pytest.mark.parametrize(
    ("exercise", "names"),
    [
        # Roll is about x in one textbook, about z in another; pitch is about y in all.
        (euler("RPY", '["phi", "psi", "1"]'), ("roll", "pitch", "yaw")),
        (euler("RPY", '["phi", "psi", "1"]'), ("yaw", "pitch", "roll")),
        (euler("RPY", '["phi", "psi", "1"]'), ("psi", "theta", "phi")),
        (euler("XYZ", '["phi", "psi", "1"]', "fixed"), ("gamma", "beta", "alpha")),
    ],
)
def test_names_that_textbooks_use_differently_move_nothing(
    exercise: str, names: tuple[str, ...], make_exercise: Make
) -> None:
    values = ("phi", "psi", "1")
    answer = [f"{name} = {value}" for name, value in zip(names, values, strict=True)]
    report = graded(make_exercise(exercise), answer)
    assert full_marks(report), report
    only(report, "equation")


def test_pitch_is_the_angle_about_y(make_exercise: Make) -> None:
    exercise = make_exercise(euler("RPY", '["phi", "psi", "1"]'))
    report = graded(exercise, ["pitch = phi", "yaw = psi", "roll = 1"])
    assert [cell(report, row, "1").verdict for row in "12"] == [Verdict.UNREADABLE] * 2
    [message] = cell(report, "1", "1").feedback
    assert message.message == (
        "This is named `pitch`, but the first angle, about z, is asked for here."
    )


# --- cells of tables

TABLE = one_part("dh_table", 'convention = "standard"', SPATIAL_RRR)
RIGHT = [["R", "90deg", "0", "theta1"], ["L1", "0", "0", "theta2"], ["L2", "0", "0", "theta3"]]


def with_row(number: int, *cells: object) -> list[list[object]]:
    rows: list[list[object]] = [[*row] for row in RIGHT]
    rows[number - 1] = [*cells]
    return rows


@pytest.mark.parametrize(
    "answer",
    [
        with_row(1, "d = 0", "alpha = 90deg", "a = R", "theta = theta1"),
        with_row(1, "d_1 = 0", r"\alpha_{1} = 90deg", "θ₁ = theta1", "a(1) = R"),
        with_row(2, "q2 = theta2", "d2 = 0", "a_{i} = L1", "α_i = 0"),
        with_row(3, "offset = 0", "twist = 0", "length = L2", "angle = theta3"),
        # In the modified convention a and α have the index of the previous row.
        with_row(3, "d_3 = 0", "alpha_2 = 0", "a_2 = L2", "theta_3 = theta3"),
        [
            ["d_0 = 0", "a_0 = R", "alpha_0 = 90deg", "theta_0 = theta1"],
            ["d_1 = 0", "a_1 = L1", "alpha_1 = 0", "theta_1 = theta2"],
            RIGHT[2],
        ],
        {"rows": [{"a": "d=0", "alpha": "a=R", "d": "alpha=90deg", "theta": "q1=theta1"}]},
        "a, alpha, d, theta\nd=0, a=R, alpha=90deg, theta=theta1\nL1,0,0,theta2\nL2,0,0,theta3",
    ],
)
def test_named_cells_are_put_in_their_columns(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(TABLE), answer)
    rows = 1 if isinstance(answer, dict) else 3
    wrong = {key: v for key, v in not_correct(report).items() if int(key[0]) <= rows}
    assert wrong == {}
    [note] = [each for each in report.feedback if each.code == "ordered_by_names"]
    assert note.message == "The cells of a row were ordered by their names."
    assert "equation" not in all_codes(report)


def test_names_in_several_rows_get_one_note(make_exercise: Make) -> None:
    answer = [[f"theta{i + 1} = {row[3]}", *row[:3]] for i, row in enumerate(RIGHT)]
    named = [[row[0], f"a = {row[1]}", f"alpha = {row[2]}", f"d = {row[3]}"] for row in answer]
    report = graded(make_exercise(TABLE), named)
    assert full_marks(report), report
    only(report, "ordered_by_names")


@pytest.mark.parametrize(
    ("answer", "place", "sentence"),
    [
        (
            with_row(1, "R", "90deg", "theta = 0", "theta1"),
            ("1", "d"),
            "This is named `theta`, but d is asked for here.",
        ),
        (
            with_row(1, "R", "90deg", "0", "theta2 = theta1"),
            ("1", "theta"),
            "This is named `theta2`, but θ (row 1) is asked for here.",
        ),
        (
            with_row(2, "L1", "alpha_3 = 0", "0", "theta2"),
            ("2", "alpha"),
            "This is named `alpha_3`, but α (row 2) is asked for here.",
        ),
        (
            "a, alpha, d, theta\nR, 90deg, 0, q2 = q1\nL1, 0, 0, q2\nL2, 0, 0, q3",
            ("1", "theta"),
            "This is named `q2`, but θ (row 1) is asked for here.",
        ),
    ],
)
def test_a_cell_with_the_name_of_another_is_unreadable(
    answer: object, place: tuple[str, str], sentence: str, make_exercise: Make
) -> None:
    report = graded(make_exercise(TABLE), answer)
    assert not_correct(report) == {place: Verdict.UNREADABLE}
    [message] = cell(report, *place).feedback
    assert (message.code, message.message) == ("misnamed_value", sentence)
    if isinstance(answer, str):
        assert message.span is not None
        assert answer[slice(*message.span)] == "q2 ="


@pytest.mark.parametrize(
    "answer",
    [
        with_row(1, "R", "90deg", "0", "theta1 = q1"),
        with_row(1, "L = R", "β = 90deg", "z = 0", "phi = theta1"),
    ],
)
def test_other_names_in_a_table_are_read_with_one_note(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(TABLE), answer)
    assert full_marks(report), report
    only(report, "equation")


def test_a_wrong_variable_keeps_its_own_message(make_exercise: Make) -> None:
    # In row 1, the slip in θ2 = θ2 is the variable, not the name before the equals sign.
    report = graded(make_exercise(TABLE), with_row(1, "R", "90deg", "0", "theta2 = theta2"))
    assert cell(report, "1", "theta").verdict is Verdict.INCORRECT


# --- entries of matrices

MATRIX = one_part(
    "matrix", 'quantity = "number"\nexpected = [["1", "2", "3"], ["4", "5", "6"], ["7", "8", "9"]]'
)


def matrix_with(first: str) -> list[list[str]]:
    return [["1", first, "3"], ["4", "5", "6"], ["7", "8", "9"]]


@pytest.mark.parametrize(
    "name",
    [
        "T(1,2)", "r12", "r_{12}", r"\mathrm{r}_{12}", "R_{1,2}", "T[0][1]", "T[0,1]", "T[1,2]",
        "T_0^3(1,2)", "p_{21}", "l21", "x", "T_{04}", "J(2,7)", "J_v(2,1)", "r_2", "S(2,1)",
    ],
)  # fmt: skip
def test_a_name_that_fits_an_entry_is_read(name: str, make_exercise: Make) -> None:
    report = graded(make_exercise(MATRIX), matrix_with(f"{name} = 2"))
    assert full_marks(report), report
    only(report, "equation")


@pytest.mark.parametrize(
    "name", ["T(2,1)", "r21", "r_{32}", r"\mathbf{R}_{13}", "T[1][0]", "A_1(3,3)", "h_{2,2}"]
)
def test_an_entry_with_the_index_of_another_is_unreadable(name: str, make_exercise: Make) -> None:
    exercise = make_exercise(MATRIX)
    rows = matrix_with(f"{name} = 2")
    pasted = "\n".join(" ; ".join(row) for row in rows)
    for answer in (rows, pasted):
        report = graded(exercise, answer)
        assert not_correct(report) == {("1", "2"): Verdict.UNREADABLE}
        [message] = cell(report, "1", "2").feedback
        assert message.code == "misnamed_value"
        assert message.message == (
            f"This is named `{name}`, but row 1, column 2 is asked for here."
        )


def test_a_declared_name_is_not_an_index(make_exercise: Make) -> None:
    setting = '[symbols]\na21 = { kind = "length", description = "a length" }\n'
    exercise = one_part("matrix", 'quantity = "number"\nexpected = [["1", "2"]]', setting)
    assert full_marks(graded(make_exercise(exercise), [["1", "a21 = 2"]]))


@pytest.mark.parametrize("gap", [" " * 7900, "\n" * 7900, " \t" * 3950])
def test_a_name_with_many_blanks_is_read_in_linear_time(gap: str, make_exercise: Make) -> None:
    # A pattern that backtracks over the blanks would take seconds.
    answer = matrix_with(f"r_1{gap}_2 = 2")
    start = time.thread_time()
    graded(make_exercise(MATRIX), answer)
    assert time.thread_time() - start < 0.5


# --- notes that are shown once


def test_notes_that_need_no_span_are_shown_once(catalogue: Mapping[str, Exercise]) -> None:
    answer = ["A1 c1 + A2 c12 + A1 - a1", "A1 s1 + A2 s12"]
    report = part(handed_in(catalogue["planar-rr"], {"position": answer}), "position")
    assert full_marks(report), report
    told = {note.message: note for note in report.feedback}
    assert set(told) == {"`A1` was read as a1.", "`A2` was read as a2."}
    for note in told.values():
        assert [(place.row, place.cell) for place in note.places or ()] == [("1", "1"), ("2", "1")]
        assert note.span is None


def test_a_note_on_one_cell_keeps_its_span(catalogue: Mapping[str, Exercise]) -> None:
    answer = ["x = a1 c1 + a2 c12", "a1 s1 + a2 s12"]
    report = part(handed_in(catalogue["planar-rr"], {"position": answer}), "position")
    [note] = cell(report, "1", "1").feedback
    assert (note.code, note.span) == ("equation", (0, 3))


@pytest.mark.parametrize(
    "answer",
    [
        {"z": "2 l", "x": "l", "y": "k l"},
        {"p_x": "l", "p_y": "k l", "p_z": "2 l"},
        "y: k l\nx: l\nz: 2 l",
    ],
)
def test_an_object_and_lines_with_colons_are_read_by_name(
    answer: object, make_exercise: Make
) -> None:
    assert full_marks(graded(make_exercise(POINT), answer))


def test_an_object_may_omit_a_value(make_exercise: Make) -> None:
    report = graded(make_exercise(POINT), {"z": "2 l", "x": "l"})
    assert [row.verdict for row in report.rows] == [
        Verdict.CORRECT,
        Verdict.MISSING,
        Verdict.CORRECT,
    ]


@pytest.mark.parametrize(
    "answer", [{}, {"u": "l", "y": "k l"}, {"x": "l", "p_x": "l"}, dict.fromkeys("xyzw", "l")]
)
def test_keys_that_share_a_place_are_refused(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(POINT), answer)
    assert report.verdict is Verdict.UNREADABLE
    assert all_codes(report) == {"wrong_shape"}
