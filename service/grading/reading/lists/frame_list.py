"""Read a list of frames on joint axes, from JSON or a pasted table.

A frame is its joint axis, the direction of z, its origin, and the direction of x.
"""

# A direction is a name such as ``+x`` or ``-z0``, or a vector of any length.

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from service.catalogue.parts.frames import FRAME_CELLS
from service.grading.feedback import Finding, UnreadableAnswerError, reading_error
from service.grading.numerics.samples import Samples
from service.grading.reading.entry import MISSING, Entry, Reader, entry_values, unreadable
from service.grading.reading.pasted import from_grid_error, pasted_grid, placed
from service.grading.report import Verdict
from service.grids import GridCell, GridError
from service.kinematics.transforms import Numbers
from service.regex import regex
from service.translations import say

LABEL: Final = "frame"
_BASE_AXES: Final = "xyz"
# x, +x, - x0, -X_0, +x_{0}: a direction of the base frame.
_DIRECTION: Final = regex(r"([+-]?)\s?([xyzXYZ])_?(?:0|\{0\})?")
_JOINT: Final = regex(r"(?:(?:joint|axis|z|j)[ _]?)?([0-9]{1,3})", re.IGNORECASE)
_DIGIT: Final = regex(r"[0-9]")
_MINUS: Final = str.maketrans({"\u2212": "-", "\u2013": "-", "\u2080": "0"})
# A longer text is no name; a longer vector is refused before it is split.
_LONGEST_NAME: Final = 16
_LONGEST_VECTOR: Final = 600


@dataclass(frozen=True, slots=True)
class Direction:
    """A direction as read: the entries of a vector, or the name of a base direction.

    ``name`` is the axis and the sense of a base direction, such as (1, -1) for -y.
    """

    entries: tuple[Entry, ...] = ()
    name: tuple[int, int] | None = None

    @property
    def unread(self) -> Entry | None:
        """The first entry that could not be read, or None."""
        return next((entry for entry in self.entries if not entry.readable), None)

    def values(self, samples: Samples) -> Numbers | None:
        """Return the vector at ``count`` samples, ``(count, 3)``, or None if it was not read."""
        if self.name is not None:
            axis, sense = self.name
            return np.tile(sense * np.eye(3)[axis], (samples.count, 1))
        if self.unread is not None:
            return None
        return entry_values(self.entries, ("number",) * 3, samples).T


# The entry of a name that was read without being a formula.
_READ: Final = Entry(None)


@dataclass(frozen=True, slots=True)
class JointNumber:
    """The number of a joint axis as read.

    ``number`` is None if the cell has no whole number; ``entry`` has the reason.
    """

    number: int | None
    entry: Entry = _READ


@dataclass(frozen=True, slots=True)
class StudentFrame:
    """A frame as read from a student's answer."""

    axis: JointNumber
    z: Direction
    origin: tuple[Entry, Entry, Entry]
    x: Direction

    @property
    def entries(self) -> tuple[Entry, ...]:
        """All entries that were read as formulas."""
        return (*self.z.entries, *self.origin, *self.x.entries)


_NO_FRAME: Final = StudentFrame(
    JointNumber(None, MISSING), Direction((MISSING,)), (MISSING,) * 3, Direction((MISSING,))
)


def read_frames(answer: object, labels: Sequence[str], reader: Reader) -> tuple[StudentFrame, ...]:
    """Read the frames with these labels, in order. Raises UnreadableAnswerError."""
    if isinstance(answer, str):
        return _pasted(answer, labels, reader)
    if isinstance(answer, Mapping):
        answer = answer.get("rows", [answer])
    if not isinstance(answer, list):
        raise UnreadableAnswerError(_WRONG_SHAPE)
    rows = [_cells_of(row) for row in answer]
    named = [
        str(row[LABEL]) if isinstance(row, Mapping) and LABEL in row else None for row in answer
    ]
    found = dict(_numbered(named, labels))
    return tuple(
        _frame(rows[found[label]], reader) if label in found else _NO_FRAME for label in labels
    )


def _numbered(named: Sequence[str | None], labels: Sequence[str]) -> list[tuple[str, int]]:
    # Rows without names are in order.
    if len(named) > len(labels):
        raise UnreadableAnswerError(_TOO_MANY)
    if any(name is None for name in named):
        return list(zip(labels, range(len(named)), strict=False))
    if len(set(named)) < len(named) or not set(named) <= set(labels):
        raise UnreadableAnswerError(_WRONG_LABELS)
    return [(str(name), i) for i, name in enumerate(named)]


def _cells_of(row: object) -> tuple[object, ...]:
    if row is None:
        return (None,) * len(FRAME_CELLS)
    if isinstance(row, Mapping):
        if not row.keys() <= _KEYS:
            raise UnreadableAnswerError(_WRONG_SHAPE)
        origin = row.get("origin", [row.get(name) for name in FRAME_CELLS[2:5]])
        row = [row.get("axis"), row.get("z"), origin, row.get("x")]
    if not isinstance(row, list):
        raise UnreadableAnswerError(_WRONG_SHAPE)
    if len(row) == len(FRAME_CELLS) - 2:
        row = [*row[:2], *_three(row[2]), row[3]]
    if len(row) != len(FRAME_CELLS):
        raise UnreadableAnswerError(_WRONG_SHAPE)
    return tuple(row)


_KEYS: Final = frozenset({LABEL, "origin", *FRAME_CELLS})


def _three(point: object) -> Sequence[object]:
    if isinstance(point, str) and point.strip():
        point = _components(point) or [point]
    if point is None or point == "":
        return [None] * 3
    if not isinstance(point, list) or len(point) != 3:
        raise UnreadableAnswerError(_WRONG_SHAPE)
    return point


def _pasted(text: str, labels: Sequence[str], reader: Reader) -> tuple[StudentFrame, ...]:
    try:
        found = pasted_frames(text, labels, reader)
    except GridError as error:
        raise UnreadableAnswerError(from_grid_error(error)) from error
    return tuple(
        _pasted_frame(found[label], reader) if label in found else _NO_FRAME for label in labels
    )


def pasted_frames(
    text: str, labels: Sequence[str], reader: Reader
) -> Mapping[str, Sequence[GridCell]]:
    """Return the six cells of each frame in a pasted table, by the frame's label.

    Raises GridError or UnreadableAnswerError.
    """
    grid = pasted_grid(text, reader)
    rows = [row for row in grid.rows if not _is_header(row)]
    width = len(FRAME_CELLS)
    if not rows or any(len(row) not in (width, width + 1) for row in rows):
        raise UnreadableAnswerError(_WRONG_TEXT)
    named = [row[0].text.strip(" {}") if len(row) > width else None for row in rows]
    return {label: rows[i][-width:] for label, i in _numbered(named, labels)}


def _is_header(row: Sequence[GridCell]) -> bool:
    return any("axis" in text and not _DIGIT.search(text) for text in (c.text.lower() for c in row))


def _frame(cells: Sequence[object], reader: Reader) -> StudentFrame:
    axis, z, *origin, x = cells
    first, second, third = (reader.read(each, "length") for each in origin)
    return StudentFrame(
        _joint(axis, reader), _direction(z, reader), (first, second, third), _direction(x, reader)
    )


def _pasted_frame(cells: Sequence[GridCell], reader: Reader) -> StudentFrame:
    frame = _frame([cell.text for cell in cells], reader)
    joint, z, *origin, x = cells
    first, second, third = (
        placed(entry, cell) for entry, cell in zip(frame.origin, origin, strict=True)
    )

    def moved(direction: Direction, cell: GridCell) -> Direction:
        entries = (_whole(entry, cell) for entry in direction.entries)
        return replace(direction, entries=tuple(entries))

    axis = replace(frame.axis, entry=_whole(frame.axis.entry, joint))
    return StudentFrame(axis, moved(frame.z, z), (first, second, third), moved(frame.x, x))


def _whole(entry: Entry, cell: GridCell) -> Entry:
    findings = tuple(replace(each, span=cell.whole) for each in entry.findings)
    return replace(entry, findings=findings)


def _joint(raw: object, reader: Reader) -> JointNumber:
    if isinstance(raw, str) and len(raw) <= _LONGEST_NAME:
        if named := _JOINT.fullmatch(raw.strip()):
            return JointNumber(int(named[1]))
    elif isinstance(raw, int) and not isinstance(raw, bool) and abs(raw) < 1000:
        return JointNumber(raw)
    entry = reader.read(raw, "number")
    if entry.expression is None:
        return JointNumber(None, entry)
    return JointNumber(None, unreadable(_NO_JOINT))


def _direction(raw: object, reader: Reader) -> Direction:
    if isinstance(raw, str):
        plain = raw.translate(_MINUS).strip()
        if not plain:
            return Direction((MISSING,))
        named = _DIRECTION.fullmatch(plain) if len(plain) <= _LONGEST_NAME else None
        if named:
            sense = -1 if named[1] == "-" else 1
            return Direction(name=(_BASE_AXES.index(named[2].lower()), sense))
        raw = _components(raw)
    elif raw is None:
        return Direction((MISSING,))
    if not isinstance(raw, list) or len(raw) != 3:
        return Direction((unreadable(_NO_DIRECTION),))
    entries = tuple(reader.read(each, "number") for each in raw)
    return Direction(tuple(_without_span(entry) for entry in entries))


def _without_span(entry: Entry) -> Entry:
    # The spans count from the start of the component, not of the cell.
    findings = tuple(replace(each, span=None, suggestion=None) for each in entry.findings)
    return replace(entry, findings=findings)


def _components(text: str) -> list[object] | None:
    if len(text) > _LONGEST_VECTOR:
        return None
    inner = text.strip()
    if inner[:1] in "[(" and inner[-1:] in "])":
        inner = inner[1:-1]
    parts: list[object] = []
    depth, start = 0, 0
    for i, character in enumerate(inner):
        depth += (character in "([") - (character in ")]")
        if character in ",;" and depth == 0:
            parts.append(inner[start:i])
            start = i + 1
    parts.append(inner[start:])
    return parts if len(parts) == 3 else None


def unread_verdict(entries: Sequence[Entry]) -> Verdict | None:
    """Return the verdict on a cell that could not be read; None if it was read."""
    return next((entry.verdict for entry in entries if not entry.readable), None)


def _reading(message: str) -> Finding:
    return reading_error("wrong_shape", message)


_WRONG_SHAPE: Final = _reading(
    say('One row for each frame is asked for: {{"axis": …, "z": …, "origin": [x, y, z], "x": …}}.')
)
_WRONG_TEXT: Final = _reading(
    say(
        "One row for each frame is asked for: its number, joint axis, z, the three "
        "coordinates of its origin, and x."
    )
)
_TOO_MANY: Final = _reading(say("There are more rows than frames on joint axes."))
_WRONG_LABELS: Final = _reading(say("Each row must have the number of another asked frame."))
_NO_JOINT: Final = _reading(say("Write the number of a joint."))
_NO_DIRECTION: Final = _reading(
    say(
        "Write a direction of the base frame with its sign, or a vector with three "
        "components and commas between them."
    )
)
