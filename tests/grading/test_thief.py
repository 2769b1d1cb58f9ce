"""Unless the feedback level is ``full``, a report reveals no correct values."""

# No message at the lower levels contains the correct value of a cell.

from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

import numpy as np
import pytest
from dh_grader.catalogue import Exercise, FeedbackLevel, PartSpec, shipped_folder
from dh_grader.expressions import ExpressionError, read
from dh_grader.grading import PartReport
from dh_grader.grading.numbers import draw
from dh_grader.grading.report import messages_of

from tests.grading.support.sheets import Grid, Sheet, sheet_of
from tests.grading.support.submitting import handed_in, part
from tests.grading.support.thief import Thief, expressions_in, is_trivial, known_before, lazy
from tests.shipped import sampled
from tests.solutions.solved import solved

IDS = sorted(file.stem for file in shipped_folder().glob("*.toml"))
FULL, HINTS, VERDICTS, SCORE = FeedbackLevel
FIRST: Mapping[str, Callable[[Exercise, PartSpec], Grid]] = {
    "seven": lambda exercise, spec: sheet_of(spec, exercise).filled("7"),
    "zero": lambda exercise, spec: sheet_of(spec, exercise).filled("0"),
    "lazy": lazy,
}


def thieves(exercise: Exercise, level: FeedbackLevel, first: str) -> Iterator[Thief]:
    for spec in exercise.parts:
        grid = FIRST[first](exercise, spec)
        known = known_before(sheet_of(spec, exercise), grid)
        yield Thief(exercise, spec, level, grid, known)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("exercise_id", sampled(IDS, 9))
@pytest.mark.parametrize("first", FIRST)
@pytest.mark.parametrize("level", [HINTS, VERDICTS, SCORE])
def test_a_thief_gains_nothing(
    level: FeedbackLevel, first: str, exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    for thief in thieves(catalogue[exercise_id], level, first):
        before, after = thief.steal()
        assert after == before, (thief.part.id, thief.stolen)


@pytest.mark.long
@pytest.mark.parametrize("exercise_id", sampled(IDS, 20))
@pytest.mark.parametrize("first", FIRST)
def test_a_thief_with_all_hints_gains_nothing(
    first: str, exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    # The thief asks for all steps of each hint in ten rounds, and tries what is in them.
    had = 0
    for thief in thieves(catalogue[exercise_id], HINTS, first):
        thief.with_hints = True
        before, after = thief.steal()
        assert after == before, (thief.part.id, thief.stolen)
        had += len(thief.hints)
    assert had


@pytest.mark.long
def test_a_thief_gets_the_table_at_full(catalogue: Mapping[str, Exercise]) -> None:
    # At the level `full`, a thief succeeds; this shows that the test above can fail.
    table, *_ = thieves(catalogue["planar-rr"], FULL, "seven")
    before, after = table.steal()
    assert before == 0
    assert after > table.part.points / 2
    assert {"theta1", "theta2", "a1", "a2"} <= {text.lstrip("-") for text in table.stolen}


def test_a_thief_finds_expressions_in_a_sentence(catalogue: Mapping[str, Exercise]) -> None:
    words = catalogue["planar-rr"].vocabulary
    assert "theta1 + pi/2" in expressions_in("It should be theta1 + pi/2.", words)
    assert "90deg" in expressions_in("Write the unit (90deg or 90°).", words)
    assert expressions_in("Check which way the axes point.", words) == ()


# --- no message contains the value

# The share of slips that are tried: one of this number.
EVERY = 17


class Slip(NamedTuple):
    """A wrong text in one cell of a correct answer."""

    grid: Grid
    row: int
    column: int

    @property
    def text(self) -> str:
        return self.grid[self.row][self.column]


def slips(right: Grid, every: int) -> Iterator[Slip]:
    count = 0
    for i, row in enumerate(right):
        for j, text in enumerate(row):
            others = (f"-({text})", f"2*({text})", f"{text} + pi/2", f"{text} + pi", "0", "7", "90")
            for wrong in (*others, right[i][j - 1], right[i - 1][j]):
                count += 1
                if wrong != text and count % every == 0:
                    grid = [list(cells) for cells in right]
                    grid[i][j] = wrong
                    yield Slip(grid, i, j)


def leaks(exercise: Exercise, spec: PartSpec, slip: Slip) -> list[str]:
    sheet = sheet_of(spec, exercise)
    answers = {spec.id: sheet.posted(slip.grid)}
    corrected = _correction(part(handed_in(exercise, answers, feedback=FULL), spec.id), sheet, slip)
    if corrected is None or is_trivial(corrected):
        return []
    told = part(handed_in(exercise, answers, feedback=HINTS), spec.id)
    words = exercise.vocabulary
    own = {slip.text, *expressions_in(slip.text, words), *known_before(sheet, [])}
    texts = [text for m, *_ in messages_of(told) for text in (m.message, m.suggestion or "")]
    return [
        said
        for text in texts
        for said in expressions_in(text, words)
        if said not in own and _same(said, corrected, exercise)
    ]


def _correction(report: PartReport, sheet: Sheet, slip: Slip) -> str | None:
    at = sheet.rows[slip.row], sheet.columns[slip.column]
    for message, places, _ in messages_of(report):
        for place in places:
            found = place.correction or message.correction
            if (place.row, place.cell) == at and found is not None and found.latex is not None:
                return found.text
    return None


def _same(one: str, other: str, exercise: Exercise) -> bool:
    values = draw(exercise, 0).values
    try:
        numbers = [read(text, exercise.vocabulary).evaluate(values) for text in (one, other)]
    except ExpressionError:
        return False
    return bool(np.allclose(numbers[0], numbers[1]))


@pytest.mark.long
@pytest.mark.parametrize("exercise_id", sampled(IDS, 8))
def test_no_hint_contains_the_value_of_its_cell(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    exercise, tried = catalogue[exercise_id], 0
    for spec, answer in zip(exercise.parts, solved(exercise).parts, strict=True):
        if answer.text == "none":  # "none" is not a formula
            continue
        for slip in slips(sheet_of(spec, exercise).grid_of(answer.answer), EVERY):
            assert leaks(exercise, spec, slip) == [], (spec.id, slip)
            tried += 1
    assert tried > 1
