"""Preview a pasted table or matrix cell by cell."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.expressions import Kind
from dh_grader.grading.reading import preview_entries, preview_pasted
from dh_grader.translations import Sentence

TABLE = "\n".join(
    [
        "i, theta (deg), d, a, alpha (deg)",
        "1, q1*, l1, l2, 0",
        "2, q2, 0, l3 +, 180",
        "3, q3, l4, , 0",
    ]
)


@pytest.fixture
def arm(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["rrrp"]


def test_a_table_cell_by_cell(arm: Exercise) -> None:
    shown = preview_pasted(TABLE, arm, "table")
    assert shown.problem is None
    assert not shown.ok
    assert [[cell.column for cell in row] for row in shown.rows] == [
        ["a", "alpha", "d", "theta"]
    ] * 3
    assert [row[0].row for row in shown.rows] == ["1", "2", "3"]
    a, alpha, d, theta = shown.rows[0]
    assert (a.text, a.latex, a.symbols) == ("l2", "l_{2}", ("l2",))
    assert a.mathml.startswith("<math")
    assert (alpha.text, d.text, theta.text) == ("0", "l1", "q1")
    assert TABLE[slice(*theta.span)] == theta.typed == "q1*"
    assert shown.rows[1][1].text == "180deg"


def test_a_problem_has_its_span_and_the_repair(arm: Exercise) -> None:
    cell = preview_pasted(TABLE, arm, "table").rows[1][0]
    assert cell.problem is not None
    assert (cell.problem.code, cell.problem.suggestion) == ("trailing_operator", "l3")
    assert TABLE[slice(*cell.problem.span)] == "+"
    assert (cell.text, cell.latex, cell.mathml, cell.symbols) == ("", "", "", ())


def test_an_empty_cell_has_neither_a_reading_nor_a_problem(arm: Exercise) -> None:
    cell = preview_pasted(TABLE, arm, "table").rows[2][0]
    assert (cell.typed, cell.text, cell.problem) == ("", "", None)


def test_notes_of_cells_and_of_the_whole(arm: Exercise) -> None:
    text = "[c1 -s1 0 sin12; 1 2 3 4]"
    shown = preview_pasted(text, arm, "pose")
    assert [note.code for note in shown.notes] == ["blank_before_sign"]
    [note] = shown.rows[0][3].notes
    assert (note.code, text[slice(*note.span)]) == ("shorthand", "sin12")
    assert shown.ok


def test_a_row_of_another_length(arm: Exercise) -> None:
    shown = preview_pasted("a, alpha, d, theta\n0, 0, 0", arm, "table")
    [[row]] = shown.rows
    assert row.problem is not None
    assert (row.problem.code, row.typed) == ("row_length", "0, 0, 0")


def test_a_matrix_of_any_size(arm: Exercise) -> None:
    shown = preview_pasted("[[1, q1], [2, 3]]", arm, "pose")
    assert [[(cell.row, cell.column, cell.text) for cell in row] for row in shown.rows] == [
        [("1", "1", "1"), ("1", "2", "q1")],
        [("2", "1", "2"), ("2", "2", "3")],
    ]


@pytest.mark.parametrize("part", ["table", "pose"])
def test_no_grid_is_one_problem(part: str, arm: Exercise) -> None:
    shown = preview_pasted("[[1, 2]", arm, part)
    assert shown.problem is not None
    assert (shown.problem.code, shown.problem.span, shown.rows) == (
        "unbalanced_bracket",
        (0, 1),
        (),
    )
    assert not shown.ok


def test_degrees_as_the_submission_says(arm: Exercise) -> None:
    text = "0, 90, 0, q1\n0, 0, 0, q2"
    assert preview_pasted(text, arm, "table", "degrees").rows[0][1].text == "90deg"
    assert preview_pasted(text, arm, "table").rows[0][1].text == "90"
    assert (
        preview_pasted("[cos(90) 1; 2 3]", arm, "pose", "degrees").rows[0][0].text == "cos(90deg)"
    )


def test_a_part_that_does_not_exist(arm: Exercise) -> None:
    with pytest.raises(LookupError, match="'rrrp' has no part 'tabel'"):
        preview_pasted("1,2", arm, "tabel")


@pytest.mark.parametrize(
    ("part", "text"),
    [
        ("table", TABLE),
        ("table", "a, a, d, theta\n1, 2, 3, 4"),
        ("table", "a1 0 0 q1 2\na2 0 0"),
        ("table", "L(1) = Link([0 0 l2 0])"),
        ("table", "x = {"),
        ("pose", "[1, 2; 3, 4]]"),
    ],
)
def test_the_messages_can_be_translated(part: str, text: str, arm: Exercise) -> None:
    shown = preview_pasted(text, arm, part)
    cells = [cell for row in shown.rows for cell in row]
    problems = [shown.problem, *(cell.problem for cell in cells)]
    notes = [*shown.notes, *(note for cell in cells for note in cell.notes)]
    messages = [each.message for each in (*problems, *notes) if each]
    assert messages
    assert all(isinstance(message, Sentence) for message in messages)


@pytest.mark.parametrize(
    ("unit", "typed", "entry", "repaired"),
    [
        ("d [mm]", "135,0", "135,0 mm", "0.135"),
        ("d [m]", "0,135", "0,135", "0.135"),
        ("alpha [deg]", "-90,0", "-90,0°", "-90.0°"),
        ("alpha [rad]", "1,57", "1,57", "1.57"),
    ],
)
def test_an_unreadable_number_keeps_the_unit_of_its_header(
    unit: str, typed: str, entry: str, repaired: str, arm: Exercise
) -> None:
    # An entry with its unit gets the correct repair even without the header.
    headers = [unit, *(name for name in ("a", "alpha", "d", "theta") if name not in unit.split())]
    # A list of values in another cell: the commas of the text are not certainly decimal commas.
    text = f"{';'.join(headers)}\n{typed};1,2,3;0;q1"
    [cell] = [cell for cell in preview_pasted(text, arm, "table").rows[0] if cell.typed == typed]
    assert cell.entry == entry
    quantity: Kind = "length" if unit.startswith("d") else "angle"
    [alone] = preview_entries([(entry, quantity)], arm, "table")
    assert alone.problem is not None
    assert alone.problem.suggestion == repaired
