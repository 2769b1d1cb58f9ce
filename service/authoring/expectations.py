"""The checks that the file carries: each answer graded, and held against its expectation."""

from collections import Counter
from collections.abc import Iterator
from typing import Final

from service.authoring.grading import graded, in_words
from service.authoring.remarks import Remark, failed, warning
from service.catalogue import CheckSpec, Exercise
from service.catalogue.schema import ExpectSpec
from service.grading import PartReport, Verdict
from service.grading.report import messages_of

# So many checks of each kind make a mistake in the exercise unlikely.
WANTED: Final = {"right": 1, "equivalent": 1, "wrong": 2}
# Points are rounded to six digits.
_SAME: Final = 1e-5


def failed_checks(exercise: Exercise) -> Iterator[Remark]:
    """Checks whose answer does not get the result that the file expects."""
    for i, check in enumerate(exercise.checks):
        reports = graded(exercise, check.answers, check.angle_unit)
        for part, problem in _problems(check, reports):
            yield failed(f"checks[{i}]", f"{check.title!r}: {part} {problem}")


def missing_checks(exercise: Exercise) -> Iterator[Remark]:
    """A warning where the file has too few checks of a kind."""
    kinds = Counter[str](check.kind for check in exercise.checks)
    short = [kind for kind, wanted in WANTED.items() if kinds[kind] < wanted]
    if short:
        have = ", ".join(f"{kinds[kind]} {kind}" for kind in WANTED)
        wanted = ", ".join(f"{number} {kind}" for kind, number in WANTED.items())
        yield warning(
            "checks",
            f"{have}; write {wanted} or more, so that no later change goes wrong unseen",
        )


def _problems(check: CheckSpec, reports: dict[str, PartReport]) -> Iterator[tuple[str, str]]:
    for part, expected in check.expect.items():
        report = reports[part]
        for problem in _differences(expected, report):
            yield part, f"{problem}; it got {in_words(report)}"
    answered = [reports[part] for part in check.answers]
    full = [report for report in answered if report.verdict is Verdict.CORRECT]
    if check.kind == "wrong" and len(full) == len(answered):
        yield full[0].part, "should lose points, for it is of kind 'wrong'; it got full marks"
    if check.kind != "wrong":
        for report in answered:
            if report.part not in check.expect and report not in full:
                yield report.part, f"should get full marks; it got {in_words(report)}"


def _differences(expected: ExpectSpec, report: PartReport) -> Iterator[str]:
    if expected.verdict is not None and expected.verdict != report.verdict:
        yield f"should be {expected.verdict}"
    if expected.points is not None and abs(expected.points - report.points) > _SAME:
        yield f"should get {expected.points:g} points"
    codes = sorted({message.code for message, _ in messages_of(report)})
    missing = [code for code in expected.codes or () if code not in codes]
    if missing:
        had = f"the codes {', '.join(codes)}" if codes else "no code at all"
        yield f"should be told {', '.join(missing)}, but was told {had}"
    if expected.follow_through not in (None, report.follow_through):
        what = "count" if expected.follow_through else "not count"
        yield f"should {what} as following from the earlier answer"
