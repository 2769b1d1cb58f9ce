"""Test that reports do not give the answer away."""

from collections.abc import Callable, Iterator, Mapping
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
import pytest
from dh_grader.catalogue import Exercise, FeedbackLevel, PartSpec, exercise_files, shipped_folder
from dh_grader.expressions import ExpressionError, read
from dh_grader.grading import PartReport, Submission, Verdict, grade
from dh_grader.grading.numbers import draw
from dh_grader.grading.report import messages_of
from dh_grader.solutions import solve
from dh_grader.solutions.answers import IDENTITY, LAZY, motion

from tests.grading.support.submitting import handed_in, part
from tests.grading.support.thief import (
    Grid,
    Sheet,
    Thief,
    expressions_in,
    is_trivial,
    known_before,
    lazy,
    sheet_of,
)
from tests.samples import one_in
from tests.shipped import sampled
from tests.solutions.solved import solved

# --- Unless the feedback level is ``full``, a report reveals no correct values

# No message at the lower levels contains the correct value of a cell.

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


# --- Answers without knowledge of geometry earn little

# Every answer here can be written without looking at the robot, except the names of its joints.

ZERO_KNOWLEDGE_IDS = [file.stem for file in exercise_files(shipped_folder())]
# The sample begins at the exercise that has most kinds of answers.
SAMPLED = one_in(24, ZERO_KNOWLEDGE_IDS[8:] + ZERO_KNOWLEDGE_IDS[:8])
# A length that no robot has.
ANY = "0.4171"
PART, POSE, EXERCISE = 0.25, 0.5, 0.4
ZERO_ROW = {"a": "0", "alpha": "0", "d": "0", "theta": "0"}
GARBAGE = {"a": "0.37", "alpha": "0.61", "d": "0.83", "theta": "1.27"}
MOST_ROWS = 12

Rows = list[dict[str, str]]


def padded(rows: Rows) -> Iterator[Rows]:
    room = MOST_ROWS - len(rows)
    for row in (ZERO_ROW, GARBAGE):
        yield [row] * room + rows
        yield rows + [row] * room
        yield [*chain.from_iterable((row, each) for each in rows)][:MOST_ROWS]
    if room >= 2 * 2:
        # Rows that cancel each other may be in any valid table.
        there, back = ZERO_ROW | {"d": ANY}, ZERO_ROW | {"d": f"-{ANY}"}
        yield [there, back, *rows]
        yield [*rows, there, back]


def dressed_up(rows: Rows) -> Iterator[Rows]:
    for column in ("d", "theta"):
        for first in range(len(rows) - 1):
            changed = [dict(row) for row in rows]
            for row, sign in zip(changed[first : first + 2], "+-", strict=True):
                row[column] = f"{row[column]} {sign} {ANY}"
            yield changed
        changed = [dict(row) for row in rows]
        for row, sign in zip(changed, "+-" * 6, strict=False):
            row[column] = f"{row[column]} {sign} {ANY}"
        yield changed
    yield [{column: f"-({cell})" for column, cell in row.items()} for row in rows]


def standing_still(rows: Rows) -> Iterator[Rows]:
    yield [ZERO_ROW] * len(rows)
    yield [{"a": "1", "alpha": "1", "d": "1", "theta": "1"}] * len(rows)
    first = next(cell for cell in rows[0].values() if cell != "0")
    yield [ZERO_ROW | {"theta": f"1e-8*{first}"}, *[ZERO_ROW] * (len(rows) - 1)]


def of_a_table(lazy: Mapping[str, Any]) -> Iterator[object]:
    rows: Rows = lazy["rows"]
    for made in (padded, dressed_up, standing_still):
        yield from ({**lazy, "rows": changed} for changed in made(rows))
    *_, dressed = (changed for changed in dressed_up(rows) if changed[0]["d"] != rows[0]["d"])
    yield from ({**lazy, "rows": both} for both in padded(dressed))


def without_knowledge(part: PartSpec, exercise: Exercise) -> list[object]:
    answers = LAZY[part.kind](part, exercise)
    if part.kind == "dh_table":
        tables: list[Any] = [*answers]
        return [*tables, *chain.from_iterable(map(of_a_table, tables))]
    if part.kind == "link_transforms":
        count = len(answers[0])  # type: ignore[arg-type]
        zeros = [["0"] * 4] * 4
        every = motion(exercise.joints)
        slides = sliding(exercise)
        shifted = [
            [*each[:2], [*each[2][:3], f"{each[2][3]} {sign} {ANY}"], each[3]]
            for each, sign in zip(answers[0], "+-" * count, strict=False)  # type: ignore[call-overload]
        ]
        return [
            *answers,
            shifted,
            *([each] * count for each in (IDENTITY, zeros, every)),
            *([each, *[IDENTITY] * (count - 1)] for each in (every, slides)),
        ]
    if part.kind == "transform":
        return [*answers, sliding(exercise), [["0"] * 4] * 4]
    if part.kind == "rotation":
        return [*answers, [["0"] * 3] * 3]
    if part.kind in ("position", "vector", "euler_angles"):
        count = len(answers[0])  # type: ignore[arg-type]
        return [*answers, ["1"] * count]
    return answers


def sliding(exercise: Exercise) -> list[list[str]]:
    names = [*(joint.variable for joint in exercise.joints), "0", "0", "0"]
    return [[*row[:3], name] for row, name in zip(IDENTITY[:3], names, strict=False)] + IDENTITY[3:]


def best_of(part: PartSpec, exercise: Exercise) -> float:
    graded = (
        grade(exercise, Submission({part.id: answer}))
        for answer in without_knowledge(part, exercise)
    )
    return max(
        each.points / each.max_points
        for report in graded
        for each in report.parts
        if each.part == part.id
    )


def best_together(exercise: Exercise) -> dict[str, float]:
    best = dict.fromkeys((part.id for part in exercise.parts), 0.0)
    answers = {part.id: without_knowledge(part, exercise) for part in exercise.parts}
    for k in range(0, max(map(len, answers.values())), 2):
        mixed = {part: each[k % len(each)] for part, each in answers.items()}
        for report in grade(exercise, Submission(mixed)).parts:
            best[report.part] = max(best[report.part], report.points / report.max_points)
    return best


@pytest.mark.long
@pytest.mark.parametrize("exercise_id", SAMPLED)
def test_zero_knowledge_earns_little(
    exercise_id: str, catalogue: Mapping[str, Exercise], figure: Callable[[str], None]
) -> None:
    exercise = catalogue[exercise_id]
    alone = {part.id: best_of(part, exercise) for part in exercise.parts}
    together = best_together(exercise)
    best = {part: max(alone[part], together[part]) for part in alone}
    points = {part.id: part.points for part in exercise.parts}
    share = sum(best[part] * points[part] for part in best) / sum(points.values())
    parts = ", ".join(f"{part} {each:.0%}" for part, each in best.items())
    figure(f"{exercise_id}: zero knowledge earns {share:.0%} ({parts})")
    assert share <= EXERCISE
    for each in exercise.parts:
        assert best[each.id] <= (POSE if each.kind == "transform" else PART) + 1e-6, each.id


def test_guessing_none_for_a_row_does_not_pass(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue["dh-conditions"]
    guess = {part.id: {"none": True} for part in exercise.parts}
    assert grade(exercise, Submission(guess)).score <= EXERCISE


def test_the_given_transform_is_not_its_own_inverse(catalogue: Mapping[str, Exercise]) -> None:
    given = [
        ["cos(phi)", "-sin(phi)", "0", "px"],
        ["sin(phi)", "cos(phi)", "0", "py"],
        ["0", "0", "1", "pz"],
        ["0", "0", "0", "1"],
    ]
    report = grade(catalogue["homogeneous-inverse"], Submission({"about-z": given})).parts[0]
    assert report.points <= PART * report.max_points


def known_slips(exercise: Exercise, part: PartSpec) -> Iterator[tuple[float, float]]:
    right: Any = solve(exercise).answers[part.id]
    for i, row in enumerate(right["rows"]):
        for column in ZERO_ROW:
            rows = [dict(each) for each in right["rows"]]
            rows[i][column] = f"{row[column]} + 0.371"
            answer = {part.id: {**right, "rows": rows}}
            [report] = (r for r in grade(exercise, Submission(answer)).parts if r.part == part.id)
            if report.verdict is not Verdict.CORRECT:
                wrong = min(report.rows, key=lambda each: each.points - each.max_points)
                yield 1 - report.points / report.max_points, wrong.max_points / report.max_points


@pytest.mark.parametrize("exercise_id", SAMPLED)
def test_one_slip_costs_a_fair_share(
    exercise_id: str, catalogue: Mapping[str, Exercise], figure: Callable[[str], None]
) -> None:
    exercise = catalogue[exercise_id]
    for each in exercise.parts:
        if each.kind == "dh_table":
            found = list(known_slips(exercise, each))
            costs = [cost for cost, _ in found]
            figure(f"{exercise_id}: one slip costs {min(costs):.1%} to {max(costs):.1%}")
            assert max(costs) <= 0.45
            # A row without content cells, worth a fifth of a unit, does not matter.
            matters = [cost for cost, of_row in found if of_row > min(costs) + 1e-6]
            assert min(matters, default=1.0) >= 0.05


ARM = """
title = "An arm"
source = "made for this test"
statement = "Found by trying."
[robot]
structure = "{structure}"
convention = "standard"
joints = {joints}
table = {rows}
[symbols]
a1 = {{ kind = "length", description = "a length" }}
a2 = {{ kind = "length", description = "a length" }}
d4 = {{ kind = "length", description = "a length" }}
[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
points = 4
convention = "standard"
frames = "free"
{policy}
"""
PARALLEL = ("RRR", ["theta1", "theta2", "theta3"], [["0"] * 3, ["a1", "0", "0"], ["0"] * 3])
SCARA = (
    "RRPR",
    ["theta1", "theta2", "d3", "theta4"],
    [["a1", "0", "0"], ["a2", "180deg", "0"], ["0", "0"], ["0", "0", "d4"]],
)
# Changes that once increased the points of a lazy table, on arms that are not in the catalogue.
RAISED = {
    "offsets that cancel": (PARALLEL, "", ["0.4", "-0.4", "0"], ""),
    "offsets that cancel, free tool": (SCARA, 'tool = "free"', ["0.4", "-0.4", "0", "0"], ""),
    "signs before the joints": (SCARA, 'tool = "free"', ["0"] * 4, "-"),
}


@pytest.mark.parametrize("name", RAISED)
def test_no_change_increases_the_points_of_a_lazy_table(
    name: str, make_exercise: Callable[[str], Exercise]
) -> None:
    (structure, joints, constants), policy, offsets, sign = RAISED[name]
    rows = [
        [*row, joint] if kind == "R" else [*row, joint, "0"]
        for kind, row, joint in zip(structure, constants, joints, strict=True)
    ]
    exercise = make_exercise(
        ARM.format(structure=structure, joints=joints, rows=rows, policy=policy)
    )
    written = [
        ZERO_ROW | ({"d": d, "theta": sign + q} if kind == "R" else {"d": f"{sign}{q} + {d}"})
        for kind, d, q in zip(structure, offsets, joints, strict=True)
    ]
    [report] = grade(exercise, Submission({"table": {"rows": written}})).parts
    assert report.points <= PART * report.max_points + 1e-6


def test_no_position_follows_from_a_rotation_alone(catalogue: Mapping[str, Exercise]) -> None:
    # Invented lengths would make the position easy.
    pose = [["c12", "-s12", "0", "c1 + c12"], ["s12", "c12", "0", "s1 + s12"], *IDENTITY[2:]]
    answers = {"pose": pose, "position": ["c1 + c12", "s1 + s12"]}
    reports = {each.part: each for each in grade(catalogue["planar-rr"], Submission(answers)).parts}
    assert reports["pose"].points == POSE * reports["pose"].max_points
    assert reports["position"].points == 0
