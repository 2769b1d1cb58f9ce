"""The points of a part, from the verdicts on its cells and the worth of the cells.

``docs/marks.md`` explains the rules to students and tutors, with an example.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

from service.catalogue import PartSpec
from service.catalogue.files.fields import Marking
from service.grading.part import Content, Judged
from service.grading.report import (
    Feedback,
    PartReport,
    RowReport,
    Verdict,
    combined,
    rounded_points,
)

# The worth that a group of cells has besides its content cells, which count 1 each. For all groups
# together it is at most a third of the content cells, so that a lazy answer earns at most a
# quarter.
BESIDES: Final = 0.2
MOST_BESIDES: Final = 1 / 3
# The rounding error that a sum of shares may have.
_ROUNDING_ERROR: Final = 1e-6

# The verdicts on the cells of each row.
_Verdicts = Sequence[Sequence[Verdict]]


@dataclass(frozen=True, slots=True)
class Shares:
    """The shares of the part's points that each row can earn and does earn."""

    possible: list[float]
    earned: list[float]

    def with_total(self, total: float) -> "Shares":
        """Rescale the earned points to a new total.

        The losses of rows that have lost something are scaled. The other rows lose points only if
        this is not enough.
        """
        pairs = list(zip(self.possible, self.earned, strict=True))
        lost = sum(most - share for most, share in pairs)
        factor = (1 - total) / lost if lost > 0 else 0.0
        earned = [max(0.0, most - (most - share) * factor) for most, share in pairs]
        spoiled = [most > share for most, share in pairs]
        for losing in (spoiled, [True] * len(pairs)):
            rest = sum(share for share, loses in zip(earned, losing, strict=True) if loses)
            excess = min(rest, max(0.0, sum(earned) - total))
            scale = 1 - excess / (rest or 1.0)
            earned = [
                share * scale if loses else share
                for share, loses in zip(earned, losing, strict=True)
            ]
        return Shares(self.possible, earned)


def part_report(part: PartSpec, judged: Judged) -> PartReport:
    """Return the report on a judged part, with the points of its rows."""
    shares = shares_of(judged, part.marking)
    rows = tuple(
        _with_points(row, possible * part.points, earned * part.points)
        for row, possible, earned in zip(judged.rows, shares.possible, shares.earned, strict=True)
    )
    points = rounded_points(sum(shares.earned) * part.points)
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
    )


def unjudged_report(
    part: PartSpec, verdict: Verdict, feedback: tuple[Feedback, ...] = ()
) -> PartReport:
    """Return the report on a part without an answer, or with an unreadable one."""
    return PartReport(part.id, part.kind, verdict, 0.0, part.points, False, (), feedback)


def has_earned(judged: Judged, share: float) -> bool:
    """True if an answer has earned at least ``share`` (0 to 1) of the points by content.

    For a rotation with a position, it must be more than ``share``: later parts that follow from a
    right rotation alone are easy.
    """
    earned = sum(shares_of(judged, "content").earned)
    return earned > share + _ROUNDING_ERROR if judged.content.equal else earned >= share


def shares_of(judged: Judged, marking: Marking) -> Shares:
    """Return the share of each row by a marking. The sum is 1 if everything is right."""
    if judged.is_right:
        return _of_right(judged.content, marking)
    verdicts = [[cell.verdict for cell in row.cells] for row in judged.rows]
    shares, slip_cost = _SHARES[marking](judged.content, verdicts)
    total = sum(shares.earned)
    if marking == "content" and math.isfinite(judged.lost):
        # Another valid table may lose less than the likeliest one, which the verdicts are from. Its
        # ``lost`` counts BESIDES for each row that is wrong as a whole; the row may be worth less.
        rows = round(judged.lost / BESIDES) % round(1 / BESIDES)
        lost = judged.lost - rows * (BESIDES - _besides(judged.content))
        total = max(total, 1 - slip_cost * lost)
    total -= slip_cost * judged.slips
    if judged.whole_cost is not None and marking != "whole":
        most = 1.0 if judged.beside is None else sum(shares_of(judged.beside, marking).earned)
        total = max(total, most - judged.whole_cost)
    if judged.at_most is not None:
        total = min(total, sum(shares_of(judged.at_most, marking).earned))
    if judged.stands_still:
        total = 0.0
    return shares.with_total(max(0.0, total))


@lru_cache(maxsize=1024)
def _of_right(content: Content, marking: Marking) -> Shares:
    """Return the shares if everything is right; most answers to a part have these."""
    verdicts = [[Verdict.CORRECT] * len(row) for row in content.known]
    return _SHARES[marking](content, verdicts)[0]


def _by_content(content: Content, verdicts: _Verdicts) -> tuple[Shares, float]:
    """Return the shares by content, and the cost of one wrong cell.

    The latter is also the cost of a slip outside all cells. A wrong cell costs a unit, and a group
    cannot lose more than it is worth. A student's own frames may have more content cells than the
    reference's; that does not reduce the cost of a wrong cell.
    """
    groups = _groups_of(content, verdicts)
    worth = sum(group.worth for group in groups)
    lost = sum(group.lost for group in groups)
    possible, earned = [0.0] * len(verdicts), [0.0] * len(verdicts)
    for group in groups:
        value = 1 / (len(groups) * group.worth) if content.equal else 1 / worth
        for row, units, kept in group.by_row():
            possible[row] += units * value
            earned[row] += kept * value
    shares = Shares(possible, earned)
    if content.equal:
        return shares, 1 / worth
    if content.most:
        worth -= max(0, content.count - content.most)
    return shares.with_total(min(sum(earned), max(0.0, 1 - lost / worth))), 1 / worth


@dataclass(slots=True)
class _Group:
    """The worth of a group's cells in each row, its wrong cells, and its rows with unread ones.

    An unread content cell costs a unit; all other unread cells of a row cost a fifth together. An
    empty cell of a table costs as much as a wrong one.
    """

    units: dict[int, float]
    wrong: dict[int, int]
    unread: set[int]

    @property
    def worth(self) -> float:
        return sum(self.units.values())

    @property
    def lost(self) -> float:
        return min(self.worth, sum(map(self.lost_in, self.units)))

    def lost_in(self, row: int) -> float:
        return self.wrong[row] + BESIDES * (row in self.unread)

    def by_row(self) -> Iterator[tuple[int, float, float]]:
        """Yield each row of the group with its worth and the part of it that is earned."""
        kept = {row: max(0.0, units - self.lost_in(row)) for row, units in self.units.items()}
        # A row cannot lose more than its worth; the other rows lose the rest.
        factor = (self.worth - self.lost) / (sum(kept.values()) or 1.0)
        for row, units in self.units.items():
            yield row, units, kept[row] * factor


def _groups_of(content: Content, verdicts: _Verdicts) -> list[_Group]:
    groups: dict[int, _Group] = {}
    rows = zip(content.known, content.groups, verdicts, strict=True)
    for i, cells in enumerate(rows):
        for known, number, verdict in zip(*cells, strict=True):
            group = groups.setdefault(number, _Group({}, {}, set()))
            group.units[i] = group.units.get(i, 0.0) + known
            group.wrong.setdefault(i, 0)
            if verdict is Verdict.CORRECT:
                continue
            is_wrong = verdict is Verdict.INCORRECT or (
                content.empty_is_wrong and verdict is Verdict.MISSING
            )
            if known or is_wrong:
                group.wrong[i] += 1
            else:
                group.unread.add(i)
    if content.besides:
        besides = _besides(content)
        for group in groups.values():
            for row in group.units:
                group.units[row] += besides / len(group.units)
    return list(groups.values())


def _besides(content: Content) -> float:
    """Return the worth that a group has besides its content cells."""
    groups = len({number for row in content.groups for number in row})
    count = min(content.count, content.most or content.count)
    return min(BESIDES, MOST_BESIDES * count / groups) or BESIDES


def _by_cells(_content: Content, verdicts: _Verdicts) -> tuple[Shares, float]:
    """Return the shares if every cell counts the same, and the cost of a slip outside all cells."""
    cells = sum(map(len, verdicts))
    right = [row.count(Verdict.CORRECT) for row in verdicts]
    shares = Shares([len(row) / cells for row in verdicts], [count / cells for count in right])
    return shares, 1 / len(verdicts)


def _by_rows(_content: Content, verdicts: _Verdicts) -> tuple[Shares, float]:
    """Return the shares if rows count only as a whole, and the cost of a slip outside all cells."""
    share = 1 / len(verdicts)
    return Shares([share] * len(verdicts), [share * _is_right(row) for row in verdicts]), share


def _as_a_whole(content: Content, verdicts: _Verdicts) -> tuple[Shares, float]:
    """Return the shares if all or nothing is earned, and the cost of a slip outside all cells."""
    shares, _ = _by_content(content, verdicts)
    return shares.with_total(float(all(map(_is_right, verdicts)))), 1.0


def _is_right(row: Sequence[Verdict]) -> bool:
    return all(verdict is Verdict.CORRECT for verdict in row)


_SHARES: Final[Mapping[Marking, Callable[[Content, _Verdicts], tuple[Shares, float]]]] = {
    "content": _by_content,
    "cells": _by_cells,
    "rows": _by_rows,
    "whole": _as_a_whole,
}


def _with_points(row: RowReport, possible: float, earned: float) -> RowReport:
    """Return the row with its points."""
    points = rounded_points(earned)
    verdict = row.verdict if points else _without_points(row.verdict, [row])
    return RowReport(row.label, verdict, points, rounded_points(possible), row.cells, row.feedback)


def _without_points(verdict: Verdict, rows: Sequence[RowReport]) -> Verdict:
    """Return the verdict on rows that earn nothing: never "partly right"."""
    if verdict is not Verdict.PARTIAL:
        return verdict
    of_cells = {cell.verdict for row in rows for cell in row.cells}
    return combined(of_cells - {Verdict.CORRECT})
