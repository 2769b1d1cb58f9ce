"""The points of a part: from the verdicts on its cells and what the cells are worth.

``docs/marks.md`` explains the rules to students and tutors, with an example.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from service.catalogue import PartSpec
from service.catalogue.fields import Marking
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

Right = Sequence[Sequence[bool]]


@dataclass(frozen=True, slots=True)
class Shares:
    """The share of the part's points that each row can earn, and that it earns."""

    possible: list[float]
    earned: list[float]

    def with_total(self, total: float) -> "Shares":
        """The same with another sum of what is earned: each row's loss or gain is scaled."""
        now = sum(self.earned)
        if total < now:
            return Shares(self.possible, [share * total / now for share in self.earned])
        lost = 1 - now
        kept = (1 - total) / lost if lost > 0 else 0.0
        pairs = zip(self.possible, self.earned, strict=True)
        return Shares(self.possible, [most - (most - share) * kept for most, share in pairs])


def part_report(part: PartSpec, judged: Judged) -> PartReport:
    """The report on a part that was judged, with the points of its rows."""
    shares = shares_of(judged, part.marking)
    rows = tuple(
        _with_points(row, possible * part.points, earned * part.points)
        for row, possible, earned in zip(judged.rows, shares.possible, shares.earned, strict=True)
    )
    verdicts = [row.verdict for row in judged.rows]
    points = rounded_points(sum(shares.earned) * part.points)
    verdict = combined(verdicts)
    if verdict is Verdict.CORRECT and judged.slips:
        verdict = Verdict.PARTIAL
    return PartReport(
        part=part.id,
        kind=part.kind,
        verdict=_with_none(verdict, verdicts) if not points else verdict,
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


def share_by_content(judged: Judged) -> float:
    """The share of its points, 0 to 1, that an answer earns by content."""
    return sum(shares_of(judged, "content").earned)


def shares_of(judged: Judged, marking: Marking) -> Shares:
    """The share of each row by a marking. Together they make 1 where everything is right."""
    right = [[cell.verdict is Verdict.CORRECT for cell in row.cells] for row in judged.rows]
    shares, slip_cost = _SHARES[marking](judged.content, right)
    total = sum(shares.earned) - slip_cost * judged.slips
    if judged.whole_cost is not None and marking != "whole":
        total = max(total, 1 - judged.whole_cost)
    if judged.without_extra is not None:
        total = min(total, sum(shares_of(judged.without_extra, marking).earned))
    if judged.stands_still:
        total = 0.0
    return shares.with_total(max(0.0, total))


def _by_content(content: Content, right: Right) -> tuple[Shares, float]:
    """What one has to know, and the cost of a slip that no cell shows: that of a wrong cell.

    A wrong cell costs a unit, down to the worth of its group. A student's own frames may have more
    cells that are worth something than the reference's; a wrong cell costs no less for that.
    """
    groups = _groups_of(content, right)
    worth = sum(group.worth for group in groups)
    lost = sum(group.lost for group in groups)
    possible, earned = [0.0] * len(right), [0.0] * len(right)
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
    """The worth of a group's cells in each row, and how many of them are wrong."""

    units: dict[int, float]
    wrong: dict[int, int]

    @property
    def worth(self) -> float:
        return sum(self.units.values())

    @property
    def lost(self) -> float:
        return min(self.worth, sum(self.wrong.values()))

    def by_row(self) -> Iterator[tuple[int, float, float]]:
        """Each row of the group, its worth and what it keeps."""
        kept = {row: max(0.0, self.units[row] - self.wrong[row]) for row in self.units}
        # A row cannot lose more than it has; then the others lose the rest.
        factor = (self.worth - self.lost) / (sum(kept.values()) or 1.0)
        for row, units in self.units.items():
            yield row, units, kept[row] * factor


def _groups_of(content: Content, right: Right) -> list[_Group]:
    groups: dict[int, _Group] = {}
    rows = zip(content.known, content.groups, right, strict=True)
    for i, cells in enumerate(rows):
        for known, number, is_right in zip(*cells, strict=True):
            group = groups.setdefault(number, _Group({}, {}))
            group.units[i] = group.units.get(i, 0.0) + known
            group.wrong[i] = group.wrong.get(i, 0) + (not is_right)
    if content.besides:
        most = MOST_BESIDES * content.count / len(groups)
        besides = min(BESIDES, most) or BESIDES
        for group in groups.values():
            for row in group.units:
                group.units[row] += besides / len(group.units)
    return list(groups.values())


def _by_cells(_content: Content, right: Right) -> tuple[Shares, float]:
    """Each cell counts the same."""
    cells = sum(map(len, right))
    shares = Shares([len(row) / cells for row in right], [sum(row) / cells for row in right])
    return shares, 1 / len(right)


def _by_rows(_content: Content, right: Right) -> tuple[Shares, float]:
    """A row is right or not."""
    share = 1 / len(right)
    return Shares([share] * len(right), [share * all(row) for row in right]), share


def _as_a_whole(content: Content, right: Right) -> tuple[Shares, float]:
    """All or nothing."""
    shares, _ = _by_content(content, right)
    return shares.with_total(float(all(map(all, right)))), 1.0


_SHARES: Final[Mapping[Marking, Callable[[Content, Right], tuple[Shares, float]]]] = {
    "content": _by_content,
    "cells": _by_cells,
    "rows": _by_rows,
    "whole": _as_a_whole,
}


def _with_points(row: RowReport, possible: float, earned: float) -> RowReport:
    """The row with its points."""
    points = rounded_points(earned)
    verdict = row.verdict
    if not points:
        verdict = _with_none(verdict, [cell.verdict for cell in row.cells])
    return RowReport(row.label, verdict, points, rounded_points(possible), row.cells, row.feedback)


def _with_none(verdict: Verdict, of_pieces: Sequence[Verdict]) -> Verdict:
    """The verdict on something without points: nothing is partly right that earns nothing."""
    if verdict is not Verdict.PARTIAL:
        return verdict
    return combined(piece for piece in of_pieces if piece not in (Verdict.CORRECT, Verdict.PARTIAL))
