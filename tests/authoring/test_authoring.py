"""Test how exercises are written and examined."""

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from dh_grader.authoring import (
    Level,
    Remark,
    UnusableIdError,
    examine,
    exercise_template,
    failed_checks,
)
from dh_grader.catalogue import Exercise, load_exercise, shipped_folder
from dh_grader.translations import LANGUAGES, told

from tests.grading.support.bare_numbers import BARE, BareExercise
from tests.shipped import sampled
from tests.together import together

# --- Write exercise files for tests, and return the remarks about them

Make = Callable[[str], Exercise]

HEAD = """
title = "An arm"
source = "made for this test"
statement = "Two joints."
"""
ROBOT = """
[robot]
structure = "RP"
convention = "standard"
joints = ["theta1", "d2"]
table = [["0", "90deg", "a1", "theta1"], ["0", "0", "d2", "0"]]
[symbols]
a1 = { kind = "length", range = [0.3, 0.9], description = "a length" }
d2 = { kind = "length", range = [0.2, 0.8], description = "joint 2" }
"""
POSE = """
[[parts]]
id = "pose"
kind = "transform"
title = "Pose"
points = 4
"""


def remarks_on(make: Make, text: str, *changes: tuple[str, str]) -> list[Remark]:
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    return examine(make(text))


def only(remarks: list[Remark], level: Level) -> Remark:
    [remark] = remarks
    assert remark.level is level
    return remark


def robot(structure: str, table: str) -> str:
    joints = [f"q{i + 1}" for i in range(len(structure))]
    return f"""
[robot]
structure = "{structure}"
convention = "standard"
joints = {joints}
table = {table}
[symbols]
a1 = {{ kind = "length", range = [0.3, 0.9], description = "a length" }}
"""


# --- Template


def test_a_new_file_gets_no_remarks(tmp_path: Path) -> None:
    file = tmp_path / "elbow-arm.toml"
    file.write_text(exercise_template("elbow-arm"), encoding="utf-8")
    exercise = load_exercise(file)
    assert (exercise.id, exercise.title) == ("elbow-arm", "Elbow arm")
    assert examine(exercise) == []


def test_the_template_has_comments() -> None:
    lines = exercise_template("arm").splitlines()
    assert sum(line.startswith("#") for line in lines) >= 20
    assert max(map(len, lines)) <= 110


@pytest.mark.parametrize(
    "exercise_id",
    ["", "Arm", "2arm", "my arm", "../arm", "a/b", "arm.toml", "arm-", "é", "a" * 61, "arm\n"],
)
def test_an_invalid_id_is_refused(exercise_id: str) -> None:
    with pytest.raises(UnusableIdError, match="small letters"):
        exercise_template(exercise_id)


# --- Test each warning about a faulty exercise file

RIGHT_ROWS = '[["c1", 0, "s1", "d2 s1"], ["s1", 0, "-c1", "-d2 c1"], [0, 1, 0, "a1"], [0, 0, 0, 1]]'
WRONG_ROWS = RIGHT_ROWS.replace('"a1"', '"-a1"')
# The position is worth 2 points: its three entries 0.67, 0.67 and 0.66, for the height.
CHECKS = f"""
[[checks]]
title = "The pose"
kind = "right"
answers.pose = {RIGHT_ROWS}
[[checks]]
title = "With q2"
kind = "equivalent"
answers.pose = {RIGHT_ROWS.replace("d2", "q2")}
[[checks]]
title = "Wrong height"
kind = "wrong"
answers.pose = {WRONG_ROWS}
expect.pose = {{ points = 3.34, verdict = "partial", codes = ["sign"] }}
[[checks]]
title = "Nothing"
kind = "wrong"
answers.pose = "("
expect.pose = {{ points = 0, verdict = "unreadable" }}
"""
GOOD = HEAD + ROBOT + POSE + CHECKS


def test_a_correct_file_gets_no_remarks(make_exercise: Make) -> None:
    assert remarks_on(make_exercise, GOOD) == []


@pytest.mark.long
@pytest.mark.parametrize(
    "exercise_id", sampled(sorted(file.stem for file in shipped_folder().glob("*.toml")), 9)
)
def test_the_shipped_exercises_have_no_failures(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    remarks = examine(catalogue[exercise_id])
    assert [each for each in remarks if each.level is Level.FAILED] == []
    # The symbol l stays in this exercise, because it is in the course's notes.
    known = {("dh-conditions", "symbols.l")}
    assert {(exercise_id, remark.field) for remark in remarks} <= known


@pytest.mark.long
def test_the_checks_of_all_shipped_exercises_hold(catalogue: Mapping[str, Exercise]) -> None:
    failed = {name: [*failed_checks(exercise)] for name, exercise in catalogue.items()}
    assert {name: remarks for name, remarks in failed.items() if remarks} == {}


# A replacement, the number of the check that fails, and words of the remark.
FAILURES: dict[str, tuple[tuple[str, str], int, str]] = {
    "a right answer that is wrong": ((RIGHT_ROWS, WRONG_ROWS), 0, "should get full marks; it got"),
    "an equivalent answer that is wrong": (('"q2 s1"', '"-q2 s1"'), 1, "should get full marks"),
    "a wrong answer that is right": ((WRONG_ROWS, RIGHT_ROWS), 2, "should lose points"),
    "other points": (
        ("points = 3.34", "points = 3"),
        2,
        "should get 3 points; it got partial, 3.34",
    ),
    "another verdict": (('"partial"', '"incorrect"'), 2, "should be incorrect; it got partial"),
    "another code": (
        ('["sign"]', '["sign", "half_turn"]'),
        2,
        "told half_turn, but was told",
    ),
    "a code where none is": (
        ('points = 0, verdict = "unreadable"', 'codes = ["twist"]'),
        3,
        "should be told twist, but was told the codes",
    ),
    "follow-through": (
        ('verdict = "unreadable"', "follow_through = true"),
        3,
        "should count as following",
    ),
    "degrees": (
        ('kind = "equivalent"', 'kind = "equivalent"\nangle_unit = "degrees"'),
        1,
        "",
    ),
}


@pytest.mark.parametrize("name", FAILURES)
def test_a_failed_check_is_reported(name: str, make_exercise: Make) -> None:
    change, place, text = FAILURES[name]
    if name == "degrees":
        change = ('"s1", "q2 s1"]', '"sin(theta1 + 2 pi - 360)", "q2 s1"]')
        assert remarks_on(make_exercise, GOOD, change)
        degrees = ('title = "With q2"', 'title = "With q2"\nangle_unit = "degrees"')
        assert remarks_on(make_exercise, GOOD, change, degrees) == []
        return
    remarks = remarks_on(make_exercise, GOOD, change)
    failures = [each for each in remarks if each.level is Level.FAILED]
    assert {each.field for each in failures} == {f"checks[{place}]"}
    assert any(text in each.text for each in failures), failures
    german = [told(each.text, LANGUAGES["de"].translation) for each in failures]
    assert all(": pose sollte " in each for each in german), german


@pytest.mark.long
def test_a_model_answer_that_is_too_long_is_reported(make_exercise: Make) -> None:
    # The model pose of a robot with ten skew axes has an entry over the length limit.
    rows = ", ".join(f'["a1", "90deg", "a1", "q{i}"]' for i in range(1, 11))
    remarks = remarks_on(make_exercise, HEAD + robot("R" * 10, f"[{rows}]") + POSE)
    [remark] = [each for each in remarks if each.level is Level.FAILED]
    assert remark.field == "parts[0]"
    said = "the right answer to pose is too long: one entry has more than 8000 characters; "
    assert remark.text.startswith(said)


@pytest.mark.parametrize(
    ("dropped", "said"),
    [
        (range(4), "0 right, 0 equivalent, 0 wrong; write 1 right, 1 equivalent, 2 wrong"),
        ([0], "0 right, 1 equivalent, 2 wrong"),
        ([1], "1 right, 0 equivalent, 2 wrong"),
        ([3], "1 right, 1 equivalent, 1 wrong"),
    ],
)
def test_too_few_checks_are_reported(dropped: list[int], said: str, make_exercise: Make) -> None:
    checks = CHECKS.split("[[checks]]")[1:]
    kept = ["[[checks]]" + each for i, each in enumerate(checks) if i not in dropped]
    remarks = remarks_on(make_exercise, HEAD + ROBOT + POSE + "".join(kept))
    remark = only(remarks, Level.WARNING)
    assert remark.field == "checks"
    assert remark.text.startswith(said)


def named(name: str) -> tuple[tuple[str, str], ...]:
    return (
        ('"a1", "theta1"', f'"{name}", "theta1"'),
        ("a1 = {", f"{name} = {{"),
    )


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("e", "Euler's number"),
        ("i", "imaginary"),
        ("j", "imaginary"),
        ("l", "the digit 1"),
        ("O", "the digit 0"),
        ("c1", "takes the place of the shorthand c1 for a cosine"),
        ("S1", "takes the place of the shorthand S1 for a sine"),
        ("q1", "is also what students call theta1"),
        ("q2", "is also what students call d2"),
        ("D2", "looks like d2"),
    ],
)
def test_an_ambiguous_name_gets_a_warning(name: str, said: str, make_exercise: Make) -> None:
    remarks = remarks_on(make_exercise, HEAD + ROBOT + POSE, *named(name))
    found = [each for each in remarks if each.field.startswith("symbols")]
    assert any(said in only([each], Level.WARNING).text for each in found), remarks


@pytest.mark.parametrize("name", ["c3", "theta2", "d1", "L", "width", "s"])
def test_an_unambiguous_name_gets_no_warning(name: str, make_exercise: Make) -> None:
    # No joint variable has such a name: there is no joint 3, joint 2 slides, joint 1 turns.
    remarks = remarks_on(make_exercise, HEAD + ROBOT + POSE, *named(name))
    expected = {"symbols.s"} if name == "s" else set()
    assert {each.field for each in remarks if each.field.startswith("symbols")} == expected


def test_an_unused_symbol_gets_a_warning(make_exercise: Make) -> None:
    unused = ("[symbols]", '[symbols]\nk = { kind = "number", description = "a number" }')
    remark = only(remarks_on(make_exercise, GOOD, unused), Level.WARNING)
    assert remark.field == "symbols.k"
    assert "is in no formula" in remark.text


@pytest.mark.parametrize(
    ("limits", "said"),
    [
        ("[-0.3, 0.9]", "holds 0"),
        ("[0, 0.9]", "holds 0"),
        ("[0.9, 0.901]", "so narrow that the number 0.9"),
        ("[0.0005, 0.9]", "goes from 0.0005 to 0.9"),
        ("[300, 2000]", "reaches 0.8 where a1 reaches 2000"),
    ],
)
def test_a_bad_range_gets_a_warning(limits: str, said: str, make_exercise: Make) -> None:
    remark = only(remarks_on(make_exercise, GOOD, ("[0.3, 0.9]", limits)), Level.WARNING)
    assert said in remark.text


def test_the_range_of_a_prismatic_joint_may_contain_zero(make_exercise: Make) -> None:
    assert remarks_on(make_exercise, GOOD, ("[0.2, 0.8]", "[-0.4, 0.4]")) == []


EXPECTED = 'expected = ["d2*sin(theta1)", "-d2*cos(theta1)", "a1"]'


def position(part_id: str, more: str = "") -> str:
    return f'\n[[parts]]\nid = "{part_id}"\nkind = "position"\ntitle = "Tip"\n{more}\n'


@pytest.mark.parametrize("more", ["", EXPECTED, 'from = 0\nto = "tool"'])
def test_two_parts_with_the_same_answer_get_a_warning(more: str, make_exercise: Make) -> None:
    text = HEAD + ROBOT + POSE + position("tip") + position("again", more) + CHECKS
    remark = only(remarks_on(make_exercise, text), Level.WARNING)
    assert remark.field == "parts[2]"
    assert "again has the same answer as tip" in remark.text


def test_four_parts_with_the_same_answer_get_one_warning(make_exercise: Make) -> None:
    parts = "".join(position(name) for name in ("tip", "again", "third", "fourth"))
    remark = only(remarks_on(make_exercise, HEAD + ROBOT + POSE + parts + CHECKS), Level.WARNING)
    assert "again, third, fourth have the same answer as tip" in remark.text


@pytest.mark.parametrize(
    "more", ["to = 1", "home = true", 'coordinates = "xy"', 'from = "tool"\nto = "base"']
)
def test_parts_with_different_answers_get_no_warning(more: str, make_exercise: Make) -> None:
    text = HEAD + ROBOT + POSE + position("tip") + position("other", more) + CHECKS
    assert remarks_on(make_exercise, text) == []


def test_two_transforms_without_a_row_are_different_tasks(make_exercise: Make) -> None:
    row = '\n[[parts]]\nid = "{}"\nkind = "dh_row"\ntitle = "Row"\ntransform = [{}, [0, 0, 0, 1]]\n'
    one = '[0, 0, 1, "a1"], [0, 1, 0, 0], [-1, 0, 0, 0]'
    other = '[1, 0, 0, 0], [0, 0, -1, "a1"], [0, 1, 0, 0]'
    both = HEAD + ROBOT + POSE + row.format("one", one) + row.format("two", other) + CHECKS
    assert remarks_on(make_exercise, both) == []
    twice = HEAD + ROBOT + POSE + row.format("one", one) + row.format("two", one) + CHECKS
    assert only(remarks_on(make_exercise, twice), Level.WARNING).field == "parts[2]"


LOST: dict[str, tuple[str, str, str]] = {
    "one line": ("RR", '[["0", "0", "a1", "q1"], ["a1", "0", "0", "q2"]]', "turn about one line"),
    "one direction": ("PP", '[["0", "0", "q1", "0"], ["a1", "0", "q2", "0"]]', "slide in one"),
    "four in a plane": (
        "RRRR",
        str([["a1", "0", "0", f"q{i}"] for i in range(1, 5)]),
        "in 3 ways only",
    ),
}


@pytest.mark.parametrize("name", LOST)
def test_a_reference_that_lost_a_degree_of_freedom_gets_a_warning(
    name: str, make_exercise: Make
) -> None:
    structure, table, said = LOST[name]
    remarks = remarks_on(make_exercise, HEAD + robot(structure, table) + POSE)
    [remark] = [each for each in remarks if each.field == "robot"]
    assert said in only([remark], Level.WARNING).text


@pytest.mark.long
def test_a_redundant_arm_with_six_degrees_of_freedom_gets_no_warning(
    catalogue: Mapping[str, Exercise],
) -> None:
    assert not [each for each in examine(catalogue["baxter-left-arm"]) if each.field == "robot"]


TABLE = """
[[parts]]
id = "{}"
kind = "dh_table"
title = "Table"
convention = "standard"
{}
"""


def test_tables_with_given_and_free_frames_are_different_tasks(make_exercise: Make) -> None:
    # An exercise may ask for a table in given frames, and for one in free frames.
    drawn, free = TABLE.format("drawn", ""), TABLE.format("free", 'frames = "free"')
    assert remarks_on(make_exercise, HEAD + ROBOT + POSE + drawn + free + CHECKS) == []
    again = HEAD + ROBOT + POSE + drawn + TABLE.format("again", "") + CHECKS
    assert only(remarks_on(make_exercise, again), Level.WARNING).field == "parts[2]"


def test_an_angle_without_a_unit_is_radians_in_the_model_answer_too(make_exercise: Make) -> None:
    # The author's 0.7 must stay 0.7 rad. In a submission in degrees it would mean 0.7°.
    text = HEAD + robot("R", '[["a1", 0.7, "0", "q1 + 0.4"]]') + TABLE.format("table", "") + POSE
    assert [each for each in remarks_on(make_exercise, text) if each.level is Level.FAILED] == []


@together("bare", BARE)
def test_an_exercise_without_symbols_has_no_failures(
    bare: BareExercise, make_exercise: Make
) -> None:
    remarks = remarks_on(make_exercise, bare.text)
    assert [each.field for each in remarks if each.level is Level.FAILED] == []


# --- Test the warnings about degrees without a unit in exercise files


def table_with(alpha: str, theta: str) -> str:
    return HEAD + robot("R", f'[["a1", {alpha}, "0", {theta}]]') + POSE


def of_units(remarks: list[Remark]) -> list[Remark]:
    return [each for each in remarks if "looks like degrees" in each.text]


# The twist and the angle of a row, the cell with the warning, and its text.
UNITS_BARE: list[tuple[str, str, str, str]] = [
    ("90", '"q1"', "alpha", "90 looks like degrees; did you mean 90deg?"),
    ('"-90"', '"q1"', "alpha", "90 looks like degrees; did you mean 90deg?"),
    ('"180/2"', '"q1"', "alpha", "(180/2) looks like degrees; did you mean (180/2)deg?"),
    ("0", '"q1 + 90"', "theta", "90 looks like degrees; did you mean 90deg?"),
    ("0", '"q1 - 22.5"', "theta", "22.5 looks like degrees; did you mean 22.5deg?"),
]


@pytest.mark.parametrize(("alpha", "theta", "column", "text"), UNITS_BARE)
def test_degrees_without_a_unit_get_a_warning(
    alpha: str, theta: str, column: str, text: str, make_exercise: Make
) -> None:
    remark = only(of_units(remarks_on(make_exercise, table_with(alpha, theta))), Level.WARNING)
    assert remark.field == f"robot.table[0].{column}"
    assert all(piece in remark.text for piece in text.split(" *"))


@pytest.mark.parametrize(
    ("alpha", "theta"),
    [
        ("1.5708", '"q1"'),
        ('"90deg"', '"q1 + 90°"'),
        ('"2 pi"', '"q1 - 5 pi/2"'),
        ('"2*atan2(30, 40)"', '"q1 + 6.28"'),
    ],
)
def test_radians_and_degrees_with_a_unit_get_no_warning(
    alpha: str, theta: str, make_exercise: Make
) -> None:
    assert of_units(remarks_on(make_exercise, table_with(alpha, theta))) == []


def vector(quantity: str, expected: str) -> str:
    component = f'{{ name = "v", quantity = "{quantity}", expected = "{expected}" }}'
    return f"""
[[parts]]
id = "v"
kind = "vector"
title = "Vector"
components = [{{ name = "u", quantity = "length", expected = "a1" }}, {component}]
"""


@pytest.mark.parametrize(
    ("quantity", "expected", "bare"),
    [
        ("angle", "90 - theta1", True),
        ("length", "a1*sin(theta1 + 90)", True),
        ("length", "90", False),
        ("length", "90*a1", False),
        ("number", "10*sin(theta1)", False),
        ("number", "sin(10*theta1)", False),
    ],
)
def test_degrees_without_a_unit_in_a_part_get_a_warning(
    quantity: str, expected: str, bare: bool, make_exercise: Make
) -> None:
    text = HEAD + ROBOT + POSE + vector(quantity, expected)
    fields = [remark.field for remark in of_units(remarks_on(make_exercise, text))]
    assert fields == ["parts[1].components[1].expected"] * bare


BELOW = "[0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]"
# Parts whose formulas have an angle, and its place.
PLACES: dict[str, tuple[str, str]] = {
    "steps": ('kind = "rotation"\nsteps = [{ axis = "x", angle = "90" }]', "steps[0].angle"),
    "Euler": (
        'kind = "euler_angles"\nsequence = "ZYZ"\nexpected = ["theta1", "45", 0]',
        "expected[1]",
    ),
    "matrix": (
        'kind = "matrix"\nquantity = ["length", "angle"]\nexpected = [[90, 90]]',
        "expected[0][1]",
    ),
    "position": ('kind = "position"\nexpected = [0, "cos(45)", 90]', "expected[1]"),
    "row": (
        f'kind = "dh_row"\ntransform = [[1, 0, 0, "sin(45)"], {BELOW}]',
        "transform[0][3]",
    ),
    "screws": (
        'kind = "screw_axes"\nframe = "space"\nexpected = [[0, 0, 1, 0, "cos(45)", 0]]',
        "expected[0][4]",
    ),
}


@pytest.mark.parametrize("name", PLACES)
def test_the_warning_names_the_place_of_the_angle(name: str, make_exercise: Make) -> None:
    fields, place = PLACES[name]
    text = f'{HEAD}{ROBOT}{POSE}\n[[parts]]\nid = "other"\ntitle = "Other"\n{fields}\n'
    assert [each.field for each in of_units(remarks_on(make_exercise, text))] == [
        f"parts[1].{place}"
    ]


def test_degrees_without_a_unit_in_a_screw_robot_get_a_warning(make_exercise: Make) -> None:
    screws = """
[robot]
structure = "R"
joints = ["q1"]
home = [[1, 0, 0, "a1*cos(45)"], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
screws = [[0, 0, 1, 0, "-a1*cos(60)", 0]]
[symbols]
a1 = { kind = "length", range = [0.3, 0.9], description = "a length" }
"""
    remarks = of_units(remarks_on(make_exercise, HEAD + screws + POSE))
    assert [each.field for each in remarks] == ["robot.home[0][3]", "robot.screws[0][4]"]


def test_degrees_in_the_reference_are_the_first_remark(make_exercise: Make) -> None:
    text = table_with("90", '"q1"').replace(POSE, "")
    remarks = remarks_on(
        make_exercise,
        f"""{text}
[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
convention = "standard"

[[checks]]
title = "The right table"
kind = "right"
answers.table = [["a1", "90deg", "0", "q1"]]
""",
    )
    assert [each.level for each in remarks].count(Level.FAILED) > 0
    assert remarks[0].field == "robot.table[0].alpha"
    assert "angles without a unit are in radians, and 90 looks like degrees" in remarks[0].text
