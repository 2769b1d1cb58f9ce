"""Whatever is pasted, a grid or one GridError comes back, soon."""

import time

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from service.grids import GRID_LIMITS, Grid, GridError, read_grid
from tests.grids.writers import FORMATS, POSE
from tests.guards import STALL

SEEDS = [write(POSE) for write in FORMATS.values()]
FRAGMENTS = [
    "[", "]", "(", ")", "{", "}", "<", ">", "&", "\\", "|", "'", '"', "%", "#", "...", ";", ",",
    "\n", "\r\n", "\t", " ", "=", "$", "\x00", "\ud800", "\u202e", "\u2028", "\ufeff", "\u0301",
    "\\begin{array}", "\\end{array}", "\\\\", "\\hline", "<table>", "<td>", "</tr>", "<!--",
    "&amp;", "<sup>", "Matrix(", "np.array(", "list(", "[[", "]]", "*", "-", " -x", "|---|", "⎡",
]  # fmt: skip


def outcome(text: str) -> Grid | tuple[str, str, tuple[int, int]]:
    try:
        return read_grid(text)
    except GridError as error:
        return error.code, error.message, error.span


def check(text: str) -> None:
    times = [time.process_time()]
    found = outcome(text)
    times.append(time.process_time())
    assert outcome(text) == found
    times.append(time.process_time())
    # Of two runs the better: a collection of garbage belongs to neither.
    assert min(times[1] - times[0], times[2] - times[1]) < STALL
    if isinstance(found, Grid):
        assert 1 <= len(found.rows) <= GRID_LIMITS.rows
        assert max(map(len, found.rows)) <= GRID_LIMITS.columns
        spans = [cell.whole for row in found.rows for cell in row]
        spans += [note.span for note in found.notes]
    else:
        spans = [found[2]]
    assert all(0 <= start <= end <= len(text) for start, end in spans)


@settings(max_examples=150)
@given(st.text(max_size=200) | st.lists(st.sampled_from(FRAGMENTS), max_size=60).map("".join))
@example("list(" * 3000)
@example("[" * 16_000)
@example("<td>" * 4000)
def test_any_text(text: str) -> None:
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


@settings(max_examples=200)
@given(mutations())
def test_mutations_of_each_format(text: str) -> None:
    check(text)


@pytest.mark.parametrize("before", ["", "[", "<tr><td>", "\\begin{matrix}"])
@pytest.mark.parametrize("unit", [*FRAGMENTS, "1 ", "1 -", "1  ", "1\n", "[' ", '<a "', "\\cline{"])
def test_sixteen_thousand_of_anything(before: str, unit: str) -> None:
    text = before + unit * GRID_LIMITS.characters
    check(text[: GRID_LIMITS.characters - 1] + ("]" if before == "[" else ""))


def test_a_text_beyond_the_limit_costs_nothing() -> None:
    check("[" * 10_000_000)
