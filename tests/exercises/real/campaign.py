"""Grade random tables of the real robots, valid and wrong."""

# `python -m tests.exercises.real` draws 1,000 valid and 1,000 wrong tables of every robot; the
# suite draws a few. Base frame, tool frame and joint directions vary if the exercise leaves them to
# the student.

import zlib
from collections import Counter
from dataclasses import dataclass, field

import numpy as np
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.kinds import DhTableSpec

from tests.frame_choice import oracle
from tests.frame_choice.generator import Table, reassignment
from tests.frame_choice.robots import POLICIES, Policy, Robot
from tests.frame_choice.rows.student_rows import robot_of
from tests.frame_choice.trials import CrashError, equivalent, graded, one_slip
from tests.shipped import shipped_exercises

VALID, ACCEPTED, WRONG, REFUSED = "valid", "accepted", "wrong", "refused"


@dataclass
class Found:
    """Counts of graded tables, and the tables that were graded wrongly."""

    counts: Counter[str] = field(default_factory=Counter)
    misses: list[str] = field(default_factory=list)

    def try_whole(self, table: Table) -> None:
        self.counts[VALID] += 1
        try:
            found = graded(table)
        except CrashError as error:
            self.misses.append(f"exception {error.__cause__!r}: {table.texts}")
            return
        if found.full_marks and found.is_clean:
            self.counts[ACCEPTED] += 1
        else:
            self.misses.append(f"valid, not accepted: {table.texts}")

    def try_wrong(self, table: Table) -> None:
        self.counts[WRONG] += 1
        try:
            found = graded(table)
        except CrashError as error:
            self.misses.append(f"exception {error.__cause__!r}: {table.texts}")
            return
        if found.full_marks:
            self.misses.append(f"wrong, full marks: {table.texts}")
        else:
            self.counts[REFUSED] += 1


def policy_of(exercise: Exercise) -> Policy:
    [spec] = [part for part in exercise.parts if isinstance(part, DhTableSpec)]
    free = tuple(each == "free" for each in (spec.base, spec.tool, spec.directions))
    [policy] = [each for each in POLICIES if (each.base, each.tool, each.directions) == free]
    return policy


def convention_of(exercise: Exercise) -> str:
    """Return the convention that the exercise asks for."""
    [spec] = [part for part in exercise.parts if isinstance(part, DhTableSpec)]
    return str(spec.convention)


def run(name: str, tables: int, seed: int) -> Found:
    exercise = shipped_exercises()[name]
    robot: Robot = robot_of(exercise)
    policy, convention = policy_of(exercise), convention_of(exercise)
    rng = np.random.default_rng(zlib.crc32(f"{seed} {name}".encode()))
    found = Found()
    while found.counts[WRONG] < tables:
        table, _ = reassignment(robot, policy, convention, rng)
        if not equivalent(table):
            raise AssertionError(f"the generator drew a wrong table: {table.texts}")
        if found.counts[VALID] < tables:
            found.try_whole(table)
        edit = one_slip(table, rng)
        if edit is not None:
            found.try_wrong(table.edited(edit.row, edit.column, edit.cell))
    for cached in (oracle.samples, oracle.reference_poses):
        cached.cache_clear()
    return found
