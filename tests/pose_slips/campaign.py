"""Submit answers computed from a wrong table, and check that the report names the slip."""

import re
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import sympy as sp
from dh_grader.catalogue import Exercise, load_exercise
from dh_grader.grading import PartReport, Severity, Submission, Verdict, grade
from dh_grader.grading.report import messages_of

from tests.pose_slips.chain import link, pose, printed
from tests.pose_slips.robots import SpoiltRobot
from tests.pose_slips.slips import TableSlip, slips_of

KINDS = ("transform", "rotation", "position", "links")
# The tolerance in which two answers are equal, at generic joint values.
SAME = 1e-9


@dataclass(frozen=True)
class Trial:
    """A graded answer with a slip."""

    # `outcome` is "named", "silent", "unread", "several messages: …", or the one wrong message.
    robot: str
    kind: str
    slip: TableSlip
    alone: bool
    outcome: str


def exercise_of(robot: SpoiltRobot) -> Exercise:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"{robot.name}.toml"
        file.write_text(robot.text, encoding="utf-8")
        return load_exercise(file)


def answer_to(kind: str, robot: SpoiltRobot, rows: list[list[sp.Expr]]) -> Any:
    """Return the answer of a student who computes it from this table."""
    if kind == "links":
        return [printed(link(row, robot.convention)) for row in rows]
    reached = pose(rows, robot.convention)
    if kind == "transform":
        return printed(reached)
    if kind == "rotation":
        return printed(reached[:3, :3])
    return [str(reached[i, 3]) for i in range(3)]


def spoilt(robot: SpoiltRobot, slip: TableSlip | None) -> list[list[sp.Expr]]:
    if slip is not None and slip.rows:
        return [list(row) for row in slip.rows]
    rows = [list(row) for row in robot.rows]
    if slip is not None:
        rows[slip.row][slip.column] = slip.cell
    return rows


class Numbers:
    """Computes link transforms at random joint values."""

    def __init__(self, robot: SpoiltRobot) -> None:
        self.robot = robot
        symbols = sorted(
            {s for row in robot.rows for cell in row for s in cell.free_symbols}, key=str
        )
        values = np.random.default_rng(3).uniform(0.3, 1.1, len(symbols))
        self.values = dict(zip(symbols, values.tolist(), strict=True))

    def of(self, slip: TableSlip | None) -> np.ndarray:
        rows = spoilt(self.robot, slip)
        numeric = [[float(cell.subs(self.values)) for cell in row] for row in rows]
        return np.array(
            [
                np.array(link([sp.Float(cell) for cell in row], self.robot.convention), dtype=float)
                for row in numeric
            ]
        )


def asked(kind: str, links: np.ndarray) -> np.ndarray:
    if kind == "links":
        return links
    reached: np.ndarray = np.linalg.multi_dot(links) if len(links) > 1 else links[0]
    if kind == "position":
        return reached[:3, 3]
    return reached[:3, :3] if kind == "rotation" else reached


def trials(robot: SpoiltRobot, chosen: Callable[[int], bool] = lambda _: True) -> Iterator[Trial]:
    exercise, numbers, slips = exercise_of(robot), Numbers(robot), list(slips_of(robot))
    right, found = numbers.of(None), [numbers.of(slip) for slip in slips]
    for kind in KINDS:
        answers = [asked(kind, each) for each in found]
        correct = asked(kind, right)
        for k, slip in enumerate(slips):
            # A wrong table may have another number of link transforms.
            has_shape = answers[k].shape == correct.shape
            if not chosen(k) or not has_shape or _is_same(answers[k], correct):
                continue
            alike = [
                other
                for m, other in enumerate(slips)
                if m != k and _is_same(answers[m], answers[k])
            ]
            submission = Submission({kind: answer_to(kind, robot, spoilt(robot, slip))})
            report = next(p for p in grade(exercise, submission).parts if p.part == kind)
            yield Trial(robot.name, kind, slip, not alike, outcome(report, slip, alone=not alike))


def _is_same(one: np.ndarray, other: np.ndarray) -> bool:
    return one.shape == other.shape and bool(np.abs(one - other).max() < SAME)


def outcome(report: PartReport, slip: TableSlip, *, alone: bool) -> str:
    if report.verdict is Verdict.UNREADABLE:
        return "unread"
    said = [m for m, _, _ in messages_of(report) if m.severity is Severity.ERROR]
    if not said:
        return "silent"
    if len(said) > 1:
        return f"several messages: {sorted({m.code for m in said})}"
    [message] = said
    pairs = re.findall(r"joints? (\d+)(?: and (\d+))?", message.message, re.IGNORECASE)
    joints = {int(number) for pair in pairs for number in pair if number}
    is_placed = slip.joint in joints or f"row {slip.label}" in message.message
    if (is_placed or slip.rows) and (message.code in slip.codes or not alone):
        return "named"
    return f"{message.code}: {message.message}"
