"""Test the warnings about degrees without a unit in exercise files."""

import pytest
from dh_grader.authoring import Level, Remark

from tests.authoring.files import HEAD, POSE, ROBOT, Make, only, remarks_on, robot


def table_with(alpha: str, theta: str) -> str:
    return HEAD + robot("R", f'[["a1", {alpha}, "0", {theta}]]') + POSE


def of_units(remarks: list[Remark]) -> list[Remark]:
    return [each for each in remarks if "looks like degrees" in each.text]


# The twist and the angle of a row, the cell with the warning, and its text.
BARE: list[tuple[str, str, str, str]] = [
    ("90", '"q1"', "alpha", "90 looks like degrees; did you mean 90deg?"),
    ('"-90"', '"q1"', "alpha", "90 looks like degrees; did you mean 90deg?"),
    ('"180/2"', '"q1"', "alpha", "(180/2) looks like degrees; did you mean (180/2)deg?"),
    ("0", '"q1 + 90"', "theta", "90 looks like degrees; did you mean 90deg?"),
    ("0", '"q1 - 22.5"', "theta", "22.5 looks like degrees; did you mean 22.5deg?"),
]


@pytest.mark.parametrize(("alpha", "theta", "column", "text"), BARE)
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
