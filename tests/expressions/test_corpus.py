"""Test each case in corpus/*.txt: a text, and its value or its error."""

import numpy as np
import pytest
from dh_grader.expressions import ExpressionError, read

from tests.expressions.corpus_files import ROBOT, Case, cases, names, numbers
from tests.expressions.reference import worth
from tests.together import together

VALUES = [(name, case) for name in names() for case in cases(name)]
ERRORS = cases("errors")


@together(("name", "case"), VALUES)
def test_a_written_case_has_its_value(name: str, case: Case) -> None:
    known = numbers(name)
    values = {
        symbol.name: np.array([known[alias]])
        for symbol in ROBOT.symbols
        for alias in (symbol.name, *symbol.aliases)
        if alias in known
    }
    expression = (
        read(case.text, ROBOT, quantity="angle", angle_unit="degrees")
        if name == "degrees"
        else read(case.text, ROBOT)
    )
    expected = worth(case.answers[0], known)
    assert np.ravel(expression.evaluate(values)) == pytest.approx([expected], rel=1e-12, abs=1e-15)


@together("case", ERRORS)
def test_a_written_case_has_its_error(case: Case) -> None:
    code, place, suggestion = case.answers
    with pytest.raises(ExpressionError) as caught:
        read(case.text, ROBOT)
    error = caught.value
    part = case.text[slice(*error.span)]
    assert (error.code, f"{error.span[0]}-{error.span[1]} {part}".rstrip()) == (code, place)
    assert (error.suggestion or "-") == suggestion


def test_the_corpus_has_600_distinct_cases() -> None:
    assert len(VALUES) + len(ERRORS) >= 600
    assert len({(name, case.text) for name, case in VALUES}) == len(VALUES)
