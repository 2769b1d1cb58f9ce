"""Compare dates in a course's time zone with dates written by hand."""

from datetime import UTC, datetime
from zoneinfo import ZoneInfo

import pytest

from service.courses.errors import CourseError
from service.courses.times import moment, zone_named


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
