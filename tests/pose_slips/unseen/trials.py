"""Grade wrong answers about random arms, and check which slips are named."""

import tempfile
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
from dh_grader.catalogue import Exercise, load_exercise
from dh_grader.grading import Severity, Submission, grade
from dh_grader.grading.report import messages_of

from tests.pose_slips.unseen.algebra import Matrix, link, numeric_link, product, text
from tests.pose_slips.unseen.arms import Arm
from tests.pose_slips.unseen.slips import (
    CELL,
    OTHER_FORMULA,
    PRODUCT,
    SWAPPED_ROW,
    ArmSlip,
    slips_of,
)

KINDS = ("transform", "rotation", "position", "links")
SAME = 1e-9
# Nobody types an entry with more terms.
MOST_TERMS = 120
Said = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class ArmTrial:
    """A graded answer, its slip, and the report's messages."""

    # `said` are the codes and the messages of the report.
    kind: str
    slip: ArmSlip
    codes: frozenset[str]
    said: Said

    @property
    def is_alone(self) -> bool:
        return self.codes == self.slip.codes

    @property
    def is_named(self) -> bool:
        return len(self.said) == 1 and self.said[0][0] in self.codes

    @property
    def is_placed(self) -> bool:
        return self.is_named and all(word in self.said[0][1] for word in self.slip.words)


def exercise_of(arm: Arm) -> Exercise:
    return loaded(arm.text)


def loaded(text: str) -> Exercise:
    """Return the exercise of a file with this text."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "unseen.toml"
        file.write_text(text, encoding="utf-8")
        return load_exercise(file)


def right_answer(arm: Arm) -> ArmSlip:
    return ArmSlip("", frozenset(), arm.table, arm.convention, tuple(range(len(arm.table))))


def answer_to(kind: str, slip: ArmSlip) -> Any:
    links = [link(slip.table[i], slip.convention) for i in slip.order]
    if kind == "links":
        return [_printed(matrix) for matrix in links]
    reached = product(links)
    if any(len(entry) > MOST_TERMS for row in reached for entry in row):
        return None
    if kind == "position":
        return [text(reached[i][3]) for i in range(3)]
    return _printed(reached) if kind == "transform" else [r[:3] for r in _printed(reached)[:3]]


def _printed(matrix: Matrix) -> list[list[str]]:
    return [[text(entry) for entry in row] for row in matrix]


def said_of(exercise: Exercise, kind: str, answer: Any) -> Said:
    report = grade(exercise, Submission({kind: answer}))
    part = next(part for part in report.parts if part.part == kind)
    messages = [m for m, _, _ in messages_of(part) if m.severity is Severity.ERROR]
    return tuple((m.code, m.message) for m in messages)


class Slipped:
    """The slips in an arm's table, and the wrong answers that they cause."""

    def __init__(self, kind: str, arm: Arm, slips: Sequence[ArmSlip]) -> None:
        self.kind, self.arm, self.slips = kind, arm, slips
        every = [right_answer(arm), *slips]
        names = {n for s in every for row in s.table for cell in row for n in cell if n}
        self.values = dict(
            zip(sorted(names), np.random.default_rng(5).uniform(0.3, 1.2, len(names)), strict=True)
        )
        self.right, *self.found = (self.of(slip) for slip in every)

    def of(self, slip: ArmSlip, shift: float = 0.0) -> np.ndarray:
        at = {n: v + shift if n.startswith("q") else v for n, v in self.values.items()}
        links = [numeric_link(slip.table[i], slip.convention, at) for i in slip.order]
        if self.kind == "links":
            return np.array(links)
        reached: np.ndarray = np.linalg.multi_dot([np.eye(4), *links])
        if self.kind == "position":
            return reached[:3, 3]
        return reached if self.kind == "transform" else reached[:3, :3]

    def is_answer(self, slip: ArmSlip) -> bool:
        found = self.of(slip)
        if found.shape != self.right.shape or (self.kind == "links" and slip.kind == PRODUCT):
            return False
        return not _is_same(found, self.of(slip, 0.2)) and not _is_same(found, self.right)

    def alike(self, slip: ArmSlip) -> list[ArmSlip]:
        wanted = self.of(slip)
        pairs = zip(self.slips, self.found, strict=True)
        return [each for each, found in pairs if _is_same(found, wanted)]

    def codes(self, slip: ArmSlip) -> frozenset[str]:
        of_slips: frozenset[str] = frozenset().union(*(each.codes for each in self.alike(slip)))
        if self.kind != "links" or slip.kind == CELL:
            return of_slips | of_numbers(self.of(slip), self.right)
        if slip.kind == OTHER_FORMULA and not any(row[1] for row in self.arm.table):
            return of_slips | {"translation_not_turned"}
        return of_slips


def _is_same(one: np.ndarray, other: np.ndarray) -> bool:
    return one.shape == other.shape and bool(np.abs(one - other).max() < SAME)


def of_numbers(found: np.ndarray, right: np.ndarray) -> frozenset[str]:
    differs = np.abs(found - right) > SAME
    is_opposite = np.abs(found + right) < SAME
    codes = {"sign"} if differs.sum() == 1 and is_opposite[differs].all() else set()
    if found.ndim == 3:
        return frozenset(codes.union(*map(of_numbers, found, right)))
    if found.ndim == 1:
        return frozenset(codes | ({"reversed_position"} if is_opposite.all() else set()))
    turn, wanted = found[:3, :3], right[:3, :3]
    if _is_same(turn, wanted):
        reversed_position = differs.any() and is_opposite[:3, 3].all()
        return frozenset(codes | ({"column_sign"} if reversed_position else set()))
    if _is_same(turn, wanted.T):
        codes |= {"transposed_rotation", "transposed_matrix", "inverse_transform"}
    for code, signs in (("column_sign", turn.T @ wanted), ("row_sign", turn @ wanted.T)):
        if _is_same(np.abs(signs), np.eye(3)):
            codes |= {code, "half_turn"}
    return frozenset(codes)


def trials(arm: Arm, seed: int, each: int = 2) -> Iterator[ArmTrial]:
    random, exercise, slips = Random(seed), exercise_of(arm), list(slips_of(arm))
    for kind in KINDS:
        slipped = Slipped(kind, arm, slips)
        classes: dict[str, list[ArmSlip]] = defaultdict(list)
        for slip in filter(slipped.is_answer, slips):
            classes[slip.kind].append(slip)
        for of_class in classes.values():
            for slip in random.sample(of_class, min(each, len(of_class))):
                yield from _trial(slipped, exercise, slip)


def _trial(slipped: Slipped, exercise: Exercise, slip: ArmSlip) -> Iterator[ArmTrial]:
    answer = answer_to(slipped.kind, slip)
    said = () if answer is None else said_of(exercise, slipped.kind, answer)
    # A truncated answer no longer has the slip.
    if answer is not None and "too_long" not in dict(said):
        yield ArmTrial(slipped.kind, slip, slipped.codes(slip), said)


def two_slips(arm: Arm, seed: int, each: int = 3) -> Iterator[ArmTrial]:
    random, exercise, slips = Random(seed), exercise_of(arm), list(slips_of(arm))
    of_row = [slip for slip in slips if slip.kind in (CELL, SWAPPED_ROW)]
    for kind in KINDS:
        slipped = Slipped(kind, arm, slips)
        for _ in range(each):
            one, other = random.sample(of_row, 2)
            both = tuple(
                second if first == right else first
                for first, second, right in zip(one.table, other.table, arm.table, strict=True)
            )
            slip = ArmSlip("two slips", frozenset(), both, arm.convention, one.order)
            # Skip two slips in one row, and slips that cancel each other or change nothing.
            is_single = _is_same(slipped.of(one), slipped.of(slip))
            if slipped.is_answer(slip) and not is_single and not slipped.codes(slip):
                yield from _trial(slipped, exercise, slip)
