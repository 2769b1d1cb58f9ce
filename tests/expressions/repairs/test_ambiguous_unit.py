import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("2deg(q1)", "ambiguous_unit", "deg", None),
    ("degrees(90)", "ambiguous_unit", "degrees", None),
    ("radians(90)", "ambiguous_unit", "radians", None),
]

FINE = [
    ("90deg", "90deg"),
    ("deg(90)", "90deg"),
    ("np.radians(90)", "90deg"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
