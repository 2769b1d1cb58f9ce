"""Test the sentences that describe the shape of an answer, such as 4 × 4."""

import re
from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise

GIVEN = "base frame, tool frame, directions given"
FREE = "standard convention; frames free"
DRAWN = "modified convention; frames"
CELLS = "the columns a, alpha, d, theta"
TRANSFORM = "a matrix of 4 rows and 4 columns"
SCREWS = "a list of screw axes, 6 numbers (ω; v) for each of 1, 2, 3"
EULER = "about z (angle), about y (angle), about z (angle)"

EXPECTED = {
    "planar-rr": [
        f"a table with the rows 1, 2 and {CELLS}; {FREE}; {GIVEN}",
        f"a list of the matrices A1, A2, each of 4 rows and 4 columns; {FREE}",
        TRANSFORM,
        "a list: x (length), y (length)",
        "a list: p_x (length), p_y (length), φ (angle)",
    ],
    "dh-conditions": ["one row with a, alpha, d, theta, or none; standard convention"] * 4,
    "spherical-wrist": [
        f"a table with the rows 4, 5, 6 and {CELLS}; {FREE}; {GIVEN}",
        TRANSFORM,
        "a matrix of 3 rows and 3 columns",
        "a list: x (length), y (length), z (length)",
        f"a list: {EULER}; ZYZ about moving axes",
    ],
    "planar-rpr-poe": [
        TRANSFORM,
        f"{SCREWS}; space frame; directions given",
        f"{SCREWS}; body frame; directions given",
        TRANSFORM,
        "a list: x (length), y (length)",
    ],
    "planar-rrr-drawn": [
        f"a table with the rows 1, 2, 3, e and {CELLS}; {DRAWN}, {GIVEN}",
        f"a list of the matrices A1, A2, A3, Ae, each of 4 rows and 4 columns; {DRAWN} given",
    ],
}


def answers(exercise: Exercise) -> list[str]:
    return [part.shape(exercise.reference).in_words() for part in exercise.parts]


@pytest.mark.parametrize("exercise_id", EXPECTED)
def test_the_shape_of_each_answer_in_words(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    assert answers(catalogue[exercise_id]) == EXPECTED[exercise_id]


def test_every_part_of_the_catalogue_has_a_sentence(catalogue: Mapping[str, Exercise]) -> None:
    for exercise in catalogue.values():
        for sentence in answers(exercise):
            assert re.fullmatch(r"(?:a|one) [^{}\[\]]+", sentence)
