"""Write fractions and scores in per cent."""

import pytest
from dh_grader.formats.texts import whole_percent, whole_score


@pytest.mark.parametrize(
    ("share", "rounded", "cut"),
    [
        (4 / 6, "67 %", "66 %"),
        (5 / 6, "83 %", "83 %"),
        (0.995, "99 %", "99 %"),
        (0.796, "80 %", "79 %"),
        (0.29, "29 %", "29 %"),
        (1.0, "100 %", "100 %"),
        (0.0, "0 %", "0 %"),
    ],
)
def test_a_share_is_rounded_and_a_score_never_up(share: float, rounded: str, cut: str) -> None:
    assert (whole_percent(share), whole_score(share)) == (rounded, cut)
