"""Check an exercise file by grading: its model answers, its checks, and duplicate parts."""

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import combinations
from typing import Final

import numpy as np

from service.authoring.remarks import Remark, failed, warning
from service.catalogue import CheckSpec, Exercise, PartSpec, PosePartSpec, grid_values
from service.catalogue.files.schema import ExpectSpec
from service.catalogue.robots.variables import TRIALS, trial_values
from service.expressions import LIMITS, AngleUnit
from service.grading import FeedbackLevel, PartReport, Submission, Verdict, grade
from service.grading.report import messages_of
from service.solutions import solve
from service.translations import joined, say, say_count

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
        for part, problem in _problems(check, reports):
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


def _problems(check: CheckSpec, reports: dict[str, PartReport]) -> Iterator[tuple[str, str]]:
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
