"""A decimal is right if it is the true number, rounded or cut off."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Severity, Verdict

from tests.grading.support.robots import EXACT, STANFORD
from tests.grading.support.submitting import (
    cell,
    codes,
    codes_at,
    graded_pose,
    graded_table,
    not_correct,
)
from tests.together import together

# An arm whose pose contains constants: sqrt(2)/2 in row 3, 2/3 as a length.
ARM = """
title = "A tilted joint"
source = "made for this test"
statement = "One joint, tilted by an eighth of a turn."
[robot]
structure = "RR"
convention = "standard"
joints = ["q1", "q2"]
table = [["2/3", "45deg", "2", "q1 + pi/2"], ["0", "180deg", "1000", "q2"]]
[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
points = 8
convention = "standard"
[[parts]]
id = "pose"
kind = "transform"
title = "Pose"
"""
ROWS = [["2/3", "pi/4", "2", "q1 + pi/2"], ["0", "pi", "1000", "q2"]]


@pytest.fixture
def arm(make_exercise: Callable[[str], Exercise]) -> Exercise:
    return make_exercise(ARM)


# 2/3 = 0.66667, π/4 = 0.785398, π/2 = 1.570796.
ACCEPTED = [
    (0, "alpha", "0.785"),
    (0, "alpha", "0.7854"),
    (0, "theta", "q1 + 1.5708"),
    (0, "theta", "q1 + 1.57"),
    (0, "theta", "1.571 + q1"),
    (0, "a", "0.6667"),
    (0, "a", "0.667"),
    (0, "a", "0.666"),
    (0, "a", "2*0.333"),
    (0, "alpha", "0.786 - 0.000524"),
    (0, "alpha", "2.36 - pi/2"),
    (1, "alpha", "3.14"),
    (1, "alpha", "-3.14"),
    (1, "alpha", "3.1416"),
]
REFUSED = [
    (0, "a", "0.668"),
    (0, "a", "0.665"),
    (0, "alpha", "0.786"),
    (0, "theta", "q1 + 1.58"),
    (0, "theta", "1.001*q1 + pi/2"),
    (0, "d", "1.999"),
    (0, "d", "2.001"),
    (0, "alpha", "0.8"),
    (0, "alpha", "0.78"),
    (0, "theta", "q1 + 1.6"),
    (0, "theta", "q1 + 1.5"),
    (0, "a", "0.67"),
    (0, "a", "0.66"),
    (0, "d", "2.01"),
    (1, "alpha", "3.1"),
    (1, "alpha", "3.2"),
    (1, "a", "0.0001"),
    (1, "d", "998"),
    (1, "d", "999.5"),
    (0, "alpha", "44.98deg"),
    (1, "theta", "q2 + 0.01"),
]


def graded(arm: Exercise, i: int, column: str, text: str) -> tuple[Verdict, list[str]]:
    rows = [list(row) for row in ROWS]
    rows[i][("a", "alpha", "d", "theta").index(column)] = text
    report = graded_table(arm, rows)
    assert set(not_correct(report)) <= {(str(i + 1), column)}
    found = cell(report, str(i + 1), column)
    return found.verdict, codes(found)


@pytest.mark.parametrize(("i", "column", "text"), ACCEPTED)
def test_three_figures_are_enough(i: int, column: str, text: str, arm: Exercise) -> None:
    assert graded(arm, i, column, text) == (Verdict.CORRECT, ["rounded"])


@pytest.mark.parametrize(("i", "column", "text"), REFUSED)
def test_two_figures_are_not_enough(i: int, column: str, text: str, arm: Exercise) -> None:
    verdict, found = graded(arm, i, column, text)
    assert verdict is Verdict.INCORRECT
    assert found == [
        "distance_extra" if ROWS[i][("a", "alpha", "d", "theta").index(column)] == "0" else "value"
    ]


def test_an_exact_value_gets_no_note(arm: Exercise) -> None:
    report = graded_table(arm, ROWS)
    assert not_correct(report) == {}
    assert not [code for row in report.rows for found in row.cells for code in codes(found)]


@pytest.mark.parametrize(
    ("text", "verdict"),
    [
        ("-sqrt(2)/2", Verdict.CORRECT),
        ("-0.707", Verdict.CORRECT),
        ("-0.7071", Verdict.CORRECT),
        ("-cos(0.785)", Verdict.CORRECT),
        ("-0.7", Verdict.INCORRECT),
        ("-0.71", Verdict.INCORRECT),
    ],
)
def test_rounded_constants_in_a_pose_have_this_verdict(
    text: str, verdict: Verdict, arm: Exercise
) -> None:
    matrix = [["0"] * 4, ["0"] * 4, ["0", "0", text, "0"], ["0", "0", "0", "1"]]
    report = graded_pose(arm, matrix)
    assert cell(report, "3", "3").verdict is verdict
    note = [] if text.startswith("-sqrt") else ["rounded"]
    assert codes_at(report, "3", "3") == (note if verdict is Verdict.CORRECT else ["value"])


def test_the_note_costs_nothing_and_says_what_to_write(arm: Exercise) -> None:
    rows = [list(row) for row in ROWS]
    rows[1][1] = "3.1416"
    report = graded_table(arm, rows)
    assert (report.verdict, report.points) == (Verdict.CORRECT, report.max_points)
    [note] = cell(report, "2", "alpha").feedback
    assert note.severity is Severity.INFO
    assert "Write the exact number" in note.message


# The cell, a number just inside the limit (half a unit, or a whole one if cut off), and just
# outside.
NEAR = [
    (0, "a", "0.66667", "0.66668"),
    (0, "theta", "q1 + 1.57080", "q1 + 1.57081"),
    (0, "theta", "q1 + 1.57079", "q1 + 1.57078"),
    (1, "theta", "q2 + 0.0000000005", "q2 + 0.000000002"),
]


@pytest.mark.long
@pytest.mark.parametrize(("i", "column", "inside", "outside"), NEAR)
def test_no_verdict_depends_on_the_draw(
    i: int, column: str, inside: str, outside: str, arm: Exercise
) -> None:
    for seed in range(100):
        drawn = replace(arm, version=f"{arm.version} {seed}")
        assert graded(drawn, i, column, inside)[0] is Verdict.CORRECT
        assert graded(drawn, i, column, outside)[0] is Verdict.INCORRECT


@pytest.mark.parametrize("blanks", range(20))
def test_no_verdict_depends_on_blanks(blanks: int, arm: Exercise) -> None:
    # 0.051 is wrong for 0, and stays wrong if blanks are added to another cell.
    rows = [*ROWS[:1], ["0", "pi", "1000" + " " * blanks, "q2 + 0.051"]]
    assert list(not_correct(graded_table(arm, rows))) == [("2", "theta")]


# Two parallel axes: the offsets along them add up to 0.15005; the angles are off the 15° grid.
OWN_FRAMES = """
title = "Parallel joints"
source = "made for this test"
statement = "Two parallel joints, and one that is tilted."
[robot]
structure = "RRR"
convention = "standard"
joints = ["q1", "q2", "q3"]
table = [
    ["0.05", "0", "0.15005", "q1"], ["1.2", "1.234", "0", "q2"], ["0.3", "0", "0.2", "q3"],
]
[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
points = 12
convention = "standard"
frames = "free"
"""


# 0.15005 + 0.013 = 0.16305, which is rounded to 0.1631; π - 1.234 = 1.90759.
@pytest.mark.parametrize("angle", ["1.908", "1.9076", "1.90759"])
@pytest.mark.parametrize("offsets", [("-0.013", "0.1631"), ("0.1631", "-0.013")])
def test_rounded_offsets_and_angles_are_right_in_own_frames(
    offsets: tuple[str, str], angle: str, make_exercise: Callable[[str], Exercise]
) -> None:
    arm = make_exercise(OWN_FRAMES)
    rows = [
        ["0.05", "0", offsets[0], "q1"],
        ["-1.2", angle, offsets[1], "q2 + 3.14159"],
        ["0.3", "3.1416", "-0.200", "-q3 + 3.14159"],
    ]
    report = graded_table(arm, rows)
    if not_correct(report):
        pytest.fail(str(not_correct(report)))
    assert report.points == report.max_points


def test_a_wrong_short_length_is_found_beside_a_long_one(
    make_exercise: Callable[[str], Exercise],
) -> None:
    arm = make_exercise(OWN_FRAMES)
    rows = [
        ["0.0505", "0", "0", "q1"],
        ["1.20", "1.234", "0.15005", "q2"],
        ["0.3", "0", "0.2", "q3"],
    ]
    assert list(not_correct(graded_table(arm, rows))) == [("1", "a")]


@pytest.mark.parametrize("behind", [True, False])
def test_decimals_beyond_the_limit_count_as_written(
    behind: bool, catalogue: Mapping[str, Exercise]
) -> None:
    # Two correct rows and ten rows of random decimals are graded, and do not get full marks.
    garbage = [("0.371", "0.613", "0.829", "1.273")] * 10
    right = [("a1", "0", "0", "theta1"), ("a2", "0", "0", "theta2")]
    rows = [*right, *garbage] if behind else [*garbage, *right]
    report = graded_table(catalogue["planar-rr"], rows)
    assert report.verdict is not Verdict.CORRECT
    assert report.points < report.max_points


def test_decimals_beside_an_absent_variable_are_graded(
    catalogue: Mapping[str, Exercise],
) -> None:
    # Joint 3 of the Stanford arm slides, so that theta3 is absent from the samples.
    rows = [list(row) for row in EXACT.rows(STANFORD)]
    rows[2][3] = "theta3 + 0.127"
    report = graded_table(catalogue["stanford-arm"], rows)
    assert cell(report, "3", "theta").verdict is Verdict.INCORRECT


def test_a_decimal_that_is_divided_by_zero_is_wrong_without_a_warning(arm: Exercise) -> None:
    rows = [["2/3", "0.125/0", "2", "q1 + pi/2"], ["0", "pi", "1000", "q2"]]
    report = graded_table(arm, rows)
    assert cell(report, "1", "alpha").verdict is Verdict.INCORRECT


# One cell of a robot, right answers and wrong ones: a decimal with three figures or more must be
# within half a unit of its last place if rounded, and within a whole unit if cut off.
EDGES = [
    ("a", "0.9", ["0.9", "0.90", "0.900"], ["0.899", "0.8999", "0.901", "0.9001", "0.8995"]),
    ("a", "0.8995", ["0.899", "0.900", "0.8995"], ["0.898", "0.901", "0.8994", "0.8996", "0.90"]),
    ("a", "0.89949", ["0.899", "0.8995", "0.8994"], ["0.900", "0.8993", "0.8996"]),
    ("a", "0.89951", ["0.899", "0.900", "0.8995"], ["0.8994", "0.8996"]),
    ("a", "-0.8995", ["-0.899", "-0.900"], ["-0.898", "-0.901", "0.899"]),
    ("a", "0.001", ["0.001", "0.00100"], ["0.00101", "0.000999", "0.00"]),
    ("d", "12.345", ["12.3", "12.34", "12.35", "12.345"], ["12.4", "12.33", "12.36", "12.344"]),
    ("alpha", "90deg", ["1.57", "1.570", "1.571", "1.5707", "1.5708"], ["1.5706", "1.5709"]),
    ("alpha", "90deg", ["90.0deg", "90deg"], ["89.9deg", "90.1deg", "1.569", "1.572"]),
    ("alpha", "0.5", ["28.6deg", "28.64deg", "28.65deg"], ["28.5deg", "28.7deg", "28.66deg"]),
    ("theta", "120deg", ["2.094", "2.0943", "2.0944"], ["2.093", "2.095", "2.0942", "2.0945"]),
]
ONE_LINK = """
title = "Two joints"
source = "made for this test"
statement = "Two joints."
[robot]
structure = "RR"
convention = "standard"
joints = ["q1", "q2"]
table = [["{a}", "{alpha}", "{d}", "q1 + {theta}"], ["0.3", "0", "0", "q2"]]
[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
points = 8
convention = "standard"
frames = "{frames}"
"""
LINK = {"a": "0.5", "alpha": "90deg", "d": "0.4", "theta": "30deg"}


@pytest.mark.long
@pytest.mark.parametrize("frames", ["given", "free"])
@together(("column", "true", "right", "wrong"), EDGES)
def test_decimals_are_right_up_to_the_limit_of_rounding(
    column: str,
    true: str,
    right: list[str],
    wrong: list[str],
    frames: str,
    make_exercise: Callable[[str], Exercise],
) -> None:
    exercise = make_exercise(ONE_LINK.format(**{**LINK, column: true}, frames=frames))
    for text in [*right, *wrong]:
        written = {**LINK, column: text}
        first = [written["a"], written["alpha"], written["d"], f"q1 + {written['theta']}"]
        report = graded_table(exercise, [first, ["0.3", "0", "0", "q2"]])
        is_right = report.points == report.max_points
        assert is_right == (text in right), text


# The axis of a prismatic joint may be anywhere: turning all later links by a hundredth of a degree
# compensates for a length.
SLIDING = """
title = "A sliding joint"
source = "made for this test"
statement = "Two joints turn, and one slides."
[robot]
structure = "RPR"
convention = "standard"
joints = ["q1", "q2", "q3"]
table = [
    ["{length}", "90deg", "0.9", "q1 + 90deg"], ["1.2", "180deg", "q2", "90deg"],
    ["1.2", "0", "0.4", "q3 + 30deg"],
]
[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
points = 8
convention = "standard"
frames = "free"
"""


@together(
    ("length", "text", "is_right"),
    [
        *(("0.9", text, True) for text in ("0.9", "0.900", "9/10")),
        *(("0.9", text, False) for text in ("0.899", "0.901", "0.8999", "0.9001", "0.8991")),
        *(("0.89949", text, True) for text in ("0.899", "0.8995", "0.8994")),
        *(("0.89949", text, False) for text in ("0.900", "0.8993", "0.8996", "0.898")),
    ],
)
def test_a_rounded_right_angle_does_not_excuse_a_wrong_length(
    length: str, text: str, is_right: bool, make_exercise: Callable[[str], Exercise]
) -> None:
    exercise = make_exercise(SLIDING.format(length=length))
    report = graded_table(
        exercise,
        [
            [text, "1.5708", "0.9", "q1 + 1.5708"],
            ["1.2", "3.1416", "q2", "1.5708"],
            ["1.2", "0", "0.4", "q3 + 0.5236"],
        ],
    )
    wrong = set(not_correct(report))
    assert wrong == (set() if is_right else {("1", "a")})
