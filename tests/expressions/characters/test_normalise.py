"""Read LaTeX commands next to letters and digits."""

import pytest
from dh_grader.expressions import Symbol, Vocabulary, read


@pytest.mark.parametrize(
    ("text", "meaning"),
    [
        (r"a\sin q_1", "a*sin(theta1)"),
        (r"a\cos q_1", "a*cos(theta1)"),
        (r"a\,\mathrm{cos}\,q_1", "a*cos(theta1)"),
        (r"a\operatorname{sin}q_1", "a*sin(theta1)"),
        (r"a\mathrm{sin}(q_1)", "a*sin(theta1)"),
        (r"\sin\mathrm{d}", "sin(d)"),
        (r"\cos d", "cos(d)"),
        (r"\arctan2(a, d)", "atan2(a, d)"),
        (r"\arctan 2a", "atan(2*a)"),
        ("a cos q1", "a*cos(theta1)"),
        ("acos(d)", "acos(d)"),
        ("sind 30", "sin(30deg)"),
        ("sin d", "sin(d)"),
    ],
)
def test_a_command_does_not_merge_with_adjacent_letters(text: str, meaning: str) -> None:
    vocabulary = Vocabulary(
        [
            Symbol("theta1", "angle", ("q1",), joint=1),
            Symbol("a", "length"),
            Symbol("d", "length"),
        ]
    )
    assert read(text, vocabulary).text() == meaning
