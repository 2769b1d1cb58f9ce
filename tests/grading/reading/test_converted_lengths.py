"""Refuse a length with a unit, and suggest the number in the exercise's unit."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading.reading import preview_entries
from dh_grader.grading.reading.entries import converted


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
