"""Numbers without a unit are degrees if the student works in degrees."""

from math import cos, pi, sin

import numpy as np
import pytest
from dh_grader.expressions import Kind, Vocabulary, read
from numpy.typing import NDArray

from tests.together import together

Values = dict[str, NDArray[np.float64]]

Q1, L1, K, BETA = 0.3, 1.1, 2.0, 0.25

ANGLES = [
    ("0", 0.0),
    ("90", pi / 2),
    ("-90", -pi / 2),
    ("180/2", pi / 2),
    ("90*1", pi / 2),
    ("q1 + 90", Q1 + pi / 2),
    ("q1* - 90", Q1 - pi / 2),
    ("90 - q1", pi / 2 - Q1),
    ("2*(q1+45)", 2 * (Q1 + pi / 4)),
    ("(q1 + 90)/2", (Q1 + pi / 2) / 2),
    ("-(q1 - 90)", pi / 2 - Q1),
    ("abs(q1 - 90)", pi / 2 - Q1),
    ("β + 45", BETA + pi / 4),
    ("k*90", K * pi / 2),
    ("90k", K * pi / 2),
    ("90/k", pi / 4),
    ("2q1", 2 * Q1),
    ("90deg", pi / 2),
    ("1.5rad", 1.5),
    ("pi/2", pi / 2),
    ("q1 + pi/2", Q1 + pi / 2),
    ("atan2(1,1)", pi / 4),
    ("2*atan(1)", pi / 2),
    ("asin(0.5) + 60", pi / 2),
    ("atan2(sin(30), cos(30))", pi / 6),
    ("sqrt(8100)", pi / 2),
]

NUMBERS = [
    ("90", 90.0),
    ("cos(60)", 0.5),
    ("sin 30", 0.5),
    ("sin90", 1.0),
    ("cos(q1+90)", -sin(Q1)),
    ("l1*cos(60) + 30", L1 * 0.5 + 30),
    ("sin(pi/6)", 0.5),
    ("sin(2*15)", 0.5),
    ("c1 + cos(0)", cos(Q1) + 1),
    ("sin(asin(0.5))", 0.5),
    ("exp(sin(90))", np.e),
    ("-sqrt(sin(90))", -1.0),
    ("(sin(90))deg", pi / 180),
]


@together(
    ("text", "quantity", "expected"),
    [
        *((text, "angle", value) for text, value in ANGLES),
        *((text, "number", value) for text, value in NUMBERS),
    ],
)
def test_bare_angles_are_degrees(
    text: str, quantity: Kind, expected: float, arm: Vocabulary, values: Values
) -> None:
    expression = read(text, arm, quantity=quantity, angle_unit="degrees")
    assert np.ravel(expression.evaluate(values)) == pytest.approx([expected], rel=1e-12)


@pytest.mark.parametrize(
    ("text", "span"), [("pi/2", (0, 4)), ("q1 + π/2", (5, 8)), ("l1 cos(q1 - pi)", (12, 14))]
)
def test_a_constant_with_pi_is_radians(text: str, span: tuple[int, int], arm: Vocabulary) -> None:
    expression = read(text, arm, quantity="angle", angle_unit="degrees")
    assert [(note.code, note.span) for note in expression.notes] == [("radians_in_degrees", span)]


def test_in_radians_a_number_keeps_its_value(arm: Vocabulary) -> None:
    assert read("90", arm, quantity="angle").evaluate({}) == 90.0


def test_in_degrees_a_length_keeps_its_value(arm: Vocabulary) -> None:
    assert read("90", arm, quantity="length", angle_unit="degrees").evaluate({}) == 90.0


@together("text", [text for text, _ in ANGLES])
def test_printed_text_reads_back_in_degrees(text: str, arm: Vocabulary) -> None:
    tree = read(text, arm, quantity="angle", angle_unit="degrees")
    again = read(tree.text(), arm, quantity="angle", angle_unit="degrees")
    assert again.tree == tree.tree
