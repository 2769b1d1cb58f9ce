"""Find the positions of cells in a pasted text."""

from dh_grader.pasting import read_grid

from tests.grids.writers import FORMATS, POSE
from tests.together import together


@together("name", FORMATS)
def test_each_span_is_the_place_of_its_cell(name: str) -> None:
    text = FORMATS[name](POSE)
    for row in read_grid(text).rows:
        for cell in row:
            assert text[slice(*cell.whole)] == cell.text
            for i, letter in enumerate(cell.text):
                assert text[slice(*cell.span(i, i + 1))] == letter


def test_a_span_in_a_rewritten_cell_is_the_place_in_the_typed_text() -> None:
    text = "<table><tr><td>&alpha;<sub>1</sub>+foo</td></tr></table>"
    [[cell]] = read_grid(text).rows
    assert cell.text == "α_{1}+foo"
    assert text[slice(*cell.span(6, 9))] == "foo"
    assert text[slice(*cell.span(0, 1))] == "&alpha;"
