"""The gradebook as a workbook (Office Open XML)."""

# No text in the workbook becomes a formula.

import io
from collections.abc import Mapping
from datetime import datetime
from typing import Any, Final, NamedTuple
from zoneinfo import ZoneInfo

from sqlalchemy import Connection, func, select, true

from service.attempts.storage.tables import assignments, attempts
from service.contract.courses import Gradebook
from service.courses import roll
from service.courses.results.gradebook import COUNTS, GradebookPlace, gradebook
from service.formats.shared.plain_text import visible

_PEOPLE: Final = ("learner", "name", "email")
_WIDTHS: Final = (14, 28, 30)


class HandIns(NamedTuple):
    """The number of a learner's counted attempts at an exercise, and the time of the last one."""

    number: int
    last: datetime


def gradebook_workbook(connection: Connection, course: str, assignment: str | None = None) -> bytes:
    """Return the gradebook of a course as a workbook. Raises CourseError.

    The first sheet has the points; the second has the numbers and times of attempts.
    """
    zone = ZoneInfo(roll.course(connection, course).zone)
    book = gradebook(connection, course, assignment)
    return _written(book, _hand_ins(connection, course, assignment), zone)


def _hand_ins(
    connection: Connection, course: str, assignment: str | None
) -> Mapping[GradebookPlace, HandIns]:
    of = attempts.c
    place = (of.learner, assignments.c.id, of.exercise)
    chosen = true() if assignment is None else assignments.c.id == assignment
    rows = connection.execute(
        select(*place, func.count(), func.max(of.at))
        .join_from(attempts, assignments)
        .where(assignments.c.course == course, chosen, of.assignment.is_not(None), COUNTS)
        .group_by(*place)
    )
    return {(learner, name, exercise): HandIns(*found) for learner, name, exercise, *found in rows}


def _written(book: Gradebook, hand_ins: Mapping[GradebookPlace, HandIns], zone: ZoneInfo) -> bytes:
    # Imported here, because only this format needs it.
    from xlsxwriter import Workbook

    written = io.BytesIO()
    with Workbook(written, {"in_memory": True, "remove_timezone": True}) as file:
        bold = file.add_format({"bold": True})
        date = file.add_format({"num_format": "yyyy-mm-dd hh:mm"})
        titles = [f"{each.assignment} {each.exercise}" for each in book.columns]
        points = file.add_worksheet("Points")
        _head(points, [*titles, "total"], bold)
        counts = file.add_worksheet("Hand-ins")
        both = (f"{title}{what}" for title in titles for what in ("", ", last hand-in"))
        _head(counts, list(both), bold)
        for i, row in enumerate(book.rows, start=1):
            for sheet in (points, counts):
                for j, text in enumerate((row.learner, row.name, row.email)):
                    if text:
                        # Another method would make formulas and links of some texts.
                        sheet.write_string(i, j, visible(text))
            for j, value in enumerate((*row.points, row.total), start=len(_PEOPLE)):
                if value is not None:
                    points.write_number(i, j, value)
            for j, each in enumerate(book.columns):
                found = hand_ins.get((row.learner, each.assignment, each.exercise))
                if found is not None:
                    place = len(_PEOPLE) + 2 * j
                    counts.write_number(i, place, found.number)
                    counts.write_datetime(i, place + 1, found.last.astimezone(zone), date)
    return written.getvalue()


def _head(sheet: Any, titles: list[str], bold: Any) -> None:
    for i, title in enumerate((*_PEOPLE, *titles)):
        sheet.write_string(0, i, visible(title), bold)
        sheet.set_column(i, i, _WIDTHS[i] if i < len(_WIDTHS) else max(12, len(title)))
    sheet.freeze_panes(1, len(_PEOPLE))
