"""Dates in the time zone of a course."""

from datetime import UTC, datetime, time
from typing import Any
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

from service.contract.courses import CourseAssignment, Extension
from service.courses.errors import CourseError
from service.translations import say


def zone_named(name: str) -> ZoneInfo:
    """Return the time zone with this IANA name. Raises CourseError."""
    try:
        return ZoneInfo(name)
    except (ZoneInfoNotFoundError, ValueError, OSError) as error:
        message = say("There is no time zone {name}. Write one such as Europe/Berlin.", name=name)
        raise CourseError("unusable", message) from error


def moment(written: datetime, zone: ZoneInfo) -> datetime:
    """Return a date in UTC; a date without a zone is in ``zone``. Raises CourseError."""
    # If the clocks show a time twice, the second moment is meant. A time that the clocks never
    # show, because they are put forward, is an error. Without midnight, the day starts later.
    try:
        if written.tzinfo is not None:
            return written.astimezone(UTC)
        first, second = (written.replace(tzinfo=zone, fold=fold) for fold in (0, 1))
        if first.astimezone(UTC).astimezone(zone).replace(tzinfo=None) != written:
            if written.time() == time.min:
                return first.astimezone(UTC)
            raise CourseError(
                "unusable",
                say(
                    "The clocks of {zone} never show {time}: they are put forward.",
                    zone=str(zone),
                    time=str(written),
                ),
            )
        return second.astimezone(UTC)
    except OverflowError as error:
        raise CourseError(
            "unusable", say("{date} is no usable date.", date=str(written))
        ) from error


def local(when: datetime | None, zone: ZoneInfo) -> datetime | None:
    """Return a moment as the local time in a zone."""
    return None if when is None else when.astimezone(zone)


def own_dates(
    assignment: Any, due: datetime | None, closes: datetime | None
) -> tuple[datetime | None, datetime | None]:
    """Return the due date and the closing date of a learner with an extension."""
    # The closing date is the latest date of the assignment and of the extension; None if neither of
    # them has a closing date.
    new_due = due or assignment.due
    if new_due is not None and assignment.opens is not None:
        new_due = max(new_due, assignment.opens)
    ends = [each for each in (assignment.closes, closes, new_due) if each is not None]
    if new_due is None or not (assignment.closes or closes):
        return new_due, None
    return new_due, max(ends)


def with_own_dates(assignment: CourseAssignment, extension: Extension) -> Extension:
    """Return the extension with the dates that hold for its learner, also those not extended."""
    due, closes = own_dates(assignment, extension.due, extension.closes)
    return extension.model_copy(update={"due": due, "closes": closes})
