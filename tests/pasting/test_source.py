"""Test how pasted text is cut into lines and cells."""

from itertools import product

import pytest
from dh_grader.pasting import GRID_LIMITS, GridError, read_grid

from tests.pasting.writers import FORMATS, POSE
from tests.together import together

# --- The size of a grid, such as 2 × 2, and its empty rows


def test_size_is_rows_by_columns() -> None:
    assert read_grid("[1 2; 3 4]").size == "2 × 2"
    assert read_grid("1,2,3\n4,5").size == "2 × 2 to 3"


@pytest.mark.parametrize(
    "text",
    [
        "a, b\n, \n1, 2",
        "a; b\n;\n1; 2",
        "a\tb\n\t\n1\t2",
        "| a | b |\n|---|---|\n| | |\n| 1 | 2 |",
    ],
)
def test_an_empty_row_is_a_row_if_the_grid_needs_one_more(text: str) -> None:
    found = read_grid(text)
    assert [[cell.text for cell in row] for row in found.rows] == [["a", "b"], ["1", "2"]]
    assert found.with_empty_rows(2) == found
    with_empty = found.with_empty_rows(3)
    assert [[cell.text for cell in row] for row in with_empty.rows] == [
        ["a", "b"], ["", ""], ["1", "2"]
    ]  # fmt: skip


def test_an_empty_line_is_only_layout() -> None:
    found = read_grid("a, b\n\n1, 2")
    assert found.with_empty_rows(3) == found


# --- Limits on pasted texts


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("1,2\n" * (GRID_LIMITS.rows + 1), "too_many_rows"),
        ("[" + "[1, 2]," * (GRID_LIMITS.rows + 2) + "]", "too_many_rows"),
        ("[1, 2]\n" * (GRID_LIMITS.rows + 2), "too_many_rows"),
        (",".join("1" * (GRID_LIMITS.columns + 1)), "too_many_columns"),
        (" ".join("1" * 100) + "\n" + " ".join("1" * 100), "too_many_columns"),
        ("a,b\n" + "," * GRID_LIMITS.separators, "too_many_cells"),
        # Signs of Chinese keyboards separate cells, too.
        ("a,b\n" + "，" * GRID_LIMITS.separators, "too_many_cells"),
        ("1；2\n" * 20 + "；" * GRID_LIMITS.separators, "too_many_cells"),
        ("｜1" * (GRID_LIMITS.separators + 1), "too_many_cells"),
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


# --- A separator after the last cell of a row changes nothing

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


# --- Read tags and entities in a Markdown cell


@pytest.mark.parametrize(
    ("typed", "cell"),
    [
        ("θ<sub>1</sub>", "θ_{1}"),
        ("d<SUB>3</SUB><sup>*</sup>", "d_{3}*"),
        ("90<sup>o</sup>", "90°"),
        ("l1<sup>2</sup>", "l1^(2)"),
        ("&theta;1 + 90&deg;", "θ1 + 90°"),
        ("&pi;/2", "π/2"),
        ("θ<b>1</b>", "θ<b>1</b>"),
        ("l1 < l2", "l1 < l2"),
    ],
)
def test_markup_in_a_cell(typed: str, cell: str) -> None:
    text = f"| a | {typed} |\n|---|---|\n| 1 | 2 |"
    [_, found], *_ = read_grid(text).rows
    assert found.text == cell
    assert text[slice(*found.whole)] == typed


# --- Find the positions of cells in a pasted text


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
