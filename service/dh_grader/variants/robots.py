"""Generated robots for practice: their ids, exercises and difficulty, and which is next."""

import secrets
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import lru_cache
from typing import Final

import numpy as np

from dh_grader.catalogue import Exercise, ExerciseLevel
from dh_grader.catalogue.exercise import compile_exercise
from dh_grader.catalogue.schema import ExerciseSpec
from dh_grader.grading import FeedbackLevel, Submission, grade
from dh_grader.importing.exercise_text import (
    HomeRobot,
    home_statement,
    lettered,
    number_text,
    rows_in,
)
from dh_grader.kinematics import A, Convention, D
from dh_grader.regex import regex
from dh_grader.translations import Sentence, say, template
from dh_grader.variants.robot_geometry import (
    DIFFERENT,
    LEVELS,
    SLIDE,
    Draws,
    Grammar,
    HomePath,
    Plan,
    Relation,
    Seen,
    clear_view,
    home_path,
    plan,
    plan_along,
    reason_against,
    skeleton,
    table_of,
)

# --- The ids of generated robots: ``practice-2-modified~k3f9``


_DIGITS: Final = "0123456789abcdefghijklmnopqrstuvwxyz"
_LONGEST: Final = 8
_ID: Final = regex(
    rf"practice-(\d)-({'|'.join(Convention)})~(0|[1-9a-z][0-9a-z]{{0,{_LONGEST - 1}}})"
)
# Every seed below is a robot's number.
ALL_NUMBERS: Final = 36**_LONGEST


@dataclass(frozen=True, slots=True)
class PracticeId:
    """The id of a generated robot: a level, a convention and a number."""

    # Both conventions have the same robots.

    level: int
    convention: Convention
    number: int

    @property
    def seed(self) -> str:
        """The number of the robot in base 36 (digits 0 to 9 and a to z)."""
        digits, left = "", self.number
        while left or not digits:
            left, digit = divmod(left, len(_DIGITS))
            digits = _DIGITS[digit] + digits
        return digits

    @property
    def exercise(self) -> str:
        """The id without the number of the robot."""
        return f"practice-{self.level}-{self.convention.value}"

    def __str__(self) -> str:
        return f"{self.exercise}~{self.seed}"

    def following(self, steps: int = 1) -> "PracticeId":
        """Return the id of the robot whose number is greater by ``steps``."""
        # After the last robot comes the first.
        return replace(self, number=(self.number + steps) % ALL_NUMBERS)


def practice_id(text: str) -> PracticeId | None:
    """Return the parts of a robot's id; None if the text is not the id of a robot.

    >>> practice_id("practice-2-modified~1a")
    PracticeId(level=2, convention=<Convention.MODIFIED: 'modified'>, number=46)
    """
    found = _ID.fullmatch(text)
    if found is None or int(found[1]) not in LEVELS:
        return None
    return PracticeId(int(found[1]), Convention(found[2]), int(found[3], len(_DIGITS)))


# --- Generate a robot from a level and a number
#
# Random robots are drawn until one is acceptable.


_TRIES: Final = 1000
# After this number of refusals, a simple robot gets the next directions.
_TRIES_OF_A_SKELETON: Final = 18
# Levels at which directions are counted off.
_SIMPLE: Final = 2


@dataclass(frozen=True, slots=True)
class Generated:
    """A generated robot, the path of its links, and the view in its figure."""

    plan: Plan
    path: HomePath
    view: Seen


def generated(level: int, number: int) -> Generated:
    """Return the robot with this number. Equal arguments give equal robots on every machine."""
    rules = LEVELS[level]
    for attempt in range(_TRIES):
        draws = Draws(f"robot {level} {number} {attempt}")
        drawn = _simple(rules, number, attempt, draws) if level <= _SIMPLE else plan(rules, draws)
        if drawn is None:
            continue
        path = home_path(drawn.rows)
        if reason_against(drawn, path) is None and (view := clear_view(path)):
            return Generated(drawn, path, view)
    raise AssertionError(f"no robot of level {level} has the number {number}")


def _simple(rules: Grammar, number: int, attempt: int, draws: Draws) -> Plan | None:
    shape = skeleton(rules, number + DIFFERENT * (attempt // _TRIES_OF_A_SKELETON))
    return None if shape is None else plan_along(shape, rules, draws)


# --- Make an exercise about a generated robot, which asks for its DH table


_POINTS_OF_A_ROW: Final = 2
_MINUTES_OF_A_ROW: Final = 3
_LEVELS: Final = {
    1: ExerciseLevel.START,
    2: ExerciseLevel.BASICS,
    3: ExerciseLevel.ARMS,
    4: ExerciseLevel.INDUSTRIAL,
}
# The numbers of joints, from two.
_FEWEST_JOINTS: Final = 2
_JOINTS: Final = (
    template("Two joints"),
    template("Three joints"),
    template("Four joints"),
    template("Five joints"),
    template("Six joints"),
    template("Seven joints"),
)


def robot_exercise(name: PracticeId) -> Exercise:
    """Return the exercise with this id. Equal ids give equal exercises on every machine."""
    return compile_exercise(str(name), ExerciseSpec.model_validate(_fields(name)))


def _fields(name: PracticeId) -> dict[str, object]:
    """Return the fields of the robot's exercise file."""
    robot = generated(name.level, name.number)
    home = home_robot(robot.plan)
    rows = rows_in(home, name.convention)
    structure, convention = robot.plan.structure, name.convention.value
    return {
        "title": say("Practice robot {robot}, level {level}", robot=name.seed, level=name.level),
        "source": say(
            "Generated by DH Grader: level {level}, robot {robot}",
            level=name.level,
            robot=name.seed,
        ),
        "level": _LEVELS[name.level].value,
        "minutes": _MINUTES_OF_A_ROW * len(rows),
        "summary": _summary(robot.plan),
        "statement": home_statement(home, name.convention),
        "robot": {
            "structure": structure,
            "convention": convention,
            "joints": home.variables,
            "table": [list(row) for row in rows],
        },
        "symbols": _symbols(robot, home),
        "view": {"azimuth": robot.view.azimuth, "elevation": robot.view.elevation},
        "parts": [
            {
                "id": "table",
                "kind": "dh_table",
                "title": say("Denavit-Hartenberg table"),
                "prompt": _prompt(name.convention, has_tool_row=len(rows) > len(structure)),
                "points": float(_POINTS_OF_A_ROW * len(rows)),
                "convention": convention,
                "frames": "free",
            }
        ],
    }


def _summary(plan: Plan) -> Sentence:
    structure = plan.structure
    joints = say(_JOINTS[len(structure) - _FEWEST_JOINTS])
    if plan.letters:
        return say(
            "{joints} ({structure}), lengths as letters.", joints=joints, structure=structure
        )
    return say("{joints} ({structure}), lengths in metres.", joints=joints, structure=structure)


def _prompt(convention: Convention, *, has_tool_row: bool) -> Sentence:
    if convention is Convention.STANDARD:
        if has_tool_row:
            return say(
                "Give the standard DH table, one row for each joint, and a row e for the tool "
                "frame."
            )
        return say("Give the standard DH table, one row for each joint.")
    if has_tool_row:
        return say(
            "Give the modified DH table, one row for each joint, and a row e for the tool frame."
        )
    return say("Give the modified DH table, one row for each joint.")


def home_robot(plan: Plan) -> HomeRobot:
    """Return a planned robot, with letters or with numbers as its lengths."""
    table = table_of(plan)
    if plan.letters:
        return lettered(HomeRobot(table, plan.structure))
    # Each number is written as a letter would be: "0.2 + 0.35".
    numbers = {
        (i, j): {number_text(float(table[i, j])): 1.0}
        for i, j in np.argwhere(table).tolist()
        if j in (A, D)
    }
    table[:, [A, D]] = 0
    lengths = {text: float(text) for number in numbers.values() for text in number}
    return HomeRobot(table, plan.structure, numbers, lengths)


def _symbols(robot: Generated, home: HomeRobot) -> Mapping[str, object]:
    low, high = (number_text(cm / 100) for cm in SLIDE)
    symbols = {
        f"d{i}": _length((low, high), say("displacement of joint {joint}", joint=i))
        for i, kind in enumerate(robot.plan.structure, 1)
        if kind == "P"
    }
    if robot.plan.letters:
        for (_, j), [letter] in home.letters.items():
            length = home.lengths[letter]
            between = tuple(number_text(factor * length) for factor in (0.7, 1.3))
            meaning = say("distance between two axes") if j == A else say("distance along an axis")
            symbols[letter] = _length(between, meaning)
    return symbols


def _length(between: tuple[str, ...], description: str) -> dict[str, object]:
    return {"kind": "length", "unit": "m", "range": between, "description": description}


# --- A catalogue in which generated robots can be found by their ids
#
# They are not listed.


# An exercise takes about 60 kB. A class at practice uses fewer robots at the same time.
MOST_ROBOTS: Final = 256


@lru_cache(maxsize=MOST_ROBOTS)
def _memoized(name: PracticeId) -> Exercise:
    return robot_exercise(name)


class CatalogueWithPractice(Mapping[str, Exercise]):
    """A catalogue of exercises, extended by all generated robots."""

    # They are made when they are asked for.

    def __init__(self, catalogue: Mapping[str, Exercise]) -> None:
        self._catalogue = catalogue

    def __getitem__(self, exercise_id: str) -> Exercise:
        name = practice_id(exercise_id)
        return self._catalogue[exercise_id] if name is None else _memoized(name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._catalogue)

    def __len__(self) -> int:
        return len(self._catalogue)


# --- The difficulty of a generated robot, and what a student can practise with it


class Situation(StrEnum):
    """A feature of a robot that a student may want to practise."""

    OFFSET = "offset"
    """A row with a length along its axis and one between the axes, or two axes that are skew."""
    SLIDING = "sliding"
    """A joint that slides."""
    PARALLEL = "parallel"
    """Two parallel axes in a row."""
    TURNED = "turned"
    """A row with a constant angle beside the joint variable."""


@dataclass(frozen=True, slots=True)
class Difficulty:
    """Counts of what makes a robot difficult.

    ``turns`` counts the changes of direction from one axis to the next. ``choices`` counts the rows
    with a free choice of frame (parallel axes, sliding joints). ``odd`` counts the twists of 30°,
    45° or 60°.
    """

    joints: int
    turns: int
    offsets: int
    sliding: int
    choices: int
    odd: int

    @property
    def total(self) -> int:
        """The difficulty as one number."""
        # It is the sum of the counts, in which odd twists and joints count twice.
        once = self.turns + self.offsets + self.sliding + self.choices
        return 2 * (self.joints + self.odd) + once


def difficulty(plan: Plan) -> Difficulty:
    """Return the difficulty of a robot."""
    rows = plan.rows
    return Difficulty(
        joints=len(rows),
        turns=sum(bool(row.alpha % 180) for row in rows),
        offsets=sum(bool(row.a and (row.d or row.alpha % 180)) for row in rows),
        sliding=sum(row.sliding for row in rows),
        choices=sum(row.sliding or bool(row.relation and not row.alpha % 180) for row in rows),
        odd=sum(bool(row.alpha % 90) for row in rows),
    )


def situations(plan: Plan) -> set[Situation]:
    """Return the features of a robot that a student may want to practise."""
    found = set()
    for row in plan.rows:
        if row.a and (row.d or row.relation is Relation.SKEW):
            found.add(Situation.OFFSET)
        if row.sliding:
            found.add(Situation.SLIDING)
        if row.relation in (Relation.PARALLEL, Relation.ANTIPARALLEL):
            found.add(Situation.PARALLEL)
        if row.theta:
            found.add(Situation.TURNED)
    return found


# --- Choose the next robot for a student who practises


# The first robot of a student is one of these: their ids are short.
_FIRST = 36**4
# How many robots are looked at; most levels have each situation in every third.
_MOST_LOOKS = 24
# The largest share of the points that a lazy answer may earn.
_MOST_FOR_NOTHING = 0.25


def first_robot(level: int, convention: Convention) -> PracticeId:
    """Return a random robot of a level."""
    return PracticeId(level, convention, secrets.randbelow(_FIRST))


def candidates(
    level: int, convention: Convention, after: PracticeId | None
) -> Iterator[PracticeId]:
    """Yield robots, one after the other, from which the caller takes the first suitable one."""
    # They begin after ``after``, or with a random robot. If none is suitable, the caller takes the
    # last. Many consecutive robots are all different.
    start = first_robot(level, convention) if after is None else after.following()
    start = replace(start, level=level, convention=convention)
    for steps in range(_MOST_LOOKS):
        yield start.following(steps)


def has_situation(name: PracticeId, favour: Situation) -> bool:
    """True if the robot has a situation that the student wants to practise."""
    return favour in situations(generated(name.level, name.number).plan)


def asks_enough(robot: Exercise) -> bool:
    """True if an answer of only zeros and joint variables earns little for a generated robot."""
    # For a few robots in a hundred, this answer earns more, and students do not get these robots as
    # the next robot. Which robots these are depends on the marking. A link to a robot must not
    # depend on the marking, so these robots exist nevertheless.
    [part] = robot.parts
    [table] = [robot.robot.tables[convention] for convention in robot.conventions]
    lazy = Submission({part.id: {"rows": table.lazy_rows}}, feedback=FeedbackLevel.SCORE)
    return grade(robot, lazy).score <= _MOST_FOR_NOTHING


def difficulty_of(name: PracticeId) -> int:
    """Return the difficulty of a robot as one number."""
    return difficulty(generated(name.level, name.number).plan).total
