"""The report: the result of a grading, in the shape that the HTTP contract names.

Plain frozen dataclasses. A field that is None is left out where a report is sent.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Annotated, Literal, TypeAlias

from pydantic import Field

from service.catalogue import FeedbackLevel

# The rules that ``service/hints`` explains. ``of_column`` is the rule of the column of a DH table.
RuleName: TypeAlias = Literal[
    "of_column",
    "link_length",
    "link_twist",
    "link_offset",
    "joint_angle",
    "joint_variable",
    "rows",
    "convention",
    "angle_unit",
    "product",
    "rotation_columns",
    "position_vector",
    "frame_z",
    "frame_origin",
    "frame_x",
    "inverse",
    "sine_and_cosine",
    "angle_sum",
    "atan2",
    "euler_sequence",
    "elementary_turn",
    "screw_axis",
    "exponentials",
    "dependence",
]


class Verdict(StrEnum):
    """The verdict on a cell, a row or a part."""

    CORRECT = "correct"
    PARTIAL = "partial"
    INCORRECT = "incorrect"
    UNREADABLE = "unreadable"
    MISSING = "missing"


class Severity(StrEnum):
    """The weight of a message: an error costs points, an info costs nothing."""

    ERROR = "error"
    WARNING = "warning"
    HINT = "hint"
    INFO = "info"


@dataclass(frozen=True, slots=True)
class Correction:
    """The right entry, as the student would write it.

    A correction without ``latex`` is an instruction in words: "Exchange a and d."
    """

    text: str
    latex: str | None = None


@dataclass(frozen=True, slots=True)
class Place:
    """A row of the report, or one of its cells, by their labels.

    ``correction`` is the correction of this place, if a message has different corrections for its
    places.
    """

    row: str
    cell: str | None = None
    correction: Correction | None = None


@dataclass(frozen=True, slots=True)
class Feedback:
    """One message, which never contains the right value.

    ``places`` are the rows and cells that a message on a part is about. ``span`` is [from, to) in
    the text of the cell, or in the whole text if it was pasted. ``suggestion`` is the repaired text
    of an unreadable one. ``correction`` is only in reports at the level full. ``values`` is a
    counterexample for the first place: the values of the symbols, and "yours", the value of the
    entry there; at the level full, "expected" is the right value. ``reading`` is true if the
    message is on how a text was read, and ``rule`` is the rule that a hint explains; neither is
    part of a report.
    """

    code: str
    severity: Severity
    message: str
    places: tuple[Place, ...] | None = None
    span: tuple[int, int] | None = None
    suggestion: str | None = None
    correction: Correction | None = None
    values: dict[str, float | str] | None = None
    reading: Annotated[bool | None, Field(exclude=True)] = field(default=None, compare=False)
    rule: Annotated[RuleName | None, Field(exclude=True)] = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class ReadEntry:
    """An entry as it was read."""

    text: str
    latex: str


@dataclass(frozen=True, slots=True)
class CellReport:
    """One table cell or matrix entry; ``read`` is present if the submission asks for it."""

    label: str
    verdict: Verdict
    feedback: tuple[Feedback, ...] = ()
    read: ReadEntry | None = None


@dataclass(frozen=True, slots=True)
class RowReport:
    """One row with its cells, and its share of the part's points."""

    label: str
    verdict: Verdict
    points: float
    max_points: float
    cells: tuple[CellReport, ...]
    feedback: tuple[Feedback, ...] = ()


@dataclass(frozen=True, slots=True)
class LostPoints:
    """Points that a part has lost, and where: ``message`` follows "−0.5: ".

    ``row`` and ``cells`` are labels; both are absent if the answer has lost them as a whole.
    """

    code: str
    points: float
    message: str
    row: str | None = None
    cells: tuple[str, ...] | None = None


@dataclass(frozen=True, slots=True)
class LittleWorth:
    """The reason why rows of zeros are worth few points."""

    rows: tuple[str, ...]
    points: float
    message: str


@dataclass(frozen=True, slots=True)
class PartReport:
    """One part: its rows share its points.

    The points of ``lost`` sum to ``max_points`` - ``points``. In reports of older versions,
    ``lost`` is empty. ``little_worth`` is present if a right row of zeros earned few points.
    """

    part: str
    kind: str
    verdict: Verdict
    points: float
    max_points: float
    follow_through: bool
    rows: tuple[RowReport, ...]
    feedback: tuple[Feedback, ...] = ()
    lost: Annotated[tuple[LostPoints, ...], Field(json_schema_extra={"x-added-later": True})] = ()
    little_worth: LittleWorth | None = None


@dataclass(frozen=True, slots=True)
class Report:
    """The whole grading. ``score`` is points / max_points, 0..1.

    ``grader`` is the program's version, ``feedback`` the level of the report. ``gradable`` is false
    if nothing could be read, so that a site need not count the attempt.
    """

    exercise: str
    version: str
    grader: str
    feedback: FeedbackLevel
    gradable: bool
    points: float
    max_points: float
    score: float
    parts: tuple[PartReport, ...]


def messages_of(part: PartReport) -> Iterator[tuple[Feedback, tuple[Place, ...], Verdict]]:
    """Yield the messages on a part, its rows and cells, with their places and verdicts."""
    verdicts: dict[tuple[str, str | None], Verdict] = {}
    for row in part.rows:
        verdicts[row.label, None] = row.verdict
        verdicts |= {(row.label, cell.label): cell.verdict for cell in row.cells}
    for message in part.feedback:
        places = message.places or ()
        found = [verdicts.get((place.row, place.cell), part.verdict) for place in places[:1]]
        yield message, places, found[0] if found else part.verdict
    for row in part.rows:
        yield from ((message, (Place(row.label),), row.verdict) for message in row.feedback)
        for cell in row.cells:
            at = (Place(row.label, cell.label),)
            yield from ((message, at, cell.verdict) for message in cell.feedback)


def combined(verdicts: Iterable[Verdict]) -> Verdict:
    """Return the verdict on a whole: the verdict of its pieces if all have the same verdict.

    Otherwise the whole is partial if some piece is right, else incorrect if some piece is wrong,
    else unreadable.
    """
    found = set(verdicts)
    if not found:
        return Verdict.MISSING
    if len(found) == 1:
        return found.pop()
    if found & {Verdict.CORRECT, Verdict.PARTIAL}:
        return Verdict.PARTIAL
    return Verdict.INCORRECT if Verdict.INCORRECT in found else Verdict.UNREADABLE


def rounded_points(points: float) -> float:
    """Return points without floating-point rounding errors."""
    return round(points, 6)


def row_report(
    label: str, cells: tuple[CellReport, ...], feedback: tuple[Feedback, ...] = ()
) -> RowReport:
    """Make a row from its cells, without points."""
    return RowReport(label, combined([cell.verdict for cell in cells]), 0.0, 0.0, cells, feedback)
