"""Write the size of a grid, such as 2 × 2."""

from service.grids import read_grid


def test_size_is_rows_by_columns() -> None:
    assert read_grid("[1 2; 3 4]").size == "2 × 2"
    assert read_grid("1,2,3\n4,5").size == "2 × 2 to 3"
