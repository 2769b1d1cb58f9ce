import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("zero", "prose", "zero", "0"),
    ("none", "prose", "none", None),
    ("None", "prose", "None", None),
    ("n/a", "prose", "n/a", None),
    ("N/A", "prose", "N/A", None),
    ("null", "prose", "null", None),
    ("variable", "prose", "variable", None),
    ("joint variable", "prose", "joint variable", None),
    ("depends on theta", "prose", "depends on theta", None),
    ("same as above", "prose", "same as above", None),
    ("it is the joint angle", "prose", "it is the joint angle", None),
    ("unknown", "prose", "unknown", None),
    ("?", "prose", "?", None),
    ("...", "prose", "...", None),
]

FINE = [
    ("k", "k"),
    ("sin cos k", "sin(cos(k))"),
    ("l_base", "l_base"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
