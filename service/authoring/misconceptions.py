"""The misconceptions that the grader can name in the answers to an exercise."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, Final

from service.catalogue import Exercise
from service.expressions import AngleUnit
from service.grading import FeedbackLevel, Submission, grade
from service.grading.misconception import Example, all_records
from service.grading.report import messages_of
from service.solutions import solve

# Answers of these kinds have cells of the same sort, in which the same mistakes are searched.
_FAMILIES: Final = (
    frozenset({"dh_table", "dh_row", "find_slip"}),
    frozenset({"link_transforms", "transform", "rotation", "matrix"}),
    frozenset({"position", "vector", "euler_angles"}),
    frozenset({"screw_axes"}),
)


@dataclass(frozen=True, slots=True)
class NamedMisconception:
    """A mistake that the grader can name: its code, its meaning, and example sentences."""

    name: str
    meaning: str
    sentences: tuple[str, ...]


def misconceptions_of(
    exercise: Exercise, catalogue: Mapping[str, Exercise]
) -> list[NamedMisconception]:
    """Return the mistakes that the grader may name in answers to the exercise, sorted by code."""
    own = {part.kind for part in exercise.parts}
    kinds = frozenset().union(*(family for family in _FAMILIES if family & own))
    meanings: dict[str, dict[str, None]] = {}
    sentences: dict[str, dict[str, None]] = {}
    model_answers = cache(
        lambda name: {each.part: each.answer for each in solve(catalogue[name]).parts}
    )
    for record in all_records():
        if record.example is None or (asked := catalogue.get(record.example[0])) is None:
            continue
        part = asked.part(record.example[1])
        if part is None or part.kind not in kinds:
            continue
        for code in record.codes:
            meanings.setdefault(code, {})[record.meaning(code)] = None
        for code, sentence in _told(asked, record.example, model_answers):
            if code in record.codes:
                sentences.setdefault(code, {})[sentence] = None
    return [
        NamedMisconception(code, "; ".join(meanings[code]), tuple(sentences.get(code, ())))
        for code in sorted(meanings)
    ]


def _told(exercise: Exercise, example: Example, model_answers: Any) -> list[tuple[str, str]]:
    name, part, answer, *unit = example
    if isinstance(answer, str):
        answer = answer.replace(" ↵ ", "\n")
    elif isinstance(answer, dict) and any("/" in place for place in answer):
        answer = _with_changes(model_answers(name)[part], answer)
    angle_unit: AngleUnit = "degrees" if unit else "radians"
    report = grade(exercise, Submission({part: answer}, angle_unit, FeedbackLevel.FULL))
    return [
        (message.code, message.message)
        for each in report.parts
        if each.part == part
        for message, _, _ in messages_of(each)
    ]


def _with_changes(answer: Any, changes: Mapping[str, str]) -> Any:
    changed = json.loads(json.dumps(answer))
    for place, written in changes.items():
        rows = changed["rows"] if isinstance(changed, dict) else changed
        row, _, cell = place.partition("/")
        if row.startswith("A"):
            matrix, _, row = row[1:].partition(".")
            rows = rows[int(matrix) - 1]
        target = rows[int(row) - 1]
        if isinstance(target, dict):
            target[cell] = written
        elif isinstance(target, list):
            target[int(cell) - 1] = written
        else:
            rows[int(row) - 1] = written
    return changed
