"""The points of a part, from the verdicts on its cells.

Points are counted in quarters or hundredths of a point. ``docs/marks.md`` explains the rules.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

from service.catalogue import PartSpec
from service.catalogue.files.fields import Marking
from service.grading.judging.marking.worth import BESIDES, CellWorth, apportioned, worth_of
from service.grading.lost_points import (
    ALL_OR_NOTHING,
    CELLS,
    NO_ANSWER,
    NO_JOINT_MOVES,
    NOT_READ,
    OUTSIDE,
    SHARED,
    WHOLE,
    little_worth,
    lost_in_row,
    lost_points,
)
from service.grading.part import Content, Judged
from service.grading.report import (
    Feedback,
    LittleWorth,
    LostPoints,
    PartReport,
    RowReport,
    Verdict,
    combined,
    rounded_points,
)

# The verdicts on the cells of each row.
_Verdicts = Sequence[Sequence[Verdict]]


@dataclass(frozen=True, slots=True)
class _Loss:
    """The points lost in one row, or in the whole answer if ``row`` is None."""

    # ``steps`` are quarters or hundredths of a point.
    code: str
    steps: int
    row: int | None = None


@dataclass(frozen=True, slots=True)
class _Marks:
    """The loss of an answer, in quarters or hundredths of a point."""

    worth: CellWorth
    lost: int
    losses: tuple[_Loss, ...]
    rows: tuple[int, ...]


def part_report(part: PartSpec, judged: Judged) -> PartReport:
    """Return the report on a judged part, with the points of its rows."""
    marks = _marks(judged, part.marking, part.points)
    worth = marks.worth
    rows = tuple(
        _with_points(row, worth.points(possible), worth.points(possible - lost))
        for row, possible, lost in zip(judged.rows, worth.rows, marks.rows, strict=True)
    )
    points = rounded_points(worth.points(worth.total - marks.lost))
    verdict = combined(row.verdict for row in rows)
    if verdict is Verdict.CORRECT and judged.slips:
        verdict = Verdict.PARTIAL
    return PartReport(
        part=part.id,
        kind=part.kind,
        verdict=verdict if points else _without_points(verdict, rows),
        points=points,
        max_points=part.points,
        follow_through=False,
        rows=rows,
        feedback=judged.feedback,
        lost=tuple(_told(loss, marks, rows) for loss in _as_lost_by_rows(marks)),
        little_worth=_little_worth(judged.content, part, rows) if marks.lost else None,
    )


def unjudged_report(
    part: PartSpec, verdict: Verdict, feedback: tuple[Feedback, ...] = ()
) -> PartReport:
    """Return the report on a part without an answer, or with an unreadable answer."""
    report = _without_rows(part.id, part.kind, part.points, verdict)
    return replace(report, feedback=feedback) if feedback else report


@lru_cache(maxsize=1024)
def _without_rows(part: str, kind: str, points: float, verdict: Verdict) -> PartReport:
    code = NO_ANSWER if verdict is Verdict.MISSING else NOT_READ
    return PartReport(part, kind, verdict, 0.0, points, False, (), (), (lost_points(code, points),))


def has_earned(part: PartSpec, judged: Judged, share: float) -> bool:
    """True if an answer has earned ``share`` (0 to 1) of its points.

    Only cells that need knowledge count.
    """
    # A rotation with a position must have earned more than ``share``, because later parts that need
    # only a correct rotation are easy.
    marks = _marks(judged, "content", part.points)
    earned, least = marks.worth.total - marks.lost, share * marks.worth.total
    return earned > least if judged.content.equal else earned >= least


def steps_lost(part: PartSpec, judged: Judged) -> int:
    """Return the loss of points of an answer, in quarters or hundredths of a point."""
    return _marks(judged, part.marking, part.points).lost


def least_lost(part: PartSpec, judged: Judged, cells: int) -> int:
    """Return the smallest loss of a wrong row with ``cells`` cells that earn points.

    The loss is in quarters or hundredths of a point.
    """
    if part.marking != "content":
        return 0
    worth = worth_of(judged.content, part.marking, part.points)
    return cells * worth.unit + worth.least_besides


def _marks(judged: Judged, marking: Marking, points: float) -> _Marks:
    if judged.is_right:
        return _of_right(judged.content, marking, points)
    worth = worth_of(judged.content, marking, points)
    verdicts = [[cell.verdict for cell in row.cells] for row in judged.rows]
    charges = _charges(worth, verdicts, marking)
    losses = _losses(judged, marking, points, worth, charges)
    lost = sum(loss.steps for loss in losses)
    return _Marks(worth, lost, losses, tuple(_by_row(lost, charges, worth)))


@lru_cache(maxsize=1024)
def _of_right(content: Content, marking: Marking, points: float) -> _Marks:
    worth = worth_of(content, marking, points)
    return _Marks(worth, 0, (), (0,) * len(worth.rows))


def _losses(
    judged: Judged, marking: Marking, points: float, worth: CellWorth, charges: list[int]
) -> tuple[_Loss, ...]:
    if judged.stands_still:
        return (_Loss(NO_JOINT_MOVES, worth.total),)
    if marking == "whole":
        return (_Loss(ALL_OR_NOTHING, worth.total),)
    losses = [_Loss(CELLS, steps, i) for i, steps in enumerate(charges) if steps]
    lost = sum(charges)
    if marking == "content" and math.isfinite(judged.lost):
        # Another valid table may lose less than the likeliest one, which the verdicts are from. Its
        # ``lost`` counts BESIDES for each row that is wrong as a whole.
        fifths = round(judged.lost / BESIDES)
        units, rows = divmod(fifths, round(1 / BESIDES))
        lost = min(lost, units * worth.unit + rows * worth.least_besides)
    if judged.slips:
        losses.append(_Loss(OUTSIDE, judged.slips * worth.slip))
        lost += judged.slips * worth.slip
    lost = min(lost, worth.total)
    if judged.whole_cost is not None:
        beside = () if judged.beside is None else _marks(judged.beside, marking, points).losses
        whole = [_Loss(WHOLE, max(1, round(judged.whole_cost * worth.total))), *beside]
        if (once := sum(loss.steps for loss in whole)) < lost:
            losses, lost = whole, once
    lost = _limited(lost, judged, marking, points, worth)
    if not losses:
        return (_Loss(OUTSIDE, lost),) if lost else ()
    shares = apportioned(lost, [loss.steps for loss in losses])
    pairs = zip(losses, shares, strict=True)
    return tuple(replace(loss, steps=steps) for loss, steps in pairs if steps)


def _limited(lost: int, judged: Judged, marking: Marking, points: float, worth: CellWorth) -> int:
    if judged.at_most is not None:
        least = _marks(judged.at_most, marking, points).lost
        if judged.needs_all:
            least = min(least, judged.count_wrong * worth.unit)
        lost = max(lost, least)
    if judged.at_least is not None:
        lost = min(lost, max(1, _marks(judged.at_least, marking, points).lost))
    # A slip of the whole answer may have put a cell where it does not count.
    is_counted = marking == "content" and judged.whole_cost is None
    if judged.written is not None and is_counted:
        lost = max(lost, (worth.counted - judged.written) * worth.unit)
    return lost


def _charges(worth: CellWorth, verdicts: _Verdicts, marking: Marking) -> list[int]:
    # A wrong cell that needs no knowledge costs as much as a cheap one that does, or a fifth of it
    # if the cell is only unreadable. A group of cells cannot lose more than it is worth.
    if marking == "rows":
        pairs = zip(worth.rows, verdicts, strict=True)
        return [0 if _is_right(row) else max(1, steps) for steps, row in pairs]
    found: dict[int, dict[int, int]] = {}
    content = worth.content
    for i, row in enumerate(verdicts):
        if _is_right(row):
            continue
        cells = zip(content.known[i], content.groups[i], worth.cells[i], row, strict=True)
        cheap = set()
        for known, group, steps, verdict in cells:
            if verdict is Verdict.CORRECT:
                continue
            charged = found.setdefault(group, {})
            if known or (verdict is not Verdict.UNREADABLE and i not in content.bottom):
                cost = steps if known and not worth.is_fixed else worth.units[group]
                charged[i] = charged.get(i, 0) + cost
            else:
                cheap.add(group)
        for group in cheap:
            found[group][i] = found[group].get(i, 0) + worth.fifth(group)
    charges = [0] * len(verdicts)
    for group, rows in found.items():
        costs = list(rows.values())
        limited = apportioned(min(sum(costs), worth.groups[group]), costs)
        for i, steps in zip(rows, limited, strict=True):
            charges[i] += steps
    return charges


def _is_right(row: Sequence[Verdict]) -> bool:
    return all(verdict is Verdict.CORRECT for verdict in row)


def _by_row(lost: int, charges: list[int], worth: CellWorth) -> list[int]:
    # If a row is worth less than its cells cost, other rows lose the rest: first the rows of the
    # same group, then the rows with a cost, then all rows.
    rows = apportioned(min(lost, sum(charges)), charges)
    groups = worth.content.groups
    overdrawn = {
        group for i, steps in enumerate(rows) if steps > worth.rows[i] for group in groups[i]
    }
    rows = [min(steps, most) for steps, most in zip(rows, worth.rows, strict=True)]
    ways: tuple[Callable[[int], bool], ...] = (
        lambda i: not overdrawn.isdisjoint(groups[i]),
        lambda i: charges[i] > 0,
        lambda _: True,
    )
    for loses in ways:
        rest = lost - sum(rows)
        if not rest:
            break
        room = [
            most - steps if loses(i) else 0
            for i, (steps, most) in enumerate(zip(rows, worth.rows, strict=True))
        ]
        more = apportioned(min(rest, sum(room)), room)
        rows = [steps + each for steps, each in zip(rows, more, strict=True)]
    return rows


def _as_lost_by_rows(marks: _Marks) -> list[_Loss]:
    # No row is told to lose more than it really lost. Other rows lose the rest, which is told once.
    whole = [loss for loss in marks.losses if loss.code == WHOLE]
    outside = [loss for loss in marks.losses if loss.row is None and loss.code != WHOLE]
    rows, rest = [], 0
    for loss in marks.losses:
        if loss.row is not None:
            steps = min(loss.steps, marks.rows[loss.row])
            rest += loss.steps - steps
            if steps:
                rows.append(replace(loss, steps=steps))
    if rest:
        rows.append(_Loss(SHARED, rest))
    # A slip of the whole answer comes first, an extra row last.
    return [*whole, *rows, *outside]


def _told(loss: _Loss, marks: _Marks, rows: Sequence[RowReport]) -> LostPoints:
    points = marks.worth.points(loss.steps)
    if loss.row is None:
        return lost_points(loss.code, points)
    return lost_in_row(rows[loss.row], points)


def _little_worth(
    content: Content, part: PartSpec, rows: Sequence[RowReport]
) -> LittleWorth | None:
    if part.kind != "dh_table" or part.marking != "content":
        return None
    zeros = [row for row, known in zip(rows, content.known, strict=True) if not any(known)]
    return little_worth(zeros, part.points)


def _with_points(row: RowReport, possible: float, earned: float) -> RowReport:
    points = rounded_points(earned)
    verdict = row.verdict if points else _without_points(row.verdict, [row])
    return RowReport(row.label, verdict, points, rounded_points(possible), row.cells, row.feedback)


def _without_points(verdict: Verdict, rows: Sequence[RowReport]) -> Verdict:
    # Rows that earn nothing are never "partly right".
    if verdict is not Verdict.PARTIAL:
        return verdict
    of_cells = {cell.verdict for row in rows for cell in row.cells}
    return combined(of_cells - {Verdict.CORRECT})
