import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("q1 % joint variable", "comment", "% joint variable", "q1"),
    ("q1 # joint variable", "comment", "# joint variable", "q1"),
    ("q1 /* joint variable */", "comment", "/* joint variable */", "q1"),
    ("pi/2 % ninety degrees", "comment", "% ninety degrees", "pi/2"),
    ("l1//l2", "comment", "//", "l1/l2"),
    ("k//2", "comment", "//", "k/2"),
]

FINE = [
    ("l1/l2", "l1/l2"),
    ("l1*l2", "l1*l2"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
