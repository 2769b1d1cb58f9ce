"""The outcome of a report: verdicts and message codes, without the answers."""

import hashlib
import json
from dataclasses import dataclass
from functools import cached_property

from service.grading import Report
from service.grading.report import PartReport


@dataclass(frozen=True)
class Outcome:
    """The verdicts and message codes of one report, as JSON in ``content``."""

    exercise: str
    content: str

    @cached_property
    def digest(self) -> str:
        """The SHA-256 of the content; equal outcomes have equal digests."""
        return hashlib.sha256(self.content.encode()).hexdigest()


def outcome_of(report: Report) -> Outcome:
    """Return the verdicts and message codes of a report.

    The feedback level of the report must be higher than ``score``.
    """
    content = {part.part: _part(part) for part in report.parts}
    return Outcome(report.exercise.partition("~")[0], json.dumps(content, separators=(",", ":")))


def _part(part: PartReport) -> dict[str, object]:
    cells = {
        f"{row.label}/{cell.label}": str(cell.verdict) for row in part.rows for cell in row.cells
    }
    messages = [
        *part.feedback,
        *(message for row in part.rows for message in row.feedback),
        *(message for row in part.rows for cell in row.cells for message in cell.feedback),
    ]
    codes = sorted({message.code for message in messages if message.severity != "info"})
    return {"verdict": str(part.verdict), "cells": cells, "codes": codes}
