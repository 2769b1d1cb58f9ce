"""Samples of long lists of cases: the suite runs a part, ``make thorough`` runs all."""

from collections.abc import Iterable

import pytest
from _pytest.mark import ParameterSet


def one_in(count: int, cases: Iterable[object]) -> list[ParameterSet]:
    """Return parameters of a test: the suite runs one in ``count``, the campaign the others.

    A case of several parameters is a tuple.
    """
    return [
        pytest.param(
            *(case if isinstance(case, tuple) else (case,)),
            marks=() if i % count == 0 else pytest.mark.campaign,
        )
        for i, case in enumerate(cases)
    ]
