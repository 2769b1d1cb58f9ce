"""What courses are made of: errors, dates, names, and class lists.

Nothing here reads a database or loads its driver; ``roll`` and ``assignments`` do.
"""

import codecs
import csv
import io
import unicodedata
from collections import Counter
from collections.abc import Sequence
from datetime import UTC, datetime, time
from typing import Any, Final, Literal
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

from pydantic import ValidationError

from dh_grader.contract.courses import (
    MOST_LEARNERS,
    CourseAssignment,
    CourseLearner,
    Extension,
    MissingLearner,
    NewLearner,
)
from dh_grader.formats.texts import visible
from dh_grader.regex import regex
from dh_grader.translations import say

# --- The errors of courses


CourseFault = Literal[
    "unknown-course",
    "unknown-assignment",
    "unknown-learner",
    "not-assigned",
    "already-there",
    "has-attempts",
    "unusable",
]


class CourseError(Exception):
    """A request about a course is refused; ``name`` is a code for programs."""

    def __init__(self, name: CourseFault, message: str) -> None:
        self.name = name
        super().__init__(message)


def unknown_course(course: str) -> CourseError:
    """Return the error for an unknown course id."""
    return CourseError("unknown-course", say("There is no course {course}.", course=course))


def unknown_learner(learner: str) -> CourseError:
    """Return the error for a learner who is not in the course."""
    message = say("The course has no learner {learner}.", learner=learner)
    return CourseError("unknown-learner", message)


def unknown_assignment(assignment: str) -> CourseError:
    """Return the error for an assignment that the course does not have."""
    message = say("The course has no assignment {assignment}.", assignment=assignment)
    return CourseError("unknown-assignment", message)


def links_need_a_secret() -> CourseError:
    """Return the error for a service without a secret to sign links."""
    message = say("Personal links need a secret: set DH_GRADER_SECRET.")
    return CourseError("unusable", message)


# --- Dates in the time zone of a course


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
    """Return the due date and the closing date of a learner with an extension.

    The closing date is the latest date of the assignment and of the extension; None if neither of
    them has a closing date.
    """
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


# --- The names of learners in lists for tutors, and their alphabetical order


def told_apart(people: Sequence[CourseLearner | MissingLearner]) -> dict[str, str]:
    """Return different names by id: equal names get the e-mail address or id added."""
    count = Counter(each.name for each in people)
    return {
        each.learner: each.name
        if count[each.name] == 1
        else f"{each.name} ({each.email or each.learner})"
        for each in people
    }


def place_of(learner: Any) -> tuple[str, str, str]:
    """Return the key for sorting learners: by family name, then name, then id.

    A learner without a family name is sorted by the name. Capitals and accents do not matter.
    """
    name = _plain(learner.name)
    return _plain(learner.family_name) if learner.family_name else name, name, learner.learner


def _plain(text: str) -> str:
    letters = unicodedata.normalize("NFKD", text.casefold())
    return "".join(each for each in letters if not unicodedata.combining(each))


# --- Read a class list in CSV, such as an export of Moodle or Canvas


# The headings of each field in small letters, the preferred one first, as English, German, Spanish,
# French and Chinese lists have them. Sources: Canvas, "How do I export grades in the Gradebook?";
# Moodle, "Grade export" and "Participants", and its language packs.
_HEADINGS: Final = {
    "learner": ("learner", "sis login id", "sis user id", "id number", "username", "identifier",
                "id", "id-nummer", "matrikelnummer", "anmeldename", "número de id",
                "nombre de usuario", "numéro d'identification", "nom d'utilisateur", "学号",
                "编号", "用户名"),
    "name": ("name", "full name", "student", "student name", "vollständiger name",
             "nombre completo", "nombre", "nom complet", "nom", "姓名", "全名"),
    "email": ("email", "e-mail", "email address", "e-mail address", "e-mail-adresse", "mail",
              "correo", "correo electrónico", "dirección de correo", "dirección email",
              "dirección de correo electrónico", "courriel", "adresse de courriel",
              "adresse e-mail", "电子邮件", "电子邮件地址", "电子邮箱", "邮箱", "email地址"),
    "first": ("first name", "vorname", "nombre", "nombre(s)", "prénom", "名", "名字"),
    "last": ("last name", "surname", "nachname", "apellido(s)", "apellidos", "apellido",
             "nom de famille", "nom", "name", "姓", "姓氏"),
}  # fmt: skip
# Lines of Canvas that are no learners: one below the headings, and the view of a student.
_NO_LEARNERS: Final = ("points possible", "student, test")
# Chinese names have the family name first, and no space.
_HAN: Final = regex(r"[\u3400-\u9fff]")


def decoded(data: bytes) -> str:
    """Return the text of a file in UTF-8, UTF-16 or Windows-1252. Raises CourseError."""
    # Excel on Windows writes Windows-1252.
    try:
        if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            return data.decode("utf-16")
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        pass
    try:
        return data.decode("cp1252")
    except UnicodeDecodeError as error:
        raise CourseError("unusable", say("The class list is not in UTF-8: save it so.")) from error


def read_class_list(text: str) -> list[NewLearner]:
    """Return the learners of a class list; ignore columns with unknown headings.

    Raises CourseError, which names the line.
    """
    text = text.removeprefix("\ufeff")
    head, _, _ = text.lstrip("\r\n").partition("\n")
    delimiter = max(",;\t", key=head.count)
    try:
        rows = list(csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=False))
    except csv.Error as error:
        raise CourseError(
            "unusable", say("The class list is not CSV: {reason}.", reason=str(error))
        ) from error
    numbered = [(i, row) for i, row in enumerate(rows, 1) if any(cell.strip() for cell in row)]
    if not numbered:
        raise CourseError("unusable", say("The class list is empty."))
    columns = _columns(numbered[0][1])
    if len(numbered) > MOST_LEARNERS + 2:
        raise CourseError(
            "unusable", say("The class list has more than {most} learners.", most=MOST_LEARNERS)
        )
    found = []
    for line, row in numbered[1:]:
        cells = {
            field: row[column].strip() for field, column in columns.items() if column < len(row)
        }
        # Canvas also writes a line that says of some columns who sees them, and no name.
        if any(cells.values()) and cells.get("name", "").lower() not in _NO_LEARNERS:
            found.append(_learner(cells, line))
    return found


def _columns(head: list[str]) -> dict[str, int]:
    headings = [cell.strip().lower().replace("’", "'") for cell in head]
    columns = {
        field: headings.index(next(name for name in names if name in headings))
        for field, names in _HEADINGS.items()
        if set(names) & set(headings)
    }
    if {"first", "last"} <= columns.keys():
        # "Name" beside "Vorname", or "Nombre" beside "Apellidos", is only one half of it.
        columns.pop("name", None)
    has_name = "name" in columns or "last" in columns
    if not has_name or columns.keys().isdisjoint({"learner", "email"}):
        raise CourseError(
            "unusable",
            say("The first line of a class list has the headings: name, and email or id."),
        )
    return columns


def _learner(cells: dict[str, str], line: int) -> NewLearner:
    first, last = cells.get("first", ""), cells.get("last", "")
    name = cells.get("name") or (f"{last}{first}" if _HAN.match(last) else f"{first} {last}")
    # A name such as "Lovelace, Ada" begins with the family name.
    family = " ".join(last.split()) if first and not cells.get("name") else ""
    learner, email = cells.get("learner") or None, cells.get("email") or None
    if learner is None and email is None:
        raise CourseError(
            "unusable", say("Line {line} of the class list has no id and no e-mail.", line=line)
        )
    try:
        return NewLearner(
            learner=learner,
            name=visible(" ".join(name.split())),
            family_name=visible(family) or None,
            email=email,
        )
    except ValidationError as error:
        field = error.errors()[0]["loc"][0]
        message = say(
            "Line {line} of the class list has no usable {field}.", line=line, field=str(field)
        )
        raise CourseError("unusable", message) from error
