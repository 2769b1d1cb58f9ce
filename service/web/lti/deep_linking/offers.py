"""Make links on the learning platform from what a tutor has chosen in a form (deep linking)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from typing import Any, Final
from zoneinfo import ZoneInfo

from pydantic import ValidationError
from sqlalchemy import Connection

from service.api.http.problems import message_of
from service.catalogue import Exercise
from service.contract.courses import MOST_EXERCISES, CourseAssignment, NewAssignment
from service.courses import roll
from service.courses.assignments import assignments_of
from service.courses.errors import CourseError
from service.courses.times import moment, zone_named
from service.lti.deep_linking.responses import NewLink
from service.lti.registrations import Registration
from service.lti.tickets import LinkingTicket
from service.translations import say

_LONGEST_LINE: Final = 200


class NotYetError(Exception):
    """No links can be made from the tutor's form yet; the message says why."""


@dataclass(frozen=True, slots=True)
class Offer:
    """What a tutor can choose from to make links: exercises, or the course's assignments.

    ``zone`` is the time zone of the dates that the tutor enters.
    """

    # ``assignments`` is empty if there is no course yet.

    ticket: LinkingTicket
    registration: Registration
    zone: ZoneInfo
    assignments: Sequence[CourseAssignment] = ()


@dataclass(frozen=True, slots=True)
class Picked:
    """The values that a tutor has entered in the form.

    ``points`` has the points of each chosen exercise. ``message`` is the error message to show.
    """

    title: str = ""
    search: str = ""
    points: Mapping[str, str] | None = None
    assignments: Sequence[str] = ()
    opens: str = ""
    due: str = ""
    is_one: bool = True
    variants: bool = False
    message: str = ""

    def with_message(self, message: str) -> "Picked":
        """Return a copy of the form's values with this error message."""
        return replace(self, message=message)


def offer_of(connection: Connection, ticket: LinkingTicket, known: Registration) -> Offer:
    """Return what the tutor with this ticket can choose from."""
    if not ticket.course:
        return Offer(ticket, known, zone_named(known.zone))
    try:
        course = roll.course(connection, ticket.course)
        found = assignments_of(connection, ticket.course)
    except CourseError:
        return Offer(ticket, known, zone_named(known.zone))
    return Offer(ticket, known, zone_named(course.zone), found)


def picked_in(fields: Mapping[str, list[str]]) -> Picked:
    """Return the values that a tutor has entered in the form."""

    def line(name: str) -> str:
        return " ".join(fields.get(name, [""])[0].split())[:_LONGEST_LINE]

    names = fields.get("exercise", [])[:MOST_EXERCISES]
    return Picked(
        title=line("title"),
        search=line("search"),
        points={name: line(f"points:{name}") for name in names},
        assignments=fields.get("assignment", [])[:MOST_EXERCISES],
        opens=line("opens"),
        due=line("due"),
        is_one=line("as") != "several",
        variants=line("variants") == "yes",
    )


def links_of(picked: Picked, offer: Offer, catalogue: Mapping[str, Exercise]) -> Sequence[NewLink]:
    """Return the links that a tutor has chosen in a form. Raises NotYetError."""
    known = {} if offer.ticket.notices_url else {each.id: each for each in offer.assignments}
    there = [known[name] for name in dict.fromkeys(picked.assignments) if name in known]
    links = [
        NewLink(each.title, {it.exercise: it.points for it in each.exercises}, each.id)
        for each in there
    ]
    if picked.points:
        links += _of_exercises(picked, offer, catalogue)
    if not links:
        raise NotYetError(say("Choose at least one exercise."))
    if len(links) > 1 and not offer.ticket.takes_several:
        raise NotYetError(say("Your platform accepts one link here: choose one."))
    return links


def _of_exercises(
    picked: Picked, offer: Offer, catalogue: Mapping[str, Exercise]
) -> Sequence[NewLink]:
    points = picked.points or {}
    if any(name not in catalogue for name in points):
        raise NotYetError(say("One of these exercises is not there any more."))
    if picked.is_one and not picked.title:
        raise NotYetError(say("Enter a title."))
    new = _checked(picked, list(points.items()))
    opens, due = _date(new.opens, offer.zone), _date(new.due, offer.zone)
    if opens and due and opens > due:
        raise NotYetError(
            say("The due date is before the date from which on attempts are accepted.")
        )
    given = {each.exercise: each.points for each in new.exercises}
    if picked.is_one:
        return [NewLink(new.title, given, opens=opens, due=due, variants=picked.variants)]
    return [
        NewLink(
            catalogue[name].title, {name: worth}, opens=opens, due=due, variants=picked.variants
        )
        for name, worth in given.items()
    ]


def _checked(picked: Picked, points: Sequence[tuple[str, str]]) -> NewAssignment:
    fields: dict[str, Any] = {"id": "new", "title": picked.title or "Exercises"}
    fields["exercises"] = [{"exercise": name, "points": worth} for name, worth in points]
    fields |= {name: value for name in ("opens", "due") if (value := getattr(picked, name))}
    try:
        return NewAssignment.model_validate(fields)
    except ValidationError as error:
        if {"opens", "due"} & {each["loc"][0] for each in error.errors()}:
            raise NotYetError(say("Write dates as 2026-11-30 23:59.")) from error
        raise NotYetError(say("Points are numbers above 0, at most 10000.")) from error


def _date(written: datetime | None, zone: ZoneInfo) -> datetime | None:
    if written is None:
        return None
    try:
        return moment(written, zone)
    except CourseError as error:
        raise NotYetError(message_of(error)) from error
