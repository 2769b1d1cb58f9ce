"""Limits on pasted texts."""

import pytest
from dh_grader.pasting import GRID_LIMITS, GridError, read_grid


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("1,2\n" * (GRID_LIMITS.rows + 1), "too_many_rows"),
        ("[" + "[1, 2]," * (GRID_LIMITS.rows + 2) + "]", "too_many_rows"),
        ("[1, 2]\n" * (GRID_LIMITS.rows + 2), "too_many_rows"),
        (",".join("1" * (GRID_LIMITS.columns + 1)), "too_many_columns"),
        (" ".join("1" * 100) + "\n" + " ".join("1" * 100), "too_many_columns"),
        ("a,b\n" + "," * GRID_LIMITS.separators, "too_many_cells"),
        ("a,b\n" + " " * GRID_LIMITS.characters, "too_long"),
    ],
)
def test_a_text_beyond_a_limit_is_refused(text: str, code: str) -> None:
    with pytest.raises(GridError) as caught:
        read_grid(text)
    assert caught.value.code == code


def test_a_text_exactly_at_a_limit_is_read() -> None:
    row = ",".join(["1"] * GRID_LIMITS.columns)
    assert read_grid("\n".join([row] * GRID_LIMITS.rows)).size == "13 × 12"
    assert len(read_grid("a,b".ljust(GRID_LIMITS.characters)).rows) == 1
