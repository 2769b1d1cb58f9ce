"""Reading any pasted text soon gives a grid of cells or a GridError."""

import time
from collections.abc import Callable
from typing import TypeVar

import pytest
from dh_grader.pasting import (
    GRID_LIMITS,
    Grid,
    GridError,
    NamedGrid,
    read_grid,
    read_grids,
    read_robot,
)
from hypothesis import example, given
from hypothesis import strategies as st

from tests.guards import STALL
from tests.pasting.test_robots import SCRIPTS
from tests.pasting.writers import FORMATS, POSE
from tests.samples import one_in

Found = TypeVar("Found")
SEEDS = [write(POSE) for write in FORMATS.values()]
SEEDS += [f"A1 = {text}\nA2 = {text}" for text in SEEDS]
SEEDS += [case["script"] for cases in SCRIPTS.values() for case in cases.values()]
FRAGMENTS = [
    "[", "]", "(", ")", "{", "}", "<", ">", "&", "\\", "|", "'", '"', "%", "#", "...", ";", ",",
    "\n", "\r\n", "\t", " ", "=", "$", "\x00", "\ud800", "\u202e", "\u2028", "\ufeff", "\u0301",
    "\\begin{array}", "\\end{array}", "\\\\", "\\hline", "<table>", "<td>", "</tr>", "<!--",
    "&amp;", "<sup>", "Matrix(", "np.array(", "list(", "[[", "]]", "*", "-", " -x", "|---|", "⎡",
    "A1 = ", "\nA2 =\n", "A_1:", "Link 1\n", "\n>>> ", "\n>> ", "Out[1]=", "(%o1) ", "\n... ",
    "(*", "*)", "/*", "//MatrixForm", "Simplify[", "\\pmatrix{", "\\cr ", "[   ]\n", "/ 1 \\\n| ",
    " = ", ":=", "\n\n", "% A1\n", "import x\n", "x = Symbol(", "x", "x1 ", "\\begin{bmatrix}",
    "\\end{bmatrix}", "{}^0", "\\right)", "\\quad", "\\text{", "a*b", "é", "𝜃",
    "SerialLink([", "\nL(1) = Link([0 0 ", "Revolute('d', ", "setFixedTransform(j1, ", "{'a': [",
    "■(", "@", "┆", "```\n", "~~~\n", "# A tibble: 3 × 4\n", "shape: (3, 4)\n", "[1,]", "[,1] ",
    ":: 3 axis, RRR, stdDH\n", "| j | theta | d | a | alpha | offset |\n", "dict(a=", "[{'a': ",
    "R << ", "Matrix3d R;\n", "function R = f(x)\n", "(1, 2)\n", "%o5 ", "(a, α, d, θ) = (",
    "d1, d4 = 1, 2\n", "pd.DataFrame([[", "T = f(DH)\n", "for i in DH:\n",
    "{|\n", "\n|-\n", "\n| ", "print(DH)\n", "3×4 Matrix{Num}:\n",
    "Table 1:", "degrees\n", "，", "关节", "theta[1]", "% theta d a alpha\n", "\\begin{tblr}{",
]  # fmt: skip


Refusal = tuple[str, str, tuple[int, int]]


def refusal(error: GridError) -> Refusal:
    return error.code, error.message, error.span


def outcome(text: str) -> Grid | Refusal:
    try:
        robot = read_robot(text)
        return robot.grid if robot else read_grid(text, of_table=True)
    except GridError as error:
        return refusal(error)


def outcomes(text: str) -> list[tuple[tuple[int, int], Grid | Refusal]] | Refusal:
    def each(named: NamedGrid) -> tuple[tuple[int, int], Grid | Refusal]:
        grid = named.grid
        return named.name.whole, refusal(grid) if isinstance(grid, GridError) else grid

    try:
        return list(map(each, read_grids(text)))
    except GridError as error:
        return refusal(error)


def spans(found: Grid | Refusal) -> list[tuple[int, int]]:
    if not isinstance(found, Grid):
        return [found[2]]
    assert 1 <= len(found.rows) <= GRID_LIMITS.rows
    assert max(map(len, found.rows)) <= GRID_LIMITS.columns
    cells = [cell.whole for row in found.rows for cell in row]
    return cells + [note.span for note in found.notes]


def twice(read: Callable[[str], Found], text: str) -> Found:
    times = [time.process_time()]
    found = read(text)
    times.append(time.process_time())
    assert read(text) == found
    times.append(time.process_time())
    # Take the faster of two runs, because garbage collection may slow one of them.
    assert min(times[1] - times[0], times[2] - times[1]) < STALL
    return found


def check(text: str) -> None:
    check_places(text, twice(outcome, text), twice(outcomes, text))


def check_places(
    text: str, one: Grid | Refusal, found: list[tuple[tuple[int, int], Grid | Refusal]] | Refusal
) -> None:
    places = spans(one)
    if isinstance(found, list):
        assert 1 <= len(found) <= GRID_LIMITS.rows
        places += [name for name, _ in found]
        places += [place for _, each in found for place in spans(each)]
    else:
        places += spans(found)
    assert all(0 <= start <= end <= len(text) for start, end in places)


@given(st.text(max_size=200) | st.lists(st.sampled_from(FRAGMENTS), max_size=60).map("".join))
@example("list(" * 3000)
@example("[" * 16_000)
@example("<td>" * 4000)
@example("0=A@A")
def test_any_text_gives_a_grid_or_an_error(text: str) -> None:
    check(text)


@st.composite
def mutations(draw: st.DrawFn) -> str:
    text = draw(st.sampled_from(SEEDS))
    for _ in range(draw(st.integers(1, 6))):
        start = draw(st.integers(0, len(text)))
        end = min(len(text), start + draw(st.integers(0, 12)))
        inserted = draw(st.sampled_from(FRAGMENTS) | st.text(max_size=3))
        text = text[:start] + inserted + text[end:]
    return text


@given(mutations())
def test_mutated_grids_give_a_grid_or_an_error(text: str) -> None:
    check(text)


# The suite combines each unit with one beginning; the campaign runs all pairs.
BEGINNINGS = ["", "[", "<tr><td>", "\\begin{matrix}"]
UNITS = [*FRAGMENTS, "1 ", "1 -", "1  ", "1\n", "[' ", '<a "', "\\cline{"]
PAIRS = [
    (BEGINNINGS[(i + j) % len(BEGINNINGS)], unit)
    for i, unit in enumerate(UNITS)
    for j in range(len(BEGINNINGS))
]


@pytest.mark.sampled(16)
@pytest.mark.parametrize(("before", "unit"), one_in(len(BEGINNINGS), PAIRS))
def test_long_repetitions_give_a_grid_or_an_error(before: str, unit: str) -> None:
    text = before + unit * GRID_LIMITS.characters
    check(text[: GRID_LIMITS.characters - 1] + ("]" if before == "[" else ""))


@pytest.mark.long
def test_a_text_far_beyond_the_limit_is_refused_at_once() -> None:
    check("[" * 10_000_000)
