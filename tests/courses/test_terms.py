"""Test when an attempt is on time, late or refused."""

from datetime import datetime, timedelta
from types import SimpleNamespace
from typing import Any
from zoneinfo import ZoneInfo

import pytest

from service.attempts.policy import AttemptRefusedError, ruling
from service.courses.terms import extended

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
