"""Right answers to shipped exercises, and answers with one known slip."""

import copy
import json
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final

import numpy as np
from dh_grader.grading import Submission, grade

from tests.shipped import shipped_exercises

EXERCISES: Final = Path(__file__).parents[3] / "exercises"
COLUMNS: Final = ("a", "alpha", "d", "theta")
# The parts of which answers are made. A part that the name of a file names is one of these.
PARTS: Final[Mapping[str, tuple[str, ...]]] = {
    "planar-rrr": ("table", "pose"),
    "scara": ("table", "pose"),
    "stanford-arm": ("table",),
    "ur5e": ("table", "home"),
    "puma-560-craig": ("table", "home"),
    "spherical-wrist": ("table", "position"),
    "kinova-gen3": ("table",),
    "rrrp": ("table", "pose"),
}
_TRIES: Final = 60

Cells = list[list[str]]


@dataclass(frozen=True)
class Answer:
    """An answer in plain cells, such as ``90deg`` and ``theta1``; ``slip`` is empty if right."""

    exercise: str
    part: str
    cells: Cells
    slip: str = ""

    @property
    def is_table(self) -> bool:
        """True if the cells are a DH table, False if they are a matrix or a position."""
        return self.part == "table"

    def as_json(self) -> object:
        """Return the answer in the JSON of an ordinary submission."""
        if self.is_table:
            return {"rows": [dict(zip(COLUMNS, row, strict=True)) for row in self.cells]}
        return self.cells if len(self.cells[0]) > 1 else [row[0] for row in self.cells]


@dataclass(frozen=True)
class Graded:
    """The points and the verdicts of all cells that an answer gets."""

    points: float
    verdicts: tuple[str, ...]


def verdicts_of(part: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the verdicts of the cells in a part of a report in JSON."""
    return tuple(cell["verdict"] for row in part.get("rows", ()) for cell in row["cells"])


def expected(answers: Sequence[Answer]) -> dict[str, Graded]:
    """Grade the answers of a student in plain JSON; return the results by part."""
    key = json.dumps([[each.exercise, each.part, each.cells] for each in answers])
    return dict(_expected(key))


@cache
def _expected(key: str) -> tuple[tuple[str, Graded], ...]:
    answers = [Answer(*each) for each in json.loads(key)]
    exercise = shipped_exercises()[answers[0].exercise]
    body: dict[str, Any] = {each.part: each.as_json() for each in answers}
    report = grade(exercise, Submission(body))
    found = []
    for part in report.parts:
        if part.part in body:
            verdicts = tuple(str(cell.verdict.value) for row in part.rows for cell in row.cells)
            found.append((part.part, Graded(part.points, verdicts)))
    return tuple(found)


@cache
def _right(exercise: str, part: str) -> tuple[tuple[str, ...], ...]:
    content = tomllib.loads((EXERCISES / f"{exercise}.toml").read_text("utf-8"))
    if part == "table":
        rows = content["robot"]["table"]
    else:
        checks = content["checks"]
        rows = next(
            check["answers"][part]
            for check in checks
            if check["kind"] == "right" and isinstance(check["answers"].get(part), list)
        )
    return tuple(tuple(map(str, row)) if isinstance(row, list) else (str(row),) for row in rows)


def right(exercise: str, part: str) -> Answer:
    """Return the right answer to a part, from the file of the exercise."""
    answer = Answer(exercise, part, [list(row) for row in _right(exercise, part)])
    points = next(it.points for it in shipped_exercises()[exercise].parts if it.id == part)
    assert expected([answer])[part].points == points, answer
    return answer


def wrong(exercise: str, part: str, rng: np.random.Generator) -> Answer:
    """Return an answer with one slip that costs points."""
    whole = right(exercise, part)
    full = expected([whole])[part].points
    for _ in range(_TRIES):
        i = int(rng.integers(len(whole.cells)))
        j = int(rng.integers(len(whole.cells[i])))
        slips = list(_slips(whole, i, j))
        if not slips:
            continue
        name, cells = slips[int(rng.integers(len(slips)))]
        answer = Answer(exercise, part, cells, f"{name} in row {i + 1}, column {j + 1}")
        if expected([answer])[part].points < full:
            return answer
    raise AssertionError(f"no slip costs points in {part} of {exercise}")


def _slips(answer: Answer, i: int, j: int) -> Iterator[tuple[str, Cells]]:
    cell = answer.cells[i][j]

    def with_cell(text: str) -> Cells:
        cells = copy.deepcopy(answer.cells)
        cells[i][j] = text
        return cells

    if cell != "0":
        negative = cell.removeprefix("-") if cell.startswith("-") else f"-{cell}"
        if " + " not in cell and " - " not in cell:
            yield "sign", with_cell(negative)
    if not answer.is_table:
        for one, other in (("cos(", "sin("), ("sin(", "cos("), ("c1", "s1"), ("s1", "c1")):
            if one in cell:
                yield f"{other} for {one}", with_cell(cell.replace(one, other, 1))
        return
    if COLUMNS[j] == "alpha":
        yield "twist", with_cell("0" if cell != "0" else "90deg")
    if COLUMNS[j] == "a" and answer.cells[i][2] != cell and "theta" in answer.cells[i][3]:
        cells = copy.deepcopy(answer.cells)
        cells[i][0], cells[i][2] = cells[i][2], cells[i][0]
        yield "a and d exchanged", cells
    if COLUMNS[j] == "theta" and "+" in cell:
        yield "offset lost", with_cell(cell.partition(" +")[0])
