"""An unreadable or empty cell does not affect other cells."""

import random
from collections.abc import Iterator, Mapping
from copy import deepcopy
from typing import Any

import numpy as np
import pytest
from dh_grader.catalogue import Exercise, shipped_folder
from dh_grader.grading import PartReport, Severity, Submission, Verdict, grade
from dh_grader.grading.report import messages_of

from tests.frame_choice.generator import reassignment
from tests.frame_choice.robots import (
    COLUMNS,
    GIVEN,
    POLICIES,
    ROBOTS,
    Policy,
    Robot,
    conventions,
    exercise,
)
from tests.grading.support import submitting as support
from tests.grading.support.robots import STANFORD
from tests.grading.support.submitting import not_correct, part
from tests.samples import one_in
from tests.shipped import sampled
from tests.solutions.solved import solved

IDS = sorted(file.stem for file in shipped_folder().glob("*.toml"))

Place = tuple[int | str, ...]
UNREAD = {"thetta?": Verdict.UNREADABLE, "": Verdict.MISSING}
BLAME = {Severity.ERROR, Severity.WARNING}


def places(answer: object, place: Place = ()) -> Iterator[Place]:
    if isinstance(answer, dict):
        for key, inside in answer.items():
            if key not in ("convention", "none", "frame"):
                yield from places(inside, (*place, key))
    elif isinstance(answer, list):
        for i, inside in enumerate(answer):
            yield from places(inside, (*place, i))
    else:
        yield place


def changed(answer: Any, cells: list[Place], text: str) -> Any:
    answer = deepcopy(answer)
    for *way, last in cells:
        inside = answer
        for step in way:
            inside = inside[step]
        inside[last] = text
    return answer


def blamed(report: PartReport, unread: Verdict) -> list[tuple[object, ...]]:
    verdicts = {(row.label, cell.label): cell.verdict for row in report.rows for cell in row.cells}
    messages = [
        message
        for message, told_of, _ in messages_of(report)
        # One message on the part may be about several unread cells.
        if not told_of or any(verdicts.get((at.row, at.cell or "")) is not unread for at in told_of)
    ]
    wrong = [
        (row.label, cell.label, cell.verdict)
        for row in report.rows
        for cell in row.cells
        if cell.verdict not in (Verdict.CORRECT, unread)
    ]
    return [*wrong, *((each.code, each.message) for each in messages if each.severity in BLAME)]


def subsets(cells: list[Place], rng: random.Random) -> Iterator[list[Place]]:
    yield from ([cell] for cell in cells[::2])
    for count in range(2, len(cells) + 1, 2):
        yield rng.sample(cells, count)


@pytest.mark.long
@pytest.mark.parametrize("exercise_id", sampled(IDS, 4))
def test_an_unread_cell_of_a_right_answer_affects_only_itself(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    graded_exercise, rng = catalogue[exercise_id], random.Random(exercise_id)
    for part_id, right in solved(graded_exercise).answers.items():
        for cells in subsets(list(places(right)), rng):
            text = rng.choice(sorted(UNREAD))
            answers = {part_id: changed(right, cells, text)}
            report = part(grade(graded_exercise, Submission(answers)), part_id)
            assert blamed(report, UNREAD[text]) == [], answers


def graded_table(robot: Robot, policy: Policy, rows: list[list[str]], name: str) -> PartReport:
    answer = {"rows": [dict(zip(COLUMNS, row, strict=True)) for row in rows], "convention": name}
    return grade(exercise(robot, policy), Submission({"table": answer})).parts[0]


TRIES = [(robot, name) for robot in ROBOTS for name in conventions(robot, GIVEN)]


@pytest.mark.long
@pytest.mark.parametrize(
    ("robot", "name"), one_in(4, TRIES), ids=lambda each: getattr(each, "name", each)
)
def test_an_unread_cell_in_other_frames_affects_only_itself(robot: Robot, name: str) -> None:
    # All drawn valid tables stay right with up to four unread cells, or an unread row.
    rng = np.random.default_rng(5)
    for policy in POLICIES[:3]:
        rows = reassignment(robot, policy, name, rng)[0].texts
        for count in (1, 2, 3, 4, 0):
            chosen = rng.permutation(4 * len(rows))[:count].tolist()
            chosen = chosen or [4 * (len(rows) // 2) + column for column in range(4)]
            tried = [list(row) for row in rows]
            for cell in chosen:
                tried[cell // 4][cell % 4] = "thetta?"
            report = graded_table(robot, policy, tried, name)
            assert blamed(report, Verdict.UNREADABLE) == [], tried


def test_a_slip_beside_an_unread_cell_is_found(
    catalogue: Mapping[str, Exercise],
) -> None:
    # No offset of joint 2 compensates for a wrong twist between the first two axes.
    rows = [list(row) for row in STANFORD.rows]
    rows[0][1], rows[1][2] = "-60", "thetta?"
    report = support.graded_table(catalogue["stanford-arm"], rows, "degrees")
    assert not_correct(report) == {
        ("1", "alpha"): Verdict.INCORRECT,
        ("2", "d"): Verdict.UNREADABLE,
    }


def scara_link(a: str, alpha: str, d: str, theta: str) -> list[list[str]]:
    """Return the standard link transform for a twist of 0 or 180°."""
    cos = {"0": "1", "180": "-1"}[alpha]
    c, s = f"cos({theta})", f"sin({theta})"
    return [
        [c, f"-{s}*({cos})", "0", f"({a})*{c}"],
        [s, f"{c}*({cos})", "0", f"({a})*{s}"],
        ["0", "0", cos, d],
        ["0", "0", "0", "1"],
    ]


@pytest.mark.parametrize("i", range(4))
def test_unread_entries_of_a_link_in_other_frames_affect_no_other(
    i: int, catalogue: Mapping[str, Exercise]
) -> None:
    # The answer is valid: x1 is reversed, and origins are moved along the parallel axes.
    right = [
        scara_link("-a1", "0", "0.3", "theta1 + pi"),
        scara_link("a2", "180", "-0.1", "theta2 - pi"),
        scara_link("0", "0", "d3 + 0.2", "0"),
        scara_link("0", "0", "d4", "theta4"),
    ]
    for cells in ([(0, 3)], [(2, 3), (0, 0)], [(j, k) for j in range(4) for k in range(4)]):
        answer = changed(right, [(i, *cell) for cell in cells], "thetta?")
        report = part(grade(catalogue["scara"], Submission({"links": answer})), "links")
        assert blamed(report, Verdict.UNREADABLE) == []
