"""A separator after the last cell of a row changes nothing."""

from itertools import product

import pytest
from dh_grader.pasting import read_grid

ROWS = [["a", "alpha", "d", "theta"], ["l1", "0", "0", "q1"], ["l2", "pi/2", "d2", "q2"]]
SEPARATORS = {"commas": ",", "semicolons": ";", "tabs": "\t", "bars": " | "}


def cells(text: str) -> list[list[str]]:
    return [[cell.text for cell in row] for row in read_grid(text, of_table=True).rows]


@pytest.mark.parametrize(("name", "end"), [*product(SEPARATORS, [";", "\t", "; ", ","])])
def test_a_sign_after_each_row_spoils_no_cell(name: str, end: str) -> None:
    lines = [SEPARATORS[name].join(row) for row in ROWS]
    assert cells("\n".join(f"{line}{end}" for line in lines)) == ROWS
    assert cells("\r\n".join([*lines[:-1], f"{lines[-1]}{end}"])) == ROWS


@pytest.mark.parametrize("end", [";", "\t", ","])
def test_a_sign_after_columns_between_blanks_spoils_no_cell(end: str) -> None:
    rows = ROWS[1:]
    assert cells("\n".join("  ".join(row) + end for row in rows)) == rows


@pytest.mark.parametrize("end", [",", "\t"])
def test_a_column_of_sums_stays_a_column(end: str) -> None:
    text = "\n".join(f"{value}{end}" for value in ("l1 + l2", "l3 c1", "0"))
    assert cells(text) == [["l1 + l2"], ["l3 c1"], ["0"]]


def test_an_empty_last_cell_is_not_lost() -> None:
    assert cells("l1\t0\t0\tq1\nl2\t0\t0\t\n") == [["l1", "0", "0", "q1"], ["l2", "0", "0", ""]]
