"""Remove sentences around a pasted table."""

import pytest
from dh_grader.pasting import GridError, read_grid

TABLE = "i\ta\talpha\td\ttheta\n1\tl1\t0\t0\tq1\n2\tl2\t0\t0\tq2"


def cells(text: str) -> list[list[str]]:
    return [[cell.text for cell in row] for row in read_grid(text).rows]


@pytest.mark.parametrize(
    "text",
    [
        f"Table 1: parameters of the arm\n{TABLE}",
        f"Table of the arm\t\t\t\t\n{TABLE}",
        f"{TABLE}\n\t\t\t\t\nI checked it twice\t\t\t\t",
        f"My robot with 3 degrees of freedom\n\n{TABLE}\nI hope this helps.",
        f"机械臂参数\n{TABLE}",
        f"```\n{TABLE}\n```",
        f"The table:\n~~~text\n{TABLE}\n~~~\nRegards",
    ],
)
def test_sentences_and_fences_are_no_rows(text: str) -> None:
    assert cells(text) == cells(TABLE)


COMMAS = "a,alpha,d,theta\nl1,0,0,q1\nl2,0,0,q2"


@pytest.mark.parametrize(
    "text",
    [
        *(f"{title}\n{COMMAS}" for title in ("DH table", "% DH", "SCARA", "Hi,", "My table, v2")),
        f"{COMMAS}\nwhere q1, q2 are the joint angles",
        f"{COMMAS}\nEnd",
    ],
)
def test_sentences_around_a_table_with_commas_are_no_rows(text: str) -> None:
    assert cells(text) == cells(COMMAS)
    assert [note.code for note in read_grid(text).notes] == ["text_left_aside"]


@pytest.mark.parametrize("heading", ["Pose", "Lösung:", "**Pose:**"])
@pytest.mark.parametrize("matrix", ["[c1, -s1; s1, c1]", "[c1 -s1\n s1 c1]", "c1 -s1\ns1 c1"])
def test_a_heading_above_a_matrix_is_no_row(heading: str, matrix: str) -> None:
    assert cells(f"{heading}\n{matrix}") == cells(matrix)


@pytest.mark.parametrize("heading", ["T matrix", "Matrix T", "H0 Matrix:"])
def test_the_name_of_a_matrix_above_its_columns_is_no_row(heading: str) -> None:
    assert cells(f"{heading}\nc1 -s1 0\ns1 c1 0\n0 0 1") == cells("c1 -s1 0\ns1 c1 0\n0 0 1")


def test_two_words_are_a_heading_only_above_brackets() -> None:
    assert cells("My answer\n[c1, -s1; s1, c1]") == cells("[c1, -s1; s1, c1]")
    assert cells("gamma, delta\n1, 2") == [["gamma", "delta"], ["1", "2"]]
    assert cells("gamma delta\n1 2\n3 4") == [["gamma", "delta"], ["1", "2"], ["3", "4"]]


@pytest.mark.parametrize("row", ["pi", "theta", "l2", "0"])
def test_a_short_line_above_commas_that_may_be_a_cell_stays(row: str) -> None:
    assert len(cells(f"{row}\n{COMMAS}")) == len(cells(COMMAS)) + 1


def test_a_note_tells_that_sentences_were_ignored() -> None:
    text = f"My table\n{TABLE}"
    [note] = read_grid(text).notes
    assert (note.code, text[slice(*note.span)]) == ("text_left_aside", "My table")


@pytest.mark.parametrize("unit", ["degrees", "Grad", "grados", "degrés", "mm", "弧度", "°"])
def test_a_sentence_with_a_unit_is_refused(unit: str) -> None:
    with pytest.raises(GridError) as caught:
        read_grid(f"Parameters in {unit}\n{TABLE}")
    assert caught.value.code == "text_around"


@pytest.mark.parametrize(
    "line",
    [
        "**Correction:** in the second row the offset should of course be d2 and not 0.",
        "Sorry, the twist of link 1 is wrong.",
        "Korrektur: in Zeile 2 muss der Winkel positiv sein.",
        "En la fila 2 debería ser negativo.",
        "La deuxième ligne est fausse, une erreur de signe.",
    ],
)
def test_a_sentence_that_corrects_the_table_above_it_is_refused(line: str) -> None:
    for text in (f"{TABLE}\n\n{line}", f"```\n{TABLE}\n```\n{line}"):
        with pytest.raises(GridError) as caught:
            read_grid(text)
        assert caught.value.code == "text_around"
        assert text[slice(*caught.value.span)] == line


@pytest.mark.parametrize(
    "line",
    ["Die Spalten sind bei mir vertauscht.", "I have swapped two of the columns.", "两列互换了"],
)
def test_a_sentence_on_exchanged_columns_is_refused(line: str) -> None:
    for text in (f"{TABLE}\n{line}", f"{line}\n{TABLE}"):
        with pytest.raises(GridError):
            read_grid(text)


@pytest.mark.parametrize("line", ["Here is the corrected table:", "This table should be right:"])
def test_a_sentence_above_the_table_may_say_that_it_is_corrected(line: str) -> None:
    assert cells(f"{line}\n{TABLE}") == cells(TABLE)


@pytest.mark.parametrize(
    "line", ["theta d", "3", "l3 0 0 q3", "where l1 = l2", "Joint theta alpha", "pi"]
)
def test_a_line_that_may_be_a_row_stays(line: str) -> None:
    assert len(cells(f"{line}\n{TABLE}")) == 4


@pytest.mark.parametrize(
    "line",
    [
        "where l1 = 0.4",
        "mit l_1 = 0,4 m; l_2 = 0,3 m und d1 = 1 m.",
        "其中 l1＝400mm，l2＝300mm",
        "l1: 0.4\nl2: 0.3",
    ],
)
def test_numbers_of_letters_around_a_table_are_ignored_with_a_note(line: str) -> None:
    for text in (f"{line}\n{TABLE}", f"{TABLE}\n\n{line}"):
        assert cells(text) == cells(TABLE)
        assert [note.code for note in read_grid(text).notes] == ["given_numbers"]


@pytest.mark.parametrize("line", ["l1 = l2", "l1 = 0.4 + l2", "z = 0"])
def test_other_equations_around_a_table_stay(line: str) -> None:
    assert len(cells(f"{line}\n{TABLE}")) == 4


def test_equations_that_are_all_rows_stay() -> None:
    assert cells("p_x = l1, 1\np_y = l2, 2\np1 = 0, 3")[-1][0] == "p1 = 0"


@pytest.mark.parametrize(
    "row", ["3\t\t\t\t", "e\t\t\t\t", "l2\t\t\t\t", "\t\t\t\tq3", "pi/2\t\t\t\t"]
)
def test_a_last_row_with_one_entry_stays(row: str) -> None:
    assert len(cells(f"{TABLE}\n{row}")) == len(cells(TABLE)) + 1
