"""Read data frames as programs print them."""

import pytest
from dh_grader.pasting import GridError, read_grid


def cells(text: str) -> list[list[str]]:
    return [[cell.text for cell in row] for row in read_grid(text).rows]


@pytest.mark.parametrize("label", ["Link {}", "Gelenk {}", "joint_{}", "J{}", "连杆{}", "{}"])
def test_a_row_may_have_a_label_without_a_header(label: str) -> None:
    lines = ["a  alpha", *(f"{label.format(i)}  l{i}  0" for i in (1, 2))]
    named = [label.format(1), "l1", "0"], [label.format(2), "l2", "0"]
    assert cells("\n".join(lines)) == [["", "a", "alpha"], *named]


@pytest.mark.parametrize("label", ["theta{}", "q{}", "l{}", "alpha {}"])
def test_a_symbol_is_not_a_label(label: str) -> None:
    lines = ["a alpha", *(f"{label.format(i)} l{i} 0" for i in (1, 2))]
    with pytest.raises(GridError) as caught:
        read_grid("\n".join(lines))
    assert caught.value.code == "ambiguous_columns"


def test_labels_count_the_rows() -> None:
    with pytest.raises(GridError):
        read_grid("a alpha\nLink 1 l1 0\nLink 3 l2 0")


@pytest.mark.parametrize("unit", ["(m)", "[deg]", "(°)", "(度)"])
def test_a_unit_stays_in_its_header(unit: str) -> None:
    assert cells(f"a {unit} d\n1 2\n3 4")[0] == [f"a {unit}", "d"]


def test_a_formula_in_brackets_is_a_value() -> None:
    assert cells("1 (l1)\n2 3") == [["1", "(l1)"], ["2", "3"]]
