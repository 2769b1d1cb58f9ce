"""Dates in the time zone of a course."""

from datetime import UTC, datetime, time
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

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
