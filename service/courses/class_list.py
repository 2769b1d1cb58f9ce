"""Read a class list: CSV as Moodle or Canvas export it, or as a tutor writes it."""

import csv
import io
from typing import Final

from pydantic import ValidationError

from service.contract.courses import MOST_LEARNERS, NewLearner
from service.courses.errors import CourseError
from service.formats.shared.plain_text import visible

# The headings of each field in small letters, the preferred one first. Sources: Canvas, "How do I
# export grades in the Gradebook?"; Moodle, "Grade export" and "Participants".
_HEADINGS: Final = {
    "learner": ("learner", "sis login id", "sis user id", "id number", "username", "identifier",
                "id"),
    "name": ("name", "full name", "student", "student name"),
    "email": ("email", "e-mail", "email address", "e-mail address"),
    "first": ("first name",),
    "last": ("last name", "surname"),
}  # fmt: skip
# Canvas writes this below the headings.
_POINTS: Final = "points possible"


def read_class_list(text: str) -> list[NewLearner]:
    """Return the learners of a class list. Raises CourseError, which names the line.

    The first line has the headings. Columns with other headings are ignored.
    """
    text = text.removeprefix("\ufeff")
    head, _, _ = text.lstrip("\r\n").partition("\n")
    delimiter = max(",;\t", key=head.count)
    try:
        rows = list(csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=False))
    except csv.Error as error:
        raise CourseError("unusable", f"The class list is not CSV: {error}.") from error
    numbered = [(i, row) for i, row in enumerate(rows, 1) if any(cell.strip() for cell in row)]
    if not numbered:
        raise CourseError("unusable", "The class list is empty.")
    columns = _columns(numbered[0][1])
    if len(numbered) > MOST_LEARNERS + 2:
        raise CourseError("unusable", f"The class list has more than {MOST_LEARNERS} learners.")
    found = []
    for line, row in numbered[1:]:
        cells = {
            field: row[column].strip() for field, column in columns.items() if column < len(row)
        }
        if cells.get("name", "").lower() != _POINTS:
            found.append(_learner(cells, line))
    return found


def _columns(head: list[str]) -> dict[str, int]:
    headings = [cell.strip().lower() for cell in head]
    columns = {
        field: headings.index(next(name for name in names if name in headings))
        for field, names in _HEADINGS.items()
        if set(names) & set(headings)
    }
    has_name = "name" in columns or "last" in columns
    if not has_name or columns.keys().isdisjoint({"learner", "email"}):
        raise CourseError(
            "unusable",
            "The first line of a class list has the headings: name, and email or id.",
        )
    return columns


def _learner(cells: dict[str, str], line: int) -> NewLearner:
    name = cells.get("name") or f"{cells.get('first', '')} {cells.get('last', '')}"
    learner, email = cells.get("learner") or None, cells.get("email") or None
    if learner is None and email is None:
        raise CourseError("unusable", f"Line {line} of the class list has no id and no e-mail.")
    try:
        return NewLearner(learner=learner, name=visible(" ".join(name.split())), email=email)
    except ValidationError as error:
        field = error.errors()[0]["loc"][0]
        message = f"Line {line} of the class list has no usable {field}."
        raise CourseError("unusable", message) from error
