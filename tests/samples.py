"""What is too long for the suite is tried there in part, and as a whole by ``make thorough``."""

from collections.abc import Iterable

import pytest
from _pytest.mark import ParameterSet


def one_in(count: int, cases: Iterable[object]) -> list[ParameterSet]:
    """The cases as parameters of a test: the suite tries one in ``count``, the campaign the others.

    A case of several parameters is a tuple.
    """
    return [
        pytest.param(
            *(case if isinstance(case, tuple) else (case,)),
            marks=() if i % count == 0 else pytest.mark.campaign,
        )
        for i, case in enumerate(cases)
    ]
