"""Samples of long lists of cases: the suite runs a part, ``make thorough`` runs all."""

from collections.abc import Iterable

import pytest
from _pytest.mark import ParameterSet


def one_in(count: int, cases: Iterable[object]) -> list[ParameterSet]:
    """Return test parameters: the suite runs one case in ``count``, the campaign the others.

    A case with several parameters is a tuple.
    """
    return [
        pytest.param(
            *(case if isinstance(case, tuple) else (case,)),
            marks=() if i % count == 0 else pytest.mark.campaign,
        )
        for i, case in enumerate(cases)
    ]
