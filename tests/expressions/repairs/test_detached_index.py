import pytest

from service.expressions import ExpressionError, read
from tests.expressions.corpus_files import ROBOT
from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("theta 1", "theta 1", "theta1"),
    ("l1*cos(q 1)", "q 1", "l1*cos(q1)"),
    ("c 12", "c 12", "c12"),
    ("θ 1 + θ 2", "θ 1", "θ1 + θ2"),
    (r"\theta_1 + q_ 2", "q_ 2", r"\theta_1 + q2"),
]
FINE = [
    ("theta1", "theta1"),
    ("sin 12", "sin(12)"),
    ("k*2", "k*2"),
]


@pytest.mark.parametrize(("text", "part", "suggestion"), BROKEN)
def test_refused(text: str, part: str, suggestion: str) -> None:
    refuse(text, "detached_index", part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)


def test_the_space_is_what_is_wrong() -> None:
    with pytest.raises(ExpressionError) as caught:
        read("l1 + theta 1", ROBOT)
    told = "In theta 1 a name and its index must stand together, without a space."
    assert caught.value.message == told
