"""Choose samples of long lists of test cases."""

from collections.abc import Iterable

import pytest
from _pytest.mark import ParameterSet


def one_in(count: int, cases: Iterable[object]) -> list[ParameterSet]:
    """Return test parameters; the suite runs only one in ``count``."""
    # A case with several parameters is a tuple.
    return [
        pytest.param(
            *(case if isinstance(case, tuple) else (case,)),
            marks=() if i % count == 0 else pytest.mark.campaign,
        )
        for i, case in enumerate(cases)
    ]
