"""``python -m tests.grading.sums --answers 1000``: check that points add up."""

import argparse
import json
import os
import sys
from collections import defaultdict
from collections.abc import Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from typing import Any

import numpy as np
from dh_grader.catalogue import Exercise, load_catalogue, shipped_folder
from dh_grader.grading import PartReport, Submission, Verdict, grade
from dh_grader.solutions import solve

# Submit random wrong answers to every part of every shipped exercise, or with `--tables` only to
# the tables. Check that the points of the rows add up to the points of the part, that earned and
# lost points together are the maximum, and that all points are multiples of 0.25 (tables) or of
# 0.01.

WRONG = ("", "0", "1", "0.37", "(", "q1", "-({})", "{} + 0.371", "2*({})", "{} + pi")
# The kinds whose points come in quarters in every shipped exercise.
QUARTERS = "dh_table"


def wrong_answers(exercise: Exercise, count: int, seed: int) -> Iterator[dict[str, Any]]:
    """Yield model answers with random mistakes."""
    rng = np.random.default_rng([seed, *exercise.id.encode()])
    right = solve(exercise).answers
    for _ in range(count):
        answers: dict[str, Any] = json.loads(json.dumps(dict(right)))
        for part in answers:
            places = list(entries(answers[part]))
            for _ in range(1 + int(rng.integers(4)) ** 2 if places else 0):
                holder, key = places[int(rng.integers(len(places)))]
                other, name = places[int(rng.integers(len(places)))]
                if rng.random() < 0.3:
                    holder[key] = other[name]
                else:
                    holder[key] = WRONG[int(rng.integers(len(WRONG)))].format(holder[key])
            answer = answers[part]
            rows = answer.get("rows") if isinstance(answer, dict) else None
            if rows and rng.random() < 0.2:
                rows.pop(int(rng.integers(len(rows))))
            elif rows and rng.random() < 0.2:
                rows.insert(int(rng.integers(len(rows))), dict(rows[0]))
            elif rows and rng.random() < 0.2:
                slip_throughout(rows, rng)
        yield answers


def slip_throughout(rows: list[dict[str, str]], rng: np.random.Generator) -> None:
    column, other = rng.permutation(list(rows[0]))[:2]
    form = (*WRONG, None, None, None)[int(rng.integers(len(WRONG) + 3))]
    shifted = rows[1:] + rows[:1]
    by = int(rng.integers(2))
    for row, neighbour in zip(rows, [dict(row) for row in shifted], strict=True):
        if form is not None:
            row[column] = form.format(row[column])
        elif by:
            row[column], row[other] = row[other], row[column]
        else:
            row[column] = neighbour[column]


def entries(answer: Any) -> Iterator[tuple[Any, Any]]:
    keys = answer if isinstance(answer, dict) else range(len(answer))
    for key in list(keys):
        if isinstance(answer[key], str):
            if key != "convention":
                yield answer, key
        elif isinstance(answer[key], dict | list):
            yield from entries(answer[key])


def faults(part: PartReport) -> Iterator[str]:
    """Yield a description of each wrong sum in the report on a part."""
    rows, lost = part.rows, [each.points for each in part.lost]
    if not in_steps(part.points, part.max_points, *lost):
        yield "lost points are not the missing points"
    if rows and not in_steps(0, part.max_points, *(row.max_points for row in rows)):
        yield "the rows' maximum is not that of the part"
    if rows and not in_steps(0, part.points, *(row.points for row in rows)):
        yield "the rows' points are not those of the part"
    if any(not 0 <= row.points <= row.max_points for row in rows):
        yield "a row earns less than nothing, or more than it is worth"
    amounts = [*lost, *(row.points for row in rows), *(row.max_points for row in rows)]
    steps = 4 if part.kind == QUARTERS else 100
    if any(abs(each * steps - round(each * steps)) > 1e-6 for each in amounts):
        yield f"points are not in steps of 1/{steps}"
    if any(each <= 0 for each in lost):
        yield "nothing was lost at a place"
    # Two fixed rows before the last joint have the same label.
    wrong = [
        (row.label, tuple(cell.label for cell in row.cells if cell.verdict is not Verdict.CORRECT))
        for row in rows
    ]
    if any(each.row is not None and (each.row, each.cells) not in wrong for each in part.lost):
        yield "points were lost in other cells than those that are not right"
    if (part.points == part.max_points) is not (part.verdict is Verdict.CORRECT):
        yield "full points for a wrong answer, or less for a right one"
    yield from rows_with_other_losses(part)


def rows_with_other_losses(part: PartReport) -> Iterator[str]:
    """Yield a description of each row that is told to lose more than it lost."""
    # The rows of two links may have the same label.
    lost: defaultdict[str, float] = defaultdict(float)
    for each_row in part.rows:
        lost[each_row.label] += each_row.max_points - each_row.points
    told: defaultdict[str, float] = defaultdict(float)
    for each in part.lost:
        if each.row is not None:
            told[each.row] += each.points
    for row, points in told.items():
        if points > lost[row] + 1e-6:
            yield f"row {row} is told to lose {points}, but lost {lost[row]}"


def in_steps(start: float, end: float, *between: float) -> bool:
    return abs(start + sum(between) - end) < 1e-6


def run(
    catalogue: Mapping[str, Exercise], count: int, seed: int, kinds: frozenset[str] = frozenset()
) -> tuple[int, list[str]]:
    graded, found = 0, []
    for exercise in catalogue.values():
        chosen = {part.id for part in exercise.parts if not kinds or part.kind in kinds}
        for every in wrong_answers(exercise, count if chosen else 0, seed):
            answers = {part: answer for part, answer in every.items() if part in chosen}
            report = grade(exercise, Submission(answers))
            if not in_steps(0, report.points, *(part.points for part in report.parts)):
                found.append(f"the parts' points are not those of the report: {answers}")
            for part in report.parts:
                if part.part not in chosen:
                    continue
                graded += 1
                told = f"{exercise.id} {part.part} {answers[part.part]} {part.lost}"
                found += [f"{fault}: {told}" for fault in faults(part)]
    return graded, found


def run_alone(exercise: str, count: int, seed: int, kinds: frozenset[str]) -> tuple[int, list[str]]:
    return run({exercise: load_catalogue(shipped_folder())[exercise]}, count, seed, kinds)


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.grading.sums")
    parser.add_argument("--answers", type=int, default=1000, help="for each exercise")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--exercise", default="", help="only exercises with this in their id")
    parser.add_argument("--tables", action="store_true", help="answer only the tables")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    options = parser.parse_args()
    names = [name for name in load_catalogue(shipped_folder()) if options.exercise in name]
    kinds = frozenset({QUARTERS} if options.tables else ())
    total, wrong = 0, 0
    with ProcessPoolExecutor(options.jobs, mp_context=get_context("spawn")) as pool:
        running = {
            pool.submit(run_alone, name, options.answers, options.seed, kinds): name
            for name in names
        }
        for done in as_completed(running):
            graded, found = done.result()
            total, wrong = total + graded, wrong + len(found)
            told = [f"{running[done]}: {len(found)} wrong sums in {graded} parts", *found[:3]]
            sys.stdout.write("\n".join(told) + "\n")
            sys.stdout.flush()
    sys.stdout.write(f"{wrong} wrong sums in {total} parts\n")
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main())
