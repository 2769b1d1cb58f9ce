"""Answers without knowledge of geometry earn little."""

# Every answer here can be written without looking at the robot, except the names of its joints.

from collections.abc import Callable, Iterator, Mapping
from itertools import chain
from typing import Any

import pytest
from dh_grader.catalogue import Exercise, PartSpec, exercise_files, shipped_folder
from dh_grader.grading import Submission, Verdict, grade
from dh_grader.solutions import solve
from dh_grader.solutions.answers import IDENTITY, LAZY, motion

from tests.samples import one_in

IDS = [file.stem for file in exercise_files(shipped_folder())]
# The sample begins at the exercise that has most kinds of answers.
SAMPLED = one_in(24, IDS[8:] + IDS[:8])
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
    for part in exercise.parts:
        assert best[part.id] <= (POSE if part.kind == "transform" else PART) + 1e-6, part.id


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


def slips(exercise: Exercise, part: PartSpec) -> Iterator[tuple[float, float]]:
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
    for part in exercise.parts:
        if part.kind == "dh_table":
            found = list(slips(exercise, part))
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
