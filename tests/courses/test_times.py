"""Compare dates in a course's time zone with dates written by hand."""

from datetime import UTC, date, datetime
from zoneinfo import ZoneInfo

import pytest
from dh_grader.contract.courses import AssignmentChange, Extension
from dh_grader.courses import CourseError, moment, zone_named
from dh_grader.submissions.bodies import field_error
from pydantic import ValidationError

from tests.together import together


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
