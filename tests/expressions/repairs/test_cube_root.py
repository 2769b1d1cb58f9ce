import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("∛8", "cube_root", "∛", None),
    (r"\sqrt[3]{8}", "cube_root", r"\sqrt[", None),
    (r"\sqrt[3]{l_1}", "cube_root", r"\sqrt[", None),
]

FINE = [
    ("8^(1/3)", "8^(1/3)"),
    (r"\sqrt{8}", "sqrt(8)"),
    ("√8", "sqrt(8)"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
