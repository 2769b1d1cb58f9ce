"""A file that was graded, as every format takes it."""

from dataclasses import dataclass
from pathlib import Path

from service.grading import Report


@dataclass(frozen=True, slots=True)
class GradedFile:
    """A file with its report, or with the reason why there is none."""

    file: Path
    report: Report | None
    error: str = ""
