"""Read a row of units below the column headers."""

import pytest
from dh_grader.grading.reading.pasted_table import with_units_in_headers
from dh_grader.pasting import read_grid

HEADERS = "i;a;alpha;d;theta"
ROW = "1;0.3;90;0;q1"


def headers(units: str) -> list[str]:
    grid = with_units_in_headers(read_grid(f"{HEADERS}\n{units}\n{ROW}"))
    return [cell.text for cell in grid.rows[0]]


@pytest.mark.parametrize("units", [";m;deg;m;deg", ";(m);(deg);(m);(deg)", "-;[m];[deg];[m];[deg]"])
def test_units_are_put_into_the_headers(units: str) -> None:
    assert headers(units) == ["i", "a [m]", "alpha [deg]", "d [m]", "theta [deg]"]


@pytest.mark.parametrize("units", ["Unit;m;deg;m;deg", "Einheit;[m];[deg];[m];[deg]"])
def test_a_row_of_units_may_have_a_label_and_stand_at_the_end(units: str) -> None:
    named = ["i", "a [m]", "alpha [deg]", "d [m]", "theta [deg]"]
    assert headers(units) == named
    grid = with_units_in_headers(read_grid(f"{HEADERS}\n{ROW}\n{ROW}\n{units}"))
    assert [cell.text for cell in grid.rows[0]] == named
    assert len(grid.rows) == 3


def test_one_unit_is_enough() -> None:
    assert headers(";;°;;") == ["i", "a", "alpha [°]", "d", "theta"]


@pytest.mark.parametrize(
    "row",
    ["Unit;m;x;m;deg", "Unit;;;;", "1;m;deg;m;deg", ";m;0;0;q1", ";deg;m;deg;m", ";;;;", ";l1;;;"],
)
def test_any_other_row_is_a_row(row: str) -> None:
    assert headers(row) == HEADERS.split(";")
