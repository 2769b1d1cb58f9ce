"""The points of a part: from the verdicts on its cells and what the cells are worth.

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

# What a group of cells is worth besides those that one has to know something for; but all groups
# together no more than a third of those cells, so that a lazy answer earns a quarter at most.
BESIDES: Final = 0.2
MOST_BESIDES: Final = 1 / 3
# What sums of shares may be off by.
_DUST: Final = 1e-6

# The verdicts on the cells of each row.
_Verdicts = Sequence[Sequence[Verdict]]


@dataclass(frozen=True, slots=True)
class Shares:
    """The share of the part's points that each row can earn, and that it earns."""

    possible: list[float]
    earned: list[float]

    def with_total(self, total: float) -> "Shares":
        """The same with another sum of what is earned.

        The rows that have lost something lose more or less; the others only where that is not
        enough.
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
    """The report on a part that was judged, with the points of its rows."""
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
    """The report on a part of which nothing was handed in, or nothing could be read."""
    return PartReport(part.id, part.kind, verdict, 0.0, part.points, False, (), feedback)


def has_earned(judged: Judged, share: float) -> bool:
    """Whether an answer has earned its share of the points, 0 to 1, by content.

    Of a rotation and a position it must be more: what follows from a right rotation alone is easy.
    """
    earned = sum(shares_of(judged, "content").earned)
    return earned > share + _DUST if judged.content.equal else earned >= share


def shares_of(judged: Judged, marking: Marking) -> Shares:
    """The share of each row by a marking. Together they make 1 where everything is right."""
    if judged.is_right:
        return _of_right(judged.content, marking)
    verdicts = [[cell.verdict for cell in row.cells] for row in judged.rows]
    shares, slip_cost = _SHARES[marking](judged.content, verdicts)
    total = sum(shares.earned)
    if marking == "content" and math.isfinite(judged.lost):
        # Another reading of the answer may lose less than the likeliest one, whose cells are wrong.
        # For each row that is lost as a whole, it counts BESIDES; the row may be worth less.
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
    """The shares where everything is right, which most answers to a part have in common."""
    verdicts = [[Verdict.CORRECT] * len(row) for row in content.known]
    return _SHARES[marking](content, verdicts)[0]


def _by_content(content: Content, verdicts: _Verdicts) -> tuple[Shares, float]:
    """What one has to know, and the cost of a slip that no cell shows: that of a wrong cell.

    A wrong cell costs a unit, down to the worth of its group. A student's own frames may have more
    cells that are worth something than the reference's; a wrong cell costs no less for that.
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
    """The worth of a group's cells in each row, the wrong ones, and the rows with unread ones.

    A cell that was not read costs itself: a unit where one has to know something for it. The others
    of a row cost a fifth together. An empty cell of a table costs what a wrong one does.
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
        """Each row of the group, its worth and what it keeps."""
        kept = {row: max(0.0, units - self.lost_in(row)) for row, units in self.units.items()}
        # A row cannot lose more than it has; then the others lose the rest.
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
    """The worth of a group besides its cells that one has to know something for."""
    groups = len({number for row in content.groups for number in row})
    count = min(content.count, content.most or content.count)
    return min(BESIDES, MOST_BESIDES * count / groups) or BESIDES


def _by_cells(_content: Content, verdicts: _Verdicts) -> tuple[Shares, float]:
    """Each cell counts the same."""
    cells = sum(map(len, verdicts))
    right = [row.count(Verdict.CORRECT) for row in verdicts]
    shares = Shares([len(row) / cells for row in verdicts], [count / cells for count in right])
    return shares, 1 / len(verdicts)


def _by_rows(_content: Content, verdicts: _Verdicts) -> tuple[Shares, float]:
    """A row is right or not."""
    share = 1 / len(verdicts)
    return Shares([share] * len(verdicts), [share * _is_right(row) for row in verdicts]), share


def _as_a_whole(content: Content, verdicts: _Verdicts) -> tuple[Shares, float]:
    """All or nothing."""
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
    """The row with its points."""
    points = rounded_points(earned)
    verdict = row.verdict if points else _without_points(row.verdict, [row])
    return RowReport(row.label, verdict, points, rounded_points(possible), row.cells, row.feedback)


def _without_points(verdict: Verdict, rows: Sequence[RowReport]) -> Verdict:
    """The verdict on rows that earn nothing: nothing is partly right that earns nothing."""
    if verdict is not Verdict.PARTIAL:
        return verdict
    of_cells = {cell.verdict for row in rows for cell in row.cells}
    return combined(of_cells - {Verdict.CORRECT})
