"""Read a class list in CSV, such as an export of Moodle or Canvas."""

import codecs
import csv
import io
from typing import Final

from pydantic import ValidationError

from service.contract.courses import MOST_LEARNERS, NewLearner
from service.courses.errors import CourseError
from service.formats.shared.plain_text import visible
from service.regex import regex
from service.translations import say

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
    """Return the learners of a class list with headings. Raises CourseError."""
    # Columns with unknown headings are ignored. The error names the line.
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
