"""Test how one entry is read: its variables, names, letters and units."""

import time
from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.expressions import ExpressionError, Symbol, Vocabulary, joint_variable, read
from dh_grader.grading import PartReport, Severity, Verdict
from dh_grader.grading.reading import PastedPreview, preview_entries, preview_pasted
from dh_grader.grading.reading.entries import converted, joint_counted, with_absent_variables

from tests.grading.support.submitting import (
    SPATIAL_RRR,
    Make,
    all_codes,
    cell,
    codes,
    full_marks,
    graded,
    graded_pose,
    graded_table,
    handed_in,
    not_correct,
    one_part,
    part,
)

# --- Read joint variables with a star, such as θ1*


@pytest.fixture
def scara(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["scara"]


@pytest.mark.parametrize(
    ("d", "told"),
    [
        ("d3*", []),
        ("d3* + d4", []),
        ("d3*+d4", []),
        ("d3* - d4", ["marker_or_product"]),
        ("d3*-d4", ["marker_or_product"]),
        ("d3*+s1", ["joint_marker"]),
        ("a1*d3*+d4", ["ambiguous_star"]),
        ("a1*d3*", ["trailing_operator"]),
    ],
)
def test_in_a_table(d: str, told: list[str], scara: Exercise) -> None:
    rows = [("a1", "0", "0", "theta1"), ("a2", "180deg", "0", "theta2"), ("0", "0", d, "0")]
    found = set(codes(cell(graded_table(scara, rows), "3", "d")))
    stars = {"joint_marker", "marker_or_product", "ambiguous_star", "trailing_operator"}
    assert found & stars == set(told)


@pytest.mark.parametrize(
    ("entry", "verdict", "told"),
    [
        ("d3*+s1", Verdict.INCORRECT, "joint_marker"),
        ("theta1*-pi/2", Verdict.INCORRECT, "marker_or_product"),
        ("c1*d3*+s1", Verdict.UNREADABLE, "ambiguous_star"),
    ],
)
def test_in_a_matrix(entry: str, verdict: Verdict, told: str, scara: Exercise) -> None:
    pose = [[entry, "0", "0", "0"], ["0"] * 4, ["0"] * 4, ["0", "0", "0", "1"]]
    found = cell(graded_pose(scara, pose), "1", "1")
    assert found.verdict is verdict
    assert told in codes(found)


# --- Test joint variables that a robot does not have

# An RPR arm with a length that has the usual name of a joint variable.
WORDS = Vocabulary(
    [
        joint_variable(1),
        joint_variable(2, sliding=True),
        joint_variable(3),
        Symbol("d3", "length"),
    ]
)
TURNING = Vocabulary([joint_variable(1), joint_variable(2)])


@pytest.mark.parametrize(
    ("text", "name", "joint"),
    [
        ("theta2", "theta2", 2),
        ("θ_2*", "theta2", 2),
        ("th0", "theta0", 0),
        ("q0", "theta0", 0),
        ("d1 + 2", "d1", 1),
    ],
)
def test_names(text: str, name: str, joint: int) -> None:
    with pytest.raises(ExpressionError):
        read(text, WORDS)
    assert read(text, with_absent_variables(WORDS)).symbols == {name}
    assert joint_counted(name) == joint


@pytest.mark.parametrize("text", ["q1", "d2", "q2", "d3", "theta3"])
def test_declared_names_keep_their_meaning(text: str) -> None:
    assert read(text, with_absent_variables(WORDS)).symbols == read(text, WORDS).symbols


@pytest.mark.parametrize("text", ["theta4", "c2", "c0", "theta12"])
def test_other_names_stay_unknown(text: str) -> None:
    with pytest.raises(ExpressionError):
        read(text, with_absent_variables(WORDS))


def test_d1_is_a_length_if_no_joint_slides() -> None:
    with pytest.raises(ExpressionError):
        read("d1", with_absent_variables(TURNING))


def test_without_joints_nothing_is_absent() -> None:
    words = Vocabulary([Symbol("l1", "length")])
    assert with_absent_variables(words) is words


# --- Refuse a length with a unit, and suggest the number in the exercise's unit


@pytest.mark.parametrize(
    ("text", "unit", "number"),
    [
        ("135 mm", "m", "0.135"),
        ("-13,5cm", "m", "-0.135"),
        ("400.0 mm", "m", "0.4"),
        ("0 mm", "m", "0"),
        ("0.135 m", "mm", "135"),
        ("1.35 m", "cm", "135"),
        ("135ｍｍ", "m", "0.135"),
        ("400 [mm]", "m", "0.4"),
        (r"\SI{135}{\milli\metre}", "m", "0.135"),
    ],
)
def test_a_length_in_another_unit(text: str, unit: str, number: str) -> None:
    assert converted(text, unit) == number


@pytest.mark.parametrize("text", ["1,350 mm", "a2 mm", "2 N", "135 mm + a2", "135"])
def test_no_number_is_guessed(text: str) -> None:
    assert converted(text, "m") is None


def test_the_repair_of_a_cell(catalogue: Mapping[str, Exercise]) -> None:
    arm = catalogue["rrrp"]
    texts = ["135 mm", "l1 m", "l1 mm"]
    cells = preview_entries([(text, "length") for text in texts], arm, "table")
    assert [cell.problem and cell.problem.suggestion for cell in cells] == ["0.135", "l1", None]


# --- Replace letters by the numbers that a script assigns to them

HEADERS = "a,alpha,d,theta"
ROWS = ("0, pi/2, d1, q1", "a2, 0, 0, q2", "-a2/2, 0, 0, q3")
TABLE = "[" + "; ".join(ROWS) + "]"
LISTS = "[" + ", ".join(f"[{row}]" for row in ROWS) + "]"
LINKS = (
    "L(1) = Revolute('d', d1, 'alpha', pi/2);\nL(2) = Revolute('a', a2);\n"
    "L(3) = Revolute('a', -a2/2);"
)


def lengths(read: PastedPreview) -> list[tuple[str, str]]:
    return [(row[0].text, row[2].text) for row in read.rows]


def codes_of_letters(read: PastedPreview) -> list[str]:
    return [note.code for note in read.notes if note.code.endswith("_numbers")]


@pytest.mark.parametrize(
    "text",
    [
        f"d1 = 0.1625; a2 = -0.425;\nDH = {TABLE}",
        f"d1 = 0.1625  % height\na2 = -0.425  % upper arm\nDH = {TABLE}",
        f"d1 = 0.1625;\na2 = -0.425;\n{LINKS}",
        f"import numpy as np\nd1, a2 = 0.1625, -0.425  # the lengths\nDH = np.array({LISTS})",
        f"(d1, a2) = (0.1625, -0.425)\nDH = {LISTS}",
        f"x, a2, y, d1 = 1, -0.425, 2, 0.1625\n{LINKS}",
        "\n".join(["d1 = 0.1625, a2 = -0.425", HEADERS, *ROWS]),
    ],
)
def test_a_letter_means_its_number(text: str, catalogue: Mapping[str, Exercise]) -> None:
    read = preview_pasted(text, catalogue["ur5e"], "table")
    assert read.ok
    assert lengths(read) == [("0", "0.1625"), ("-0.425", "0"), ("-(-0.425)/2", "0")]
    assert codes_of_letters(read) == ["used_numbers"]


@pytest.mark.parametrize(
    "given",
    [
        "d1 = 0.1; d1 = 0.2;",
        "",
        "d1 = 2*a2;",
        "d1 = 0.1; d1 = d1 + 0.2;",
        "d1 = 0.1;\nd1 *= 2;",
        "d1, x = 0.1, 2\nd1 = 0.3",
        "d1, x = 0.1, 2, 3",
        "x, d1 = 0.1, 2*y",
        "x, d1 = 0.1, f(2)",
        "d1, x = x, 0.1",
        "d1 = x = 0.1",
    ],
)
@pytest.mark.parametrize("table", [f"DH = {TABLE}", LINKS, "\n".join([HEADERS, *ROWS])])
def test_a_letter_without_one_number_is_unknown(
    given: str, table: str, catalogue: Mapping[str, Exercise]
) -> None:
    text = f"a2 = 0.4;\n{given}\n{table}"
    assert not preview_pasted(text, catalogue["ur5e"], "table").ok


@pytest.mark.parametrize("given", ["a1 = 0.4; a2 = 0.3;", "a1, a2 = 0.4, 0.3"])
def test_letters_of_the_exercise_keep_their_meaning(
    given: str, catalogue: Mapping[str, Exercise]
) -> None:
    text = f"{given}\nDH = [a1 0 0 q1; a2 0 0 q2]"
    read = preview_pasted(text, catalogue["planar-rr"], "table")
    assert lengths(read) == [("a1", "0"), ("a2", "0")]
    assert codes_of_letters(read) == ["given_numbers"]


def test_letters_that_change_places_are_refused(catalogue: Mapping[str, Exercise]) -> None:
    text = "a1, a2 = a2, a1\nDH = [[a1, 0, 0, q1], [a2, 0, 0, q2]]"
    read = preview_pasted(text, catalogue["planar-rr"], "table")
    assert read.problem is not None
    assert read.problem.code == "given_value"


# An exercise without letters for lengths.
NUMBERS = '[symbols]\nphi = { kind = "angle", description = "an angle" }\n'
NAMED_LISTS = {
    one_part("position", 'expected = ["0.5*cos(phi)", "0.3", "0"]', NUMBERS): (
        "z = 0, x = 0.5 cos(phi), y = 0.3",
        "x = 0.5 cos(phi), z = 0, y = 0.3",
        "y = 0.3, z = 0, x = 0.5 cos(phi)",
        "[z = 0, x = 0.5 cos(phi), y = 0.3]",
    ),
    one_part("euler_angles", 'sequence = "RPY"\nexpected = ["phi", "0.2", "0.1"]', NUMBERS): (
        "gamma = 0.1, beta = 0.2, alpha = phi",
        "beta = 0.2, alpha = phi, gamma = 0.1",
    ),
}


@pytest.mark.parametrize(
    ("exercise", "text"),
    [(exercise, text) for exercise, texts in NAMED_LISTS.items() for text in texts],
)
def test_a_list_is_ordered_by_the_names_of_numbers(
    exercise: str, text: str, make_exercise: Make
) -> None:
    report = graded(make_exercise(exercise), text)
    assert full_marks(report), report
    assert all_codes(report) == {"ordered_by_names"}


# --- Read comments that name a unit of length

POSE = "[1 0 0 400; 0 1 0 0; 0 0 1 300; 0 0 0 1]"
# An exercise, its part, and a text without a comment.
TEXTS = [
    ("puma-560", "home", f"T = {POSE};"),
    ("planar-rr-numbers", "position", "p = [300; 400]"),
    ("spatial-rrr", "links", f"A1 = {POSE};\nA2 = {POSE};\nA3 = {POSE};"),
]
each_text = pytest.mark.parametrize(("exercise", "answered", "text"), TEXTS)


@each_text
@pytest.mark.parametrize("comment", ["% lengths in mm", "# Längen in Millimetern, Winkel in Grad"])
def test_a_comment_with_another_unit_is_refused(
    exercise: str, answered: str, text: str, comment: str, catalogue: Mapping[str, Exercise]
) -> None:
    graded = part(handed_in(catalogue[exercise], {answered: f"{comment}\n{text}"}), answered)
    assert graded.verdict is Verdict.UNREADABLE
    assert [message.code for message in graded.feedback] == ["text_around"]


@each_text
@pytest.mark.parametrize("comment", ["% at the home pose", "% 2 mm of play", ""])
def test_other_comments_are_ignored(
    exercise: str, answered: str, text: str, comment: str, catalogue: Mapping[str, Exercise]
) -> None:
    graded = part(handed_in(catalogue[exercise], {answered: f"{comment}\n{text}"}), answered)
    assert graded.verdict not in {Verdict.UNREADABLE, Verdict.CORRECT}


def test_a_text_that_converts_its_lengths_is_read(catalogue: Mapping[str, Exercise]) -> None:
    text = "% mm\np = [300/1000; 400/1000]"
    graded = part(handed_in(catalogue["planar-rr-numbers"], {"position": text}), "position")
    assert "text_around" not in [message.code for message in graded.feedback]


def test_the_unit_of_the_exercise_is_ignored(catalogue: Mapping[str, Exercise]) -> None:
    text = f"% all lengths in metres\n{POSE}"
    graded = part(handed_in(catalogue["rrrp"], {"pose": text}), "pose")
    assert graded.verdict is not Verdict.UNREADABLE


def test_angles_have_no_unit_of_length(catalogue: Mapping[str, Exercise]) -> None:
    text = "% lengths in mm\nR = [1 0 0; 0 1 0; 0 0 1];"
    graded = part(handed_in(catalogue["fundamental-rotations"], {"about-x": text}), "about-x")
    assert graded.verdict is not Verdict.UNREADABLE


# --- Sort values with names: ``y = 2, x = 1`` is read as x, then y

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

WRITTEN_NAMES_TABLE = one_part("dh_table", 'convention = "standard"', SPATIAL_RRR)
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
    report = graded(make_exercise(WRITTEN_NAMES_TABLE), answer)
    rows = 1 if isinstance(answer, dict) else 3
    wrong = {key: v for key, v in not_correct(report).items() if int(key[0]) <= rows}
    assert wrong == {}
    [note] = [each for each in report.feedback if each.code == "ordered_by_names"]
    assert note.message == "The cells of a row were ordered by their names."
    assert "equation" not in all_codes(report)


def test_names_in_several_rows_get_one_note(make_exercise: Make) -> None:
    answer = [[f"theta{i + 1} = {row[3]}", *row[:3]] for i, row in enumerate(RIGHT)]
    named = [[row[0], f"a = {row[1]}", f"alpha = {row[2]}", f"d = {row[3]}"] for row in answer]
    report = graded(make_exercise(WRITTEN_NAMES_TABLE), named)
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
    report = graded(make_exercise(WRITTEN_NAMES_TABLE), answer)
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
    report = graded(make_exercise(WRITTEN_NAMES_TABLE), answer)
    assert full_marks(report), report
    only(report, "equation")


def test_a_wrong_variable_keeps_its_own_message(make_exercise: Make) -> None:
    # In row 1, the slip in θ2 = θ2 is the variable, not the name before the equals sign.
    report = graded(
        make_exercise(WRITTEN_NAMES_TABLE), with_row(1, "R", "90deg", "0", "theta2 = theta2")
    )
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
