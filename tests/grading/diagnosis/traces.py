"""Record which misconceptions a grading tries."""

import json
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, cast
from unittest.mock import patch

from dh_grader.catalogue import Exercise, load_catalogue
from dh_grader.expressions import AngleUnit
from dh_grader.grading import FeedbackLevel, Submission, grade
from dh_grader.grading.misconception import Hypothesis, Record
from dh_grader.solutions import solve

from tests.grading.support.submitting import all_codes
from tests.shipped import shipped_exercises

END = " ↵ "
MADE = Path(__file__).parents[2] / "docs" / "sentence_examples.toml"


@dataclass
class Trace:
    """The misconceptions that a grading tried, and those that explained the answer."""

    asked: set[Record] = field(default_factory=set)
    explaining: set[Record] = field(default_factory=set)
    codes: set[str] = field(default_factory=set)
    is_right: bool = False


@contextmanager
def traced() -> Iterator[Trace]:
    """Yield a trace that records all gradings in the ``with`` block."""
    trace = Trace()
    findings = Hypothesis.findings.fget  # type: ignore[attr-defined]
    hypotheses, verdict = Record.hypotheses, Record.verdict

    def explaining(self: Hypothesis[Any]) -> Any:
        if self.record is not None:
            trace.explaining.add(self.record)
        return findings(self)

    def asked(self: Record, source: object) -> Any:
        trace.asked.add(self)
        return hypotheses(self, source)

    def checked(self: Record, source: object) -> Any:
        trace.asked.add(self)
        return verdict(self, source)

    with (
        patch.object(Hypothesis, "findings", property(explaining)),
        patch.object(Record, "hypotheses", asked),
        patch.object(Record, "verdict", checked),
    ):
        yield trace


@cache
def model_answers(exercise_id: str) -> Mapping[str, Any]:
    """Return the model answer to each part of an exercise."""
    return {part.part: part.answer for part in solve(exercises()[exercise_id]).parts}


@cache
def exercises() -> Mapping[str, Exercise]:
    """Return the shipped exercises, and exercises made for the tests of misconceptions."""
    made = tomllib.loads(MADE.read_text(encoding="utf-8"))["made"]
    with TemporaryDirectory() as folder:
        for name, text in made.items():
            head = f'title = "{name}"\nsource = "made"\nstatement = "Made for an example."\n'
            (Path(folder) / f"{name}.toml").write_text(head + text, encoding="utf-8")
        return {**shipped_exercises(), **load_catalogue(Path(folder))}


def answered(exercise_id: str, part_id: str, answer: Any) -> Any:
    if isinstance(answer, str):
        return answer.replace(END, "\n")
    if not (isinstance(answer, dict) and any("/" in place for place in answer)):
        return answer
    rows = json.loads(json.dumps(model_answers(exercise_id)[part_id]))
    for place, written in answer.items():
        row, _, cell = place.partition("/")
        _write(rows, row, cell, written)
    return rows


def _write(rows: Any, row: str, cell: str, written: str) -> None:
    if isinstance(rows, dict):
        rows = rows["rows"]
    if row.startswith("A"):
        matrix, _, row = row[1:].partition(".")
        rows = rows[int(matrix) - 1]
    target = rows[int(row) - 1]
    if cell.startswith("origin_"):
        target["origin"]["xyz".index(cell[-1])] = written
    elif isinstance(target, dict):
        assert cell in target
        target[cell] = written
    elif isinstance(target, list):
        target[int(cell) - 1] = written
    else:
        assert cell == "1"
        rows[int(row) - 1] = written


def trace_of(exercise_id: str, part_id: str, answer: Any, unit: str = "radians") -> Trace:
    exercise = exercises()[exercise_id]
    sent = {part_id: answered(exercise_id, part_id, answer)}
    with traced() as trace:
        report = grade(exercise, Submission(sent, cast("AngleUnit", unit), FeedbackLevel.FULL))
    [part] = (part for part in report.parts if part.part == part_id)
    trace.codes = all_codes(part)
    trace.is_right = part.points == part.max_points
    return trace
