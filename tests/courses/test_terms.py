"""Test the terms of assignments, and their times."""

from collections.abc import Mapping
from dataclasses import replace
from datetime import UTC, date, datetime, timedelta
from functools import partial
from types import SimpleNamespace
from typing import Any
from zoneinfo import ZoneInfo

import pytest
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.contract.courses import AssignmentChange, CourseAssignment, Extension
from dh_grader.courses import CourseError, moment, with_own_dates, zone_named
from dh_grader.courses.assignments import LearnerTerms, extend, extended, terms_of
from dh_grader.store import AttemptRefusedError, ruling
from dh_grader.store.tables import assignments
from dh_grader.submissions.bodies import field_error
from pydantic import ValidationError
from sqlalchemy import select, update

from tests.courses.conftest import Class
from tests.together import together

# --- Test what an assignment allows a learner at a moment: attempts, practice and the solution

BERLIN = ZoneInfo("Europe/Berlin")


def at(text: str | None, zone: str = "Europe/Berlin") -> datetime | None:
    return None if text is None else datetime.fromisoformat(text).replace(tzinfo=ZoneInfo(zone))


DUE, CLOSES = "2026-10-25T23:59", "2026-10-28T23:59"
TICK = timedelta(microseconds=1)


def judged(now: datetime, closes: str | None, own: dict[str, str]) -> str:
    row: Any = SimpleNamespace(
        opens=at("2026-10-20T08:00"), due=at(DUE), closes=at(closes), max_attempts=3,
        late_worth=0.5, hint_prices=None,
    )  # fmt: skip
    rules = extended(row, BERLIN, at(own.get("due")), at(own.get("closes")))
    try:
        return "late" if ruling(rules, 0, now).is_late else "on time"
    except AttemptRefusedError as error:
        return error.name


@pytest.mark.parametrize(
    ("when", "zone", "later", "closes", "own", "expected"),
    [
        ("2026-10-20T07:59:59", "Europe/Berlin", 0, CLOSES, {}, "not-open"),
        ("2026-10-20T08:00", "Europe/Berlin", 0, CLOSES, {}, "on time"),
        # At the very second, and a microsecond later.
        (DUE, "Europe/Berlin", 0, CLOSES, {}, "on time"),
        (DUE, "Europe/Berlin", 1, CLOSES, {}, "late"),
        (DUE, "Europe/Berlin", 1, None, {}, "closed"),
        (CLOSES, "Europe/Berlin", 0, CLOSES, {}, "late"),
        (CLOSES, "Europe/Berlin", 1, CLOSES, {}, "closed"),
        # The clocks of Berlin were put back on this day: New York is five hours behind, then six.
        ("2026-10-25T18:59", "America/New_York", 0, CLOSES, {}, "on time"),
        ("2026-10-25T19:00", "America/New_York", 0, CLOSES, {}, "late"),
        # The hour that the clocks show twice: its first pass is before the second one.
        ("2026-10-25T00:30", "UTC", 0, CLOSES, {"due": "2026-10-25T02:30"}, "on time"),
        # A learner in Tokyo has the same moment eight hours later on the clock.
        ("2026-10-26T07:59", "Asia/Tokyo", 0, CLOSES, {}, "on time"),
        ("2026-10-26T07:59", "Asia/Tokyo", 1, CLOSES, {}, "late"),
        # An extension with an earlier due date than the class's is the learner's own.
        ("2026-10-24T12:00", "Europe/Berlin", 1, CLOSES, {"due": "2026-10-24T12:00"}, "late"),
        # Dates of an extension hold to the very second, too.
        ("2026-10-26T23:59", "Europe/Berlin", 0, None, {"due": "2026-10-26T23:59"}, "on time"),
        ("2026-10-26T23:59", "Europe/Berlin", 1, None, {"due": "2026-10-26T23:59"}, "closed"),
        # An extension to the next day: on time, even though the assignment is closed to others.
        ("2026-10-26T12:00", "Europe/Berlin", 0, None, {"due": "2026-10-26T23:59"}, "on time"),
        ("2026-10-27T00:00", "Europe/Berlin", 0, None, {"due": "2026-10-26T23:59"}, "closed"),
        ("2026-10-27T00:00", "Europe/Berlin", 0, CLOSES, {"due": "2026-10-26T23:59"}, "late"),
        # An extension beyond the closing date of the others.
        ("2026-11-02T10:00", "Europe/Berlin", 0, CLOSES, {"due": "2026-11-02T12:00"}, "on time"),
        ("2026-11-02T12:01", "Europe/Berlin", 0, CLOSES, {"due": "2026-11-02T12:00"}, "closed"),
        ("2026-10-30T12:00", "Europe/Berlin", 0, CLOSES, {"closes": "2026-10-31T12:00"}, "late"),
    ],
)
def test_an_attempt_is_on_time_late_or_refused(
    when: str, zone: str, later: int, closes: str | None, own: dict[str, str], expected: str
) -> None:
    now = at(when, zone)
    assert now is not None
    assert judged(now.astimezone(ZoneInfo("UTC")) + later * TICK, closes, own) == expected


OPENS = "2026-10-20T08:00"
LATER = "2026-10-30T12:00"


@together(
    ("of_assignment", "own", "expected"),
    [
        # Each pair is a due date and a closing date.
        ((DUE, CLOSES), (None, None), (DUE, CLOSES)),
        ((DUE, None), (LATER, None), (LATER, None)),
        ((DUE, CLOSES), (LATER, None), (LATER, LATER)),
        ((DUE, None), (None, CLOSES), (DUE, CLOSES)),
        ((None, None), (DUE, CLOSES), (DUE, CLOSES)),
        # Without a due date, all attempts are on time: no closing date holds.
        ((None, None), (None, CLOSES), (None, None)),
        ((None, None), (None, None), (None, None)),
    ],
)
def test_an_extension_shows_the_dates_that_hold(
    of_assignment: tuple[str | None, ...],
    own: tuple[str | None, ...],
    expected: tuple[str | None, ...],
) -> None:
    due, closes = map(at, of_assignment)
    assignment = CourseAssignment(
        id="homework", title="Homework", exercises=[], due=due, closes=closes, late_worth=0.5,
        practice="open", solution="never", variants=False, extensions=[],
    )  # fmt: skip
    due, closes = map(at, own)
    given = Extension.model_construct(learner="ada", due=due, closes=closes, limit=2)
    told = with_own_dates(assignment, given)
    assert (told.due, told.closes) == tuple(map(at, expected))
    assert (told.learner, told.limit) == ("ada", 2)


@pytest.mark.parametrize("has_variants", [False, True])
def test_terms_have_the_variants_and_the_extension(class_: Class, has_variants: bool) -> None:
    class_.assign(variants=has_variants)
    class_.do(lambda it: extend(it, "robots", "homework", Extension(learner="ada", limit=2)))
    class_.do(lambda it: it.execute(update(assignments).values(choices="{}")))
    ada, grace = (
        class_.do(partial(terms_of, course="robots", assignment="homework", learner=each))
        for each in ("ada", "grace")
    )
    assert (ada.is_extended, grace.is_extended) == (True, False)
    assert (ada.rules.limit, grace.rules.limit) == (2, None)
    assert ada.variants == class_.do(lambda it: it.scalar(select(assignments.c.variants)))
    assert (ada.variants is not None, ada.choices) == (has_variants, "{}")


def terms(
    dates: str, practice: Any = "open", solution: Any = "never", levels: str = ""
) -> LearnerTerms:
    """Return terms with the dates in ``dates``: some of opens, due and closes."""
    known = {"opens": OPENS, "due": DUE, "closes": CLOSES}
    rules = AttemptsSpec.model_validate({name: at(known[name]) for name in dates.split()})
    feedback = tuple(map(FeedbackLevel, levels.split())) or None
    return LearnerTerms(
        1, "homework", "Homework", BERLIN, {"scara": 10.0}, rules, feedback, practice, solution,
        is_extended=False,
    )  # fmt: skip


def around(date: str) -> tuple[datetime, datetime, datetime]:
    """Return the moment before a date, the date, and the moment after it."""
    moment = at(date)
    assert moment is not None
    return moment - TICK, moment, moment + TICK


@together(
    ("dates", "date", "expected"),
    [
        ("opens due closes", OPENS, "not_open open open"),
        ("opens due closes", DUE, "open open late"),
        ("opens due closes", CLOSES, "late late closed"),
        # If no closing date is given, the due date closes the assignment.
        ("opens due", DUE, "open open closed"),
        ("due", OPENS, "open open open"),
        ("", DUE, "open open open"),
    ],
)
def test_an_assignment_is_open_late_or_closed(dates: str, date: str, expected: str) -> None:
    assert [terms(dates).state(moment) for moment in around(date)] == expected.split()


@together(
    ("solution", "dates", "date", "is_full", "expected"),
    [
        # Others may still hand in between the due date and the closing date.
        ("after_due", "due closes", DUE, False, "no no no"),
        ("after_due", "due closes", DUE, True, "no no no"),
        ("after_due", "due closes", CLOSES, False, "no no yes"),
        ("after_due", "due", DUE, False, "no no yes"),
        ("after_due", "", DUE, True, "no no no"),
        ("after_full", "due closes", OPENS, True, "yes yes yes"),
        ("after_full", "due closes", CLOSES, False, "no no no"),
        ("never", "due closes", CLOSES, True, "no no no"),
    ],
)
def test_the_solution_is_shown_after_the_end_or_for_full_marks(
    solution: str, dates: str, date: str, is_full: bool, expected: str
) -> None:
    shown = [
        terms(dates, solution=solution).shows_solution(moment, is_full=is_full)
        for moment in around(date)
    ]
    assert ["yes" if each else "no" for each in shown] == expected.split()


@together(
    ("practice", "dates", "is_full", "expected"),
    [
        ("open", "due closes", False, "yes yes yes"),
        ("none", "due closes", True, "no no no"),
        ("after", "due closes", False, "no no yes"),
        ("after", "due closes", True, "yes yes yes"),
        ("after", "opens", False, "no no no"),
    ],
)
def test_practice_is_open_always_never_or_after_the_due_date(
    practice: str, dates: str, is_full: bool, expected: str
) -> None:
    found = [terms(dates, practice).may_practise(each, is_full=is_full) for each in around(DUE)]
    assert ["yes" if each else "no" for each in found] == expected.split()


@together(
    ("of_assignment", "of_exercise", "expected"),
    [
        # One level for each of four attempts; the last level is for all later attempts.
        ("score verdicts", "hints", "score verdicts verdicts verdicts"),
        ("full", "full", "full full full full"),
        # Never more than the exercise allows in any attempt.
        ("full", "verdicts", "verdicts verdicts verdicts verdicts"),
        ("full hints", "score verdicts", "verdicts verdicts verdicts verdicts"),
        ("score full", "score hints", "score hints hints hints"),
        # Without levels of its own, the assignment has those of the exercise.
        ("", "score verdicts hints", "score verdicts hints hints"),
    ],
)
def test_a_report_never_tells_more_than_the_exercise_allows(
    catalogue: Mapping[str, Exercise], of_assignment: str, of_exercise: str, expected: str
) -> None:
    levels = tuple(map(FeedbackLevel, of_exercise.split()))
    exercise = replace(catalogue["scara"], feedback_by_attempt=levels)
    found = [terms("", levels=of_assignment).feedback_at(exercise, n) for n in (1, 2, 3, 4)]
    assert found == expected.split()


def test_the_prices_of_hints_are_the_assignment_s_or_the_exercise_s(
    catalogue: Mapping[str, Exercise],
) -> None:
    exercise = replace(catalogue["scara"], attempts=AttemptsSpec(hint_prices=[0.1, 0.2, 0.3]))
    free = terms("")
    assert free.hint_prices(exercise) == [0.1, 0.2, 0.3]
    priced = replace(free, rules=AttemptsSpec(hint_prices=[0.3, 0.4, 0.5]))
    assert priced.hint_prices(exercise) == [0.3, 0.4, 0.5]


# --- Compare dates in a course's time zone with dates written by hand


@pytest.mark.parametrize(
    ("zone", "written", "utc"),
    [
        ("Europe/Berlin", "2026-01-15T23:59", "2026-01-15T22:59"),
        ("Europe/Berlin", "2026-07-15T23:59", "2026-07-15T21:59"),
        # The last second before the clocks are put forward, and the first one after.
        ("Europe/Berlin", "2026-03-29T01:59:59", "2026-03-29T00:59:59"),
        ("Europe/Berlin", "2026-03-29T03:00", "2026-03-29T01:00"),
        # The clocks show 02:30 twice: the second one counts.
        ("Europe/Berlin", "2026-10-25T02:30", "2026-10-25T01:30"),
        ("Europe/Berlin", "2026-10-25T03:00", "2026-10-25T02:00"),
        ("America/New_York", "2026-11-01T01:30", "2026-11-01T06:30"),
        # The last second that is shown twice, and the last one before it that is shown once.
        ("Europe/Berlin", "2026-10-25T02:59:59", "2026-10-25T01:59:59"),
        ("Europe/Berlin", "2026-10-25T01:59:59", "2026-10-24T23:59:59"),
        # The clocks of Lord Howe Island are put back by half an hour.
        ("Australia/Lord_Howe", "2026-04-05T01:45", "2026-04-04T15:15"),
        ("Asia/Kolkata", "2026-06-01T12:00", "2026-06-01T06:30"),
        ("Pacific/Auckland", "2026-01-01T00:00", "2025-12-31T11:00"),
        # In Cairo, no clock showed midnight: the day began at 01:00, which was 22:00 in UTC.
        ("Africa/Cairo", "2026-04-24T00:00", "2026-04-23T22:00"),
        # With a zone of its own, the zone of the course does not matter.
        ("Asia/Kolkata", "2026-06-01T12:00+02:00", "2026-06-01T10:00"),
        ("Asia/Kolkata", "2026-06-01T12:00Z", "2026-06-01T12:00"),
    ],
)
def test_a_date_is_a_time_on_the_clocks_of_the_course(zone: str, written: str, utc: str) -> None:
    expected = datetime.fromisoformat(utc).replace(tzinfo=UTC)
    assert moment(datetime.fromisoformat(written), ZoneInfo(zone)) == expected


def test_a_time_that_the_clocks_never_show_is_refused() -> None:
    with pytest.raises(CourseError, match="never show 2026-03-29 02:30"):
        moment(datetime(2026, 3, 29, 2, 30), ZoneInfo("Europe/Berlin"))  # noqa: DTZ001


@pytest.mark.parametrize("name", ["Europe/Nowhere", "", "../etc/passwd", "/etc/localtime", "a\0b"])
def test_an_unknown_zone_is_refused(name: str) -> None:
    with pytest.raises(CourseError):
        zone_named(name)


@together(
    ("written", "opens", "due"),
    [
        ("2026-12-01", "2026-12-01T00:00:00", "2026-12-01T23:59:59"),
        ("2028-02-29", "2028-02-29T00:00:00", "2028-02-29T23:59:59"),
        (date(2026, 12, 1), "2026-12-01T00:00:00", "2026-12-01T23:59:59"),
        *((written, written, written) for written in ("2026-12-01 08:00", "2026-12-01T08:00:30")),
        ("2026-12-01t08:00z", "2026-12-01T08:00+00:00", "2026-12-01T08:00+00:00"),
    ],
)
def test_a_date_without_a_time_is_a_whole_day(written: object, opens: str, due: str) -> None:
    given = {"opens": written, "due": written, "closes": written}
    change = AssignmentChange.model_validate(given)
    assert change.opens == datetime.fromisoformat(opens)
    assert change.due == change.closes == datetime.fromisoformat(due)
    extension = Extension.model_validate({"learner": "ada", "due": written, "closes": written})
    assert extension.due == extension.closes == datetime.fromisoformat(due)


@together(
    "written",
    [
        "2026-02-30", "20261201", "2026-12", "2026-W49-2", "01.12.2026", "12/01/2026", "1.12.",
        "2026-12-1", "2026-12-01 8:00", "2026-12-01 08", "20261201T0800",
        "tomorrow", "none", "", "1796083200", 1796083200, 1.5, True, [2026, 12, 1],
    ],
)  # fmt: skip
def test_any_other_date_is_refused_with_the_right_forms(written: object) -> None:
    for field in ("opens", "due", "closes"):
        with pytest.raises(ValidationError) as refused:
            AssignmentChange.model_validate({field: written})
        [error] = refused.value.errors()
        assert "2026-12-01, or a date with a time: 2026-12-01 23:59" in field_error(error)
