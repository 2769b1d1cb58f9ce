"""Replace letters by the numbers that a script assigns to them."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading.reading import PastedPreview, preview_pasted

from tests.grading.support.exercise_texts import Make, all_codes, graded, one_part
from tests.grading.support.submitting import full_marks

HEADERS = "a,alpha,d,theta"
ROWS = ("0, pi/2, d1, q1", "a2, 0, 0, q2", "-a2/2, 0, 0, q3")
TABLE = "[" + "; ".join(ROWS) + "]"
LISTS = "[" + ", ".join(f"[{row}]" for row in ROWS) + "]"
LINKS = (
    "L(1) = Revolute('d', d1, 'alpha', pi/2);\nL(2) = Revolute('a', a2);\n"
    "L(3) = Revolute('a', -a2/2);"
)


def lengths(read: PastedPreview) -> list[tuple[str, str]]:
    return [(row[0].text, row[2].text) for row in read.rows]


def codes(read: PastedPreview) -> list[str]:
    return [note.code for note in read.notes if note.code.endswith("_numbers")]


@pytest.mark.parametrize(
    "text",
    [
        f"d1 = 0.1625; a2 = -0.425;\nDH = {TABLE}",
        f"d1 = 0.1625  % height\na2 = -0.425  % upper arm\nDH = {TABLE}",
        f"d1 = 0.1625;\na2 = -0.425;\n{LINKS}",
        f"import numpy as np\nd1, a2 = 0.1625, -0.425  # the lengths\nDH = np.array({LISTS})",
        f"(d1, a2) = (0.1625, -0.425)\nDH = {LISTS}",
        f"x, a2, y, d1 = 1, -0.425, 2, 0.1625\n{LINKS}",
        "\n".join(["d1 = 0.1625, a2 = -0.425", HEADERS, *ROWS]),
    ],
)
def test_a_letter_means_its_number(text: str, catalogue: Mapping[str, Exercise]) -> None:
    read = preview_pasted(text, catalogue["ur5e"], "table")
    assert read.ok
    assert lengths(read) == [("0", "0.1625"), ("-0.425", "0"), ("-(-0.425)/2", "0")]
    assert codes(read) == ["used_numbers"]


@pytest.mark.parametrize(
    "given",
    [
        "d1 = 0.1; d1 = 0.2;",
        "",
        "d1 = 2*a2;",
        "d1 = 0.1; d1 = d1 + 0.2;",
        "d1 = 0.1;\nd1 *= 2;",
        "d1, x = 0.1, 2\nd1 = 0.3",
        "d1, x = 0.1, 2, 3",
        "x, d1 = 0.1, 2*y",
        "x, d1 = 0.1, f(2)",
        "d1, x = x, 0.1",
        "d1 = x = 0.1",
    ],
)
@pytest.mark.parametrize("table", [f"DH = {TABLE}", LINKS, "\n".join([HEADERS, *ROWS])])
def test_a_letter_without_one_number_is_unknown(
    given: str, table: str, catalogue: Mapping[str, Exercise]
) -> None:
    text = f"a2 = 0.4;\n{given}\n{table}"
    assert not preview_pasted(text, catalogue["ur5e"], "table").ok


@pytest.mark.parametrize("given", ["a1 = 0.4; a2 = 0.3;", "a1, a2 = 0.4, 0.3"])
def test_letters_of_the_exercise_keep_their_meaning(
    given: str, catalogue: Mapping[str, Exercise]
) -> None:
    text = f"{given}\nDH = [a1 0 0 q1; a2 0 0 q2]"
    read = preview_pasted(text, catalogue["planar-rr"], "table")
    assert lengths(read) == [("a1", "0"), ("a2", "0")]
    assert codes(read) == ["given_numbers"]


def test_letters_that_change_places_are_refused(catalogue: Mapping[str, Exercise]) -> None:
    text = "a1, a2 = a2, a1\nDH = [[a1, 0, 0, q1], [a2, 0, 0, q2]]"
    read = preview_pasted(text, catalogue["planar-rr"], "table")
    assert read.problem is not None
    assert read.problem.code == "given_value"


# An exercise without letters for lengths.
NUMBERS = '[symbols]\nphi = { kind = "angle", description = "an angle" }\n'
NAMED_LISTS = {
    one_part("position", 'expected = ["0.5*cos(phi)", "0.3", "0"]', NUMBERS): (
        "z = 0, x = 0.5 cos(phi), y = 0.3",
        "x = 0.5 cos(phi), z = 0, y = 0.3",
        "y = 0.3, z = 0, x = 0.5 cos(phi)",
        "[z = 0, x = 0.5 cos(phi), y = 0.3]",
    ),
    one_part("euler_angles", 'sequence = "RPY"\nexpected = ["phi", "0.2", "0.1"]', NUMBERS): (
        "gamma = 0.1, beta = 0.2, alpha = phi",
        "beta = 0.2, alpha = phi, gamma = 0.1",
    ),
}


@pytest.mark.parametrize(
    ("exercise", "text"),
    [(exercise, text) for exercise, texts in NAMED_LISTS.items() for text in texts],
)
def test_a_list_is_ordered_by_the_names_of_numbers(
    exercise: str, text: str, make_exercise: Make
) -> None:
    report = graded(make_exercise(exercise), text)
    assert full_marks(report), report
    assert all_codes(report) == {"ordered_by_names"}
