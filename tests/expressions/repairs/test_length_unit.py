import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("0.5 m", "length_unit", "m", "0.5"),
    ("0.5m", "length_unit", "m", "0.5"),
    ("30cm", "length_unit", "cm", None),
    ("30 cm", "length_unit", "cm", None),
    ("12 mm", "length_unit", "mm", None),
    ("l1 m", "length_unit", "m", "l1"),
    ("2 in", "length_unit", "in", None),
    ("0.5 meters", "length_unit", "meters", "0.5"),
]

FINE = [
    ("0.5", "0.5"),
    ("1.2 rad", "1.2rad"),
    ("90 deg", "90deg"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
