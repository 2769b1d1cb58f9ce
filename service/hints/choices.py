"""Alternatives to a correct table: valid tables with one frame chosen differently.

The x or z axis of a frame may point the other way. If the next axis is parallel, the frame may
slide along its z axis. The grader decides which of these changes the exercise allows.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import islice
from typing import Final

from service.catalogue import Exercise, FeedbackLevel
from service.catalogue.parts.dh_table import DhTableSpec
from service.grading import Submission, grade
from service.grading.report import Verdict
from service.kinematics.dh import Convention
from service.regex import regex
from service.translations import say

MOST: Final = 3
# Each is graded.
MOST_TRIED: Final = 12
_SIMPLE: Final = regex(r"-?[^\s+\-*/()]+")
_HALF_TURNS: Final = ("180°", "-180°", "180deg", "-180deg", "pi", "-pi", "π", "-π")

# A row: a, alpha, d and theta as texts.
Cells = Mapping[str, str]


@dataclass(frozen=True, slots=True)
class FrameChoice:
    """An alternative to a correct table, and how the two tables differ."""

    change: str
    rows: tuple[Cells, ...]


def other_choices(
    exercise: Exercise, part: DhTableSpec, rows: Sequence[Cells], submission: Submission
) -> list[FrameChoice]:
    """Return at most three alternatives to the correct table ``rows``; none if it is wrong."""
    convention = part.convention
    if not isinstance(convention, Convention) or part.frames != "free":
        return []

    def is_right(table: Sequence[Cells]) -> bool:
        answers = {part.id: {"rows": [dict(row) for row in table]}}
        sent = Submission(answers, submission.angle_unit, FeedbackLevel.SCORE)
        report = next(each for each in grade(exercise, sent).parts if each.part == part.id)
        return report.verdict is Verdict.CORRECT

    if not is_right(rows):
        return []
    lengths = [
        each.name for each in exercise.variables if each.joint is None and each.kind == "length"
    ]
    tried = islice(_changed(rows, convention, lengths), MOST_TRIED)
    found = (each for each in tried if is_right(each.rows))
    return list(islice(found, MOST))


def _changed(
    rows: Sequence[Cells], convention: Convention, lengths: Sequence[str]
) -> Iterator[FrameChoice]:
    """Yield tables in which one frame between two rows is chosen differently."""
    # The first tables differ in as many ways as possible.
    ways: list[Callable[[list[Cells], int, Convention], FrameChoice]]
    ways = [_reversed_x, _reversed_z, *(partial(_slid, length=length) for length in lengths[:1])]
    inner = len(rows) - 1
    for i in range(inner):
        for k, way in enumerate(ways):
            yield way(list(rows), (i + k) % inner, convention)


# The frame after row i moves by M. So row i becomes A_i M, and the next row M⁻¹ A_{i+1}; both are
# written as rows again.


def _reversed_x(rows: list[Cells], i: int, convention: Convention) -> FrameChoice:
    """Turn the frame by a half turn about its z axis, so that x points the other way."""
    for k in (i, i + 1):
        rows[k] = {**rows[k], "theta": _plus_half_turn(rows[k]["theta"])}
    reverse = i if convention is Convention.STANDARD else i + 1
    rows[reverse] = {**rows[reverse], **_negated(rows[reverse], "a", "alpha")}
    return FrameChoice(say("{axis} points the other way.", axis=f"x{i + 1}"), tuple(rows))


def _reversed_z(rows: list[Cells], i: int, convention: Convention) -> FrameChoice:
    """Turn the frame by a half turn about its x axis, so that z points the other way."""
    for k in (i, i + 1):
        rows[k] = {**rows[k], "alpha": _plus_half_turn(rows[k]["alpha"])}
    reverse = i + 1 if convention is Convention.STANDARD else i
    rows[reverse] = {**rows[reverse], **_negated(rows[reverse], "d", "theta")}
    return FrameChoice(say("{axis} points the other way.", axis=f"z{i + 1}"), tuple(rows))


def _slid(rows: list[Cells], i: int, convention: Convention, length: str) -> FrameChoice:
    """Slide the frame along its z axis, which is parallel to the next or the previous z axis."""
    between = rows[i if convention is Convention.STANDARD else i + 1]["alpha"]
    is_opposite, is_standard = between in _HALF_TURNS, convention is Convention.STANDARD
    here, after = rows[i]["d"], rows[i + 1]["d"]
    here = _sum(here, length, is_minus=is_standard and is_opposite)
    after = _sum(after, length, is_minus=is_standard or not is_opposite)
    rows[i], rows[i + 1] = {**rows[i], "d": here}, {**rows[i + 1], "d": after}
    text = say(
        "The origin of frame {frame} lies farther along {axis}.",
        frame=f"{{{i + 1}}}",
        axis=f"z{i + 1}",
    )
    return FrameChoice(text, tuple(rows))


def _negated(row: Cells, *columns: str) -> dict[str, str]:
    return {column: _minus(row[column]) for column in columns}


def _minus(text: str) -> str:
    if not _SIMPLE.fullmatch(text):
        return f"-({text})"
    if text in ("0", *_HALF_TURNS):
        return text
    return text[1:] if text.startswith("-") else f"-{text}"


def _plus_half_turn(text: str) -> str:
    if text in _HALF_TURNS:
        return "0"
    return "180°" if text == "0" else f"{text} + 180°"


def _sum(text: str, length: str, *, is_minus: bool) -> str:
    sign = "-" if is_minus else "+"
    if text == "0":
        return f"-{length}" if is_minus else length
    return f"{text} {sign} {length}"
