"""Checks of an exercise for its author, before students see it, and a template for a new one.

The checks grade the exercise as students would be graded. They know nothing about files on a
server or about the editor.
"""

import json
import math
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cache, partial
from itertools import combinations
from pathlib import Path
from typing import Any, Final

import numpy as np

from dh_grader.catalogue import (
    ID_ADVICE,
    CheckSpec,
    Exercise,
    PartSpec,
    PosePartSpec,
    Variable,
    grid_values,
    is_exercise_id,
)
from dh_grader.catalogue.kinds import FindSlipSpec
from dh_grader.catalogue.robot import TRIALS, Reference, trial_values
from dh_grader.catalogue.schema import ExpectSpec
from dh_grader.expressions import LIMITS, AngleUnit, Expression
from dh_grader.expressions.parser import in_degrees
from dh_grader.expressions.vocabulary import Node, Number, Unit, children
from dh_grader.grading import FeedbackLevel, PartReport, Submission, Verdict, grade
from dh_grader.grading.kinds.tables import slip_of
from dh_grader.grading.misconception import Example, all_records
from dh_grader.grading.report import messages_of
from dh_grader.kinematics import Numbers, coincident, exponential, identity, moved, rank
from dh_grader.regex import regex
from dh_grader.solutions import solve
from dh_grader.solutions.answers import LAZY
from dh_grader.translations import Sentence, joined, say, say_count, template

__all__ = [
    "Level",
    "Remark",
    "UnusableIdError",
    "examine",
    "exercise_template",
    "failures",
    "summary",
]


# --- The template of a new exercise file


_TEMPLATE: Final = Path(__file__).with_suffix(".toml")
_SHOWN: Final = 60


class UnusableIdError(ValueError):
    """The text cannot be the id of an exercise."""

    def __init__(self, exercise_id: str) -> None:
        super().__init__(
            say(
                "{id!r} cannot be an exercise's id: {advice}",
                id=exercise_id[:_SHOWN],
                advice=ID_ADVICE,
            )
        )


def exercise_template(exercise_id: str, like: Path | None = None) -> str:
    """Return the text of a new exercise file, or a copy of the file ``like``.

    Raises UnusableIdError.
    """
    if not is_exercise_id(exercise_id):
        raise UnusableIdError(exercise_id)
    if like is not None:
        return like.read_text(encoding="utf-8")
    title = exercise_id.replace("-", " ").replace("_", " ").capitalize()
    return _TEMPLATE.read_text(encoding="utf-8").replace("TITLE", title, 1)


# --- The misconceptions that the grader can name in the answers to an exercise


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


# --- Remarks on a readable exercise file


class Level(StrEnum):
    """The level of a remark: a failure must be fixed, a warning should be checked."""

    FAILED = "failed"
    WARNING = "warning"


@dataclass(frozen=True, slots=True)
class Remark:
    """A remark on a field of the file; ``field`` is empty if it is about the whole file."""

    level: Level
    field: str
    text: str


failed = partial(Remark, Level.FAILED)
warning = partial(Remark, Level.WARNING)


# --- Checks of symbols and numbers: ambiguous names, bad ranges, and degrees without a unit


_SHORTHAND: Final = regex(r"[cCsS][0-9]+")
# Names, and what students may mistake them for.
_MISLEADING: Final = {
    "e": say("Euler's number"),
    "E": say("Euler's number, or a power of ten"),
    "i": say("the imaginary unit or an index"),
    "j": say("the imaginary unit or an index"),
    "I": say("the digit 1 or the letter l"),
    "l": say("the digit 1 or the letter I"),
    "O": say("the digit 0"),
    "o": say("the digit 0"),
    "c": say("a cosine"),
    "s": say("a sine"),
}
# Beyond this ratio, a slip in a small length changes only the last digits of a pose.
MOST_RATIO: Final = 1000.0
# In a narrower range, a constant differs by a thousandth only and would count as rounded.
LEAST_WIDTH: Final = 0.01
# Larger numbers without π are probably degrees.
FULL_TURN: Final = 2 * math.pi
_LOOK_ALIKE: Final = str.maketrans("IlO", "110")


def ambiguous_symbols(exercise: Exercise) -> Iterator[Remark]:
    """Yield warnings about names that students may confuse."""
    for variable in exercise.variables:
        for problem in _symbols_problems(variable, exercise):
            yield warning(f"symbols.{variable.name}", problem)
    alike = defaultdict(list)
    for variable in exercise.variables:
        as_seen = variable.name.translate(_LOOK_ALIKE).lower()
        alike[as_seen].append(variable.name)
    for names in alike.values():
        if len(names) > 1:
            yield warning(
                f"symbols.{names[1]}",
                say("looks like {other}: students may confuse them; rename one", other=names[0]),
            )


def unused_symbols(exercise: Exercise) -> Iterator[Remark]:
    """Yield a warning for each symbol that no formula of the file uses."""
    used = {name for _, formula, _ in exercise.fields() for name in formula.symbols}
    for variable in exercise.variables:
        if variable.joint is None and variable.name not in used:
            yield warning(
                f"symbols.{variable.name}",
                say("is in no formula: remove it, or say in the statement that it is not needed"),
            )


def _symbols_problems(variable: Variable, exercise: Exercise) -> Iterator[str]:
    name = variable.name
    if name in _MISLEADING:
        yield say(
            "may be read as {meaning}; give it a longer name, such as {name}1",
            meaning=_MISLEADING[name],
            name=name,
        )
    joints = {joint.index for joint in exercise.joints}
    if _SHORTHAND.fullmatch(name) and set(map(int, name[1:])) <= joints:
        yield say(
            "takes the place of the shorthand {name} for {function}: students who write "
            "{name} for that are marked wrong; rename it",
            name=name,
            function=_MISLEADING[name[0].lower()],
        )
    if variable.joint is None:
        for joint in exercise.joints:
            names = {f"q{joint.index}", f"{'d' if joint.prismatic else 'theta'}{joint.index}"}
            if name in names and name != joint.variable:
                yield say(
                    "is also what students call {variable}, the variable of joint {joint}; "
                    "rename one of them",
                    variable=joint.variable,
                    joint=joint.index,
                )


def badly_scaled(exercise: Exercise) -> Iterator[Remark]:
    """Yield warnings about narrow ranges, lengths near 0, and very different lengths."""
    for variable in exercise.variables:
        yield from _range(variable)
    sizes = {v.name: max(abs(v.low), abs(v.high)) for v in exercise.variables if v.kind == "length"}
    if not sizes:
        return
    least, most = min(sizes, key=sizes.__getitem__), max(sizes, key=sizes.__getitem__)
    if sizes[most] > MOST_RATIO * sizes[least]:
        yield warning(
            f"symbols.{least}.range",
            say(
                "reaches {size} where {most} reaches {largest}, so that a slip in {least} is too "
                "small to be detected; write lengths of one unit and similar size",
                size=f"{sizes[least]:g}",
                most=most,
                largest=f"{sizes[most]:g}",
                least=least,
            ),
        )


def _range(variable: Variable) -> Iterator[Remark]:
    field = f"symbols.{variable.name}.range"
    size = max(abs(variable.low), abs(variable.high))
    if variable.high - variable.low < LEAST_WIDTH * size:
        yield warning(
            field,
            say(
                "is so narrow that the number {low} may be accepted for {name}; widen it, or write "
                "the number in the formulas",
                low=f"{variable.low:g}",
                name=variable.name,
            ),
        )
    is_constant_length = variable.kind == "length" and variable.joint is None
    if is_constant_length and variable.low <= 0 <= variable.high:
        yield warning(
            field,
            say(
                "holds 0, where separate axes would intersect; begin above 0, as in {range}",
                range=f"[{size / 3:.1g}, {size:.1g}]",
            ),
        )
    ends = sorted((abs(variable.low), abs(variable.high)))
    if 0 < ends[0] * MOST_RATIO < ends[1]:
        yield warning(
            field,
            say(
                "goes from {low} to {high}; narrow it, because mistakes at one end are not "
                "detected at the other",
                low=f"{variable.low:g}",
                high=f"{variable.high:g}",
            ),
        )


def bare_degrees(exercise: Exercise) -> Iterator[Remark]:
    """Yield warnings about large angles without a unit, which are probably degrees."""
    for field, formula, quantity in exercise.fields():
        for term in _bare_terms(formula.tree, is_angle=quantity == "angle"):
            constant = Expression(formula.source, term, (), frozenset())
            value = float(constant.evaluate({}))
            if abs(value) > FULL_TURN:
                text = f"{value:.12g}" if isinstance(term, Number) else f"({constant.text()})"
                yield warning(
                    field,
                    say(
                        "angles without a unit are in radians, and {text} looks like degrees; did "
                        "you mean {text}deg?",
                        text=text,
                    ),
                )


def _bare_terms(tree: Node, *, is_angle: bool) -> Iterator[Node]:
    written = {(unit.start, unit.end) for unit in _units(tree)}
    for unit in _units(in_degrees(tree, is_angle=is_angle, notes=[])):
        if (unit.start, unit.end) not in written:
            yield unit.operand


def _units(node: Node) -> Iterator[Unit]:
    if isinstance(node, Unit):
        yield node
    for child in children(node):
        yield from _units(child)


# --- Check that the planted mistake of a part ``find_slip`` is possible in a table of the robot


def unfit_slips(exercise: Exercise) -> Iterator[Remark]:
    """Yield a failure for each part whose planted mistake fits no table of the robot."""
    for i, part in enumerate(exercise.parts):
        if not isinstance(part, FindSlipSpec) or part.slip is None:
            continue
        found = slip_of(part, exercise).misconception
        if found != part.slip:
            yield failed(
                f"parts[{i}].slip",
                say(
                    "no {convention} table of this robot has the slip {slip} alone; leave slip "
                    "out, or write another one, such as {found}",
                    convention=part.convention.value,
                    slip=part.slip,
                    found=found,
                ),
            )


# --- The points of answers that consist only of zeros and joint variables


# The largest share without a warning. A pose may earn more: with parallel axes, the lazy answer to
# its rotation, half of the pose, is right.
MOST: Final = 0.25
MOST_OF_A_POSE: Final = 0.5


def lazy_shares(exercise: Exercise) -> Mapping[str, float]:
    """Return the fraction of points that zeros and joint variables alone earn, by part id."""
    return {
        part.id: max(
            _share(_report(exercise, part.id, answer)) for answer in LAZY[part.kind](part, exercise)
        )
        for part in exercise.parts
    }


def summary(exercise: Exercise) -> Sentence:
    """Return one sentence about an exercise: its parts, its checks and its easiest points."""
    earned = [
        say("{share} % of {part}", share=math.floor(100 * share), part=part)
        for part, share in lazy_shares(exercise).items()
    ]
    return say(
        "{parts}, {checks}. Writing only zeros and joint variables earns {earned}.",
        parts=say_count("{count} part", "{count} parts", count=len(exercise.parts)),
        checks=say_count("{count} check", "{count} checks", count=len(exercise.checks)),
        earned=joined(", ", earned),
    )


def lazy_answers(exercise: Exercise) -> Iterator[Remark]:
    """Yield a warning for each part in which zeros and joint variables alone earn many points."""
    shares = lazy_shares(exercise)
    for i, part in enumerate(exercise.parts):
        share = shares[part.id]
        if share > (MOST_OF_A_POSE if part.kind == "transform" else MOST):
            yield warning(
                f"parts[{i}]",
                say(
                    "an answer of only zeros and joint variables earns {share} % of {part}; ask "
                    "for more, or mark it by content",
                    share=math.floor(100 * share),
                    part=part.id,
                ),
            )


def _report(exercise: Exercise, part: str, answer: object) -> PartReport:
    reports = grade(exercise, Submission({part: answer}, feedback=FeedbackLevel.SCORE)).parts
    return next(report for report in reports if report.part == part)


def _share(report: PartReport) -> float:
    return report.points / report.max_points


# --- The check that every joint of the reference robot adds a motion


WAYS = 6


def lost_freedom(exercise: Exercise) -> Iterator[Remark]:
    """Yield warnings about joints that add no motion."""
    robot = exercise.reference
    if robot is None:
        return
    jacobian = _jacobian(exercise, robot)
    pairs = np.argwhere(np.triu(coincident(jacobian)))
    for i, j in pairs.tolist():
        one, other = robot.joints[i], robot.joints[j]
        motion = (
            template(
                "joints {first} and {second} slide in one direction, so the arm has lost a degree "
                "of freedom; check the rows between them"
            )
            if one.prismatic
            else template(
                "joints {first} and {second} turn about one line, so the arm has lost a degree of "
                "freedom; check the rows between them"
            )
        )
        yield warning("robot", say(motion, first=one.index, second=other.index))
    ways, joints = rank(jacobian), len(robot.joints)
    if ways < min(joints, WAYS) and not len(pairs):
        yield warning(
            "robot",
            say(
                "the {joints} joints move the tool in {ways} ways only, in every "
                "configuration; check the rows, or say in the statement that the arm is "
                "redundant",
                joints=joints,
                ways=ways,
            ),
        )


def _jacobian(exercise: Exercise, robot: Reference) -> Numbers:
    # Source: Lynch and Park, *Modern Robotics*, eq. 5.11.
    values = trial_values(exercise.variables)
    reached = identity((TRIALS,))
    columns = []
    for joint, axis in zip(robot.joints, robot.screws(values, TRIALS), strict=True):
        column = moved(reached, axis)
        if not joint.prismatic:
            column[:, 3:] /= exercise.length_scale
        columns.append(column)
        reached = reached @ exponential(axis, values[joint.variable])
    return np.stack(columns, axis=-1)


# --- Check an exercise file by grading: its model answers, its checks, and duplicate parts


UNITS: Final[tuple[AngleUnit, ...]] = ("radians", "degrees")
# The recommended number of checks of each kind, which makes a mistake in the exercise unlikely.
WANTED: Final = {"right": 1, "equivalent": 1, "wrong": 2}
# Tutors write points with two decimals.
_SAME_POINTS: Final = 0.005
_SAME_NUMBER: Final = 1e-9


def model_answer(exercise: Exercise) -> Iterator[Remark]:
    """Yield a failure for each part in which the model answer does not get full marks."""
    answers = solve(exercise).answers
    fields = {part.id: f"parts[{i}]" for i, part in enumerate(exercise.parts)}
    too_long = [part for part, answer in answers.items() if _longest(answer) > LIMITS.characters]
    for part in too_long:
        yield failed(
            fields[part],
            say(
                "the right answer to {part} is too long: one entry has more than {most} "
                "characters; ask for less, such as the pose of an earlier frame",
                part=part,
                most=LIMITS.characters,
            ),
        )
    for unit in UNITS:
        reports = _graded(exercise, answers, unit)
        short = [report for report in reports.values() if report.points < report.max_points]
        for report in short:
            if report.part not in too_long:
                yield failed(
                    fields[report.part],
                    say(
                        "the model answer to {part} is not right with angles in {unit}: {result}",
                        part=report.part,
                        unit=unit,
                        result=_in_words(report),
                    ),
                )
        if short:
            return


def _longest(answer: object) -> float:
    match answer:
        case None:
            return math.inf
        case str():
            return len(answer)
        case dict():
            answer = list(answer.values())
    return max(map(_longest, answer), default=0) if isinstance(answer, list) else 0


def failed_checks(exercise: Exercise) -> Iterator[Remark]:
    """Yield a failure for each check (an answer with its expected result) that fails."""
    for i, check in enumerate(exercise.checks):
        reports = _graded(exercise, check.answers, check.angle_unit)
        for part, problem in _answers_problems(check, reports):
            yield failed(
                f"checks[{i}]",
                say("{check!r}: {part} {problem}", check=check.title, part=part, problem=problem),
            )


def missing_checks(exercise: Exercise) -> Iterator[Remark]:
    """Yield a warning if the file has too few checks (answers with their expected result)."""
    kinds = Counter[str](check.kind for check in exercise.checks)
    short = [kind for kind, wanted in WANTED.items() if kinds[kind] < wanted]
    if short:
        have = ", ".join(f"{kinds[kind]} {kind}" for kind in WANTED)
        wanted = ", ".join(f"{number} {kind}" for kind, number in WANTED.items())
        yield warning(
            "checks",
            say(
                "{have}; write {wanted} or more, so that later mistakes are detected",
                have=have,
                wanted=wanted,
            ),
        )


def _answers_problems(
    check: CheckSpec, reports: dict[str, PartReport]
) -> Iterator[tuple[str, str]]:
    for part, expected in check.expect.items():
        for problem in _differences(expected, reports[part]):
            result = _in_words(reports[part])
            yield part, say("{problem}; it got {result}", problem=problem, result=result)
    answered = [reports[part] for part in check.answers]
    full = [report for report in answered if report.verdict is Verdict.CORRECT]
    if check.kind == "wrong" and len(full) == len(answered):
        yield (
            full[0].part,
            say("should lose points, as its kind is 'wrong'; it got full marks"),
        )
    if check.kind != "wrong":
        for report in answered:
            if report.part not in check.expect and report not in full:
                result = _in_words(report)
                yield report.part, say("should get full marks; it got {result}", result=result)


def _differences(expected: ExpectSpec, report: PartReport) -> Iterator[str]:
    if expected.verdict is not None and expected.verdict != report.verdict:
        yield say("should be {verdict}", verdict=expected.verdict)
    if expected.points is not None and abs(expected.points - report.points) > _SAME_POINTS:
        yield say("should get {points} points", points=f"{expected.points:g}")
    codes = sorted({message.code for message, *_ in messages_of(report)})
    missing = [code for code in expected.codes or () if code not in codes]
    if missing:
        named = ", ".join(missing)
        yield (
            say(
                "should be told {missing}, but was told the codes {codes}",
                missing=named,
                codes=", ".join(codes),
            )
            if codes
            else say("should be told {missing}, but was told no code at all", missing=named)
        )
    if expected.follow_through not in (None, report.follow_through):
        yield (
            say("should count as following from the earlier answer")
            if expected.follow_through
            else say("should not count as following from the earlier answer")
        )


def duplicate_parts(exercise: Exercise) -> Iterator[Remark]:
    """Yield a warning for each group of parts with the same right answer."""
    pairs = list(combinations(exercise.parts, 2))
    if not any(_task(one) == _task(other) for one, other in pairs):
        return
    answers = solve(exercise).answers
    waiting = list(exercise.parts)
    while waiting:
        one, *others = waiting
        same = [
            other
            for other in others
            if _task(one) == _task(other) and _equal(one, other, answers, exercise)
        ]
        waiting = [other for other in others if other not in same]
        if same:
            yield warning(
                f"parts[{exercise.parts.index(same[0])}]",
                say_count(
                    "{names} has the same answer as {other}: students can copy it; ask for "
                    "something else, or keep only one part",
                    "{names} have the same answer as {other}: students can copy it; ask for "
                    "something else, or keep only one part",
                    count=len(same),
                    names=", ".join(part.id for part in same),
                    other=one.id,
                ),
            )


def _task(part: PartSpec) -> dict[str, object]:
    return part.model_dump(exclude={*PosePartSpec.model_fields, *part.answer_fields})


def _equal(one: PartSpec, other: PartSpec, answers: dict[str, object], exercise: Exercise) -> bool:
    if not one.compared_by_formulas:
        report = _graded(exercise, {other.id: answers[one.id]})[other.id]
        return report.verdict is Verdict.CORRECT
    values, formulas = trial_values(exercise.variables), exercise.formulas
    first, second = (grid_values(formulas[part.id], values, TRIALS) for part in (one, other))
    return first.shape == second.shape and bool(np.abs(first - second).max() < _SAME_NUMBER)


def _graded(
    exercise: Exercise, answers: Mapping[str, object], angle_unit: AngleUnit = "radians"
) -> dict[str, PartReport]:
    submission = Submission(answers, angle_unit, FeedbackLevel.FULL)
    return {part.part: part for part in grade(exercise, submission).parts}


def _in_words(report: PartReport) -> str:
    # Prefer a message on a single cell: it says more than one on the whole part.
    message = next((each.message for each, *_ in reversed([*messages_of(report)])), "")
    result = say(
        "{verdict}, {points} of {most} points",
        verdict=report.verdict.value,
        points=f"{round(report.points, 2):g}",
        most=f"{report.max_points:g}",
    )
    return joined(": ", [result, message]) if message else result


# --- All checks of an exercise for its author


EXAMINATIONS: tuple[Callable[[Exercise], Iterator[Remark]], ...] = (
    # First, because it is the cause of what the other checks find.
    bare_degrees,
    model_answer,
    unfit_slips,
    failed_checks,
    missing_checks,
    ambiguous_symbols,
    unused_symbols,
    badly_scaled,
    duplicate_parts,
    lost_freedom,
    lazy_answers,
)


def examine(exercise: Exercise) -> list[Remark]:
    """Return all remarks on an exercise: failures and warnings."""
    return [remark for examination in EXAMINATIONS for remark in examination(exercise)]


def failures(exercise: Exercise) -> list[str]:
    """Return the failures of an exercise, without warnings, as sentences."""
    return [
        joined(": ", [remark.field, remark.text]) if remark.field else remark.text
        for remark in examine(exercise)
        if remark.level is Level.FAILED
    ]
