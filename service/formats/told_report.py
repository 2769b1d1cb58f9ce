"""Reports in the language of their reader."""

from collections.abc import Callable
from dataclasses import replace

from service.grading import CellReport, Correction, Feedback, PartReport, Report, RowReport
from service.translations import Language, told

# Returns a text of a report, changed.
ChangedText = Callable[[str], str]


def report_in(report: Report, language: Language) -> Report:
    """Return the report with its sentences in a language."""
    translation = language.translation
    if translation is None:
        return report
    return with_texts(report, lambda text: told(text, translation))


def with_texts(report: Report, changed: ChangedText) -> Report:
    """Return a copy of the report, with each sentence replaced by ``changed(sentence)``."""
    # Sentences are messages, corrections in words, and the reasons of lost points.
    return replace(report, parts=tuple(_part(part, changed) for part in report.parts))


def _part(part: PartReport, changed: ChangedText) -> PartReport:
    worth = part.little_worth
    return replace(
        part,
        rows=tuple(_row(row, changed) for row in part.rows),
        feedback=_messages(part.feedback, changed),
        lost=tuple(replace(each, message=changed(each.message)) for each in part.lost),
        little_worth=worth and replace(worth, message=changed(worth.message)),
    )


def _row(row: RowReport, changed: ChangedText) -> RowReport:
    if not row.feedback and not any(cell.feedback for cell in row.cells):
        return row
    cells = tuple(_cell(cell, changed) if cell.feedback else cell for cell in row.cells)
    return replace(row, cells=cells, feedback=_messages(row.feedback, changed))


def _cell(cell: CellReport, changed: ChangedText) -> CellReport:
    return replace(cell, feedback=_messages(cell.feedback, changed))


def _messages(messages: tuple[Feedback, ...], changed: ChangedText) -> tuple[Feedback, ...]:
    return tuple(
        replace(
            message,
            message=changed(message.message),
            correction=_correction(message.correction, changed),
            places=message.places
            and tuple(
                replace(place, correction=_correction(place.correction, changed))
                for place in message.places
            ),
        )
        for message in messages
    )


def _correction(correction: Correction | None, changed: ChangedText) -> Correction | None:
    if correction is None or correction.latex is not None:
        return correction
    return replace(correction, text=changed(correction.text))
