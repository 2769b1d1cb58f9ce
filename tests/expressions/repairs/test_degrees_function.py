import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("acosd(0.5)", "degrees_function", "acosd", "acos(0.5)"),
    ("asind(0.5)", "degrees_function", "asind", "asin(0.5)"),
    ("atan2d(1, 1)", "degrees_function", "atan2d", "atan2(1, 1)"),
    ("rad2deg(q1)", "degrees_function", "rad2deg", "(q1)"),
    ("np.rad2deg(pi)", "degrees_function", "rad2deg", "(pi)"),
]

FINE = [
    ("acos(0.5)", "acos(0.5)"),
    ("cosd(60)", "cos(60deg)"),
    ("deg2rad(90)", "90deg"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
