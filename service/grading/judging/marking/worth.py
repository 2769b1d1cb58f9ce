"""The points of each cell of an answer, in quarters or hundredths of a point.

Such a quarter or hundredth is called a step. ``docs/marks.md`` explains the rules.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Final

from service.catalogue.files.fields import Marking
from service.grading.part import Content

# The worth in units that a group of cells has besides its content cells, which count 1 each. For
# all groups together it is at most a third of the content cells, so that a lazy answer earns at
# most a quarter.
BESIDES: Final = 0.2
MOST_BESIDES: Final = 1 / 3
QUARTER: Final = 0.25
HUNDREDTHS: Final = 100
# The points for each row, and for each content cell, from which points come in quarters.
POINTS_PER_ROW: Final = 2
POINTS_PER_CELL: Final = 1
# The rounding error that points may have.
_ROUNDING_ERROR: Final = 1e-9


@dataclass(frozen=True)
class CellWorth:
    """The points of the cells and rows of an answer, in steps of ``step`` points.

    A step is a quarter or a hundredth of a point.
    """

    # ``cells`` ``(rows, cells)`` is the worth of each cell, ``besides`` ``(rows,)`` that of each
    # row in addition to its cells; all of them sum to ``total``. A cell that needs no knowledge is
    # worth nothing, but costs ``unit`` if it is wrong. If ``is_fixed`` is true, every wrong cell
    # costs ``unit``. ``slip`` is the cost of a mistake that no cell shows. ``least_besides`` is the
    # smallest worth that a group of cells has besides its cells.
    step: float
    total: int
    content: Content
    cells: tuple[tuple[int, ...], ...]
    besides: tuple[int, ...]
    unit: int
    slip: int
    is_fixed: bool = False
    least_besides: int = 0

    @property
    def counted(self) -> int:
        """The number of cells that earn points."""
        return (self.is_fixed and self.content.most) or self.content.count

    @cached_property
    def rows(self) -> tuple[int, ...]:
        """The points of each row, in steps."""
        return tuple(sum(row) + more for row, more in zip(self.cells, self.besides, strict=True))

    @cached_property
    def groups(self) -> dict[int, int]:
        """The largest loss of each group of cells, in quarters or hundredths of a point."""
        if self.is_fixed:
            counts = _counts(self.content)
            return {g: max(1, n * self.unit + self.least_besides) for g, n in counts.items()}
        worth = dict.fromkeys(_counts(self.content), 0)
        for cells, numbers in zip(self.cells, self.content.groups, strict=True):
            for cell, number in zip(cells, numbers, strict=True):
                worth[number] += cell
        if self.content.besides:
            # All cells of a row are in one group.
            for more, numbers in zip(self.besides, self.content.groups, strict=True):
                worth[numbers[0]] += more
        return {number: max(1, steps) for number, steps in worth.items()}

    @cached_property
    def units(self) -> dict[int, int]:
        """For each group, the cost of a wrong cell whose right entry needs no knowledge."""
        units = dict.fromkeys(self.groups, self.unit)
        if not self.is_fixed:
            least: dict[int, int] = {}
            for cells, numbers in zip(self.cells, self.content.groups, strict=True):
                for cell, number in zip(cells, numbers, strict=True):
                    if cell:
                        least[number] = min(cell, least.get(number, cell))
            units |= least
        return units

    def fifth(self, group: int) -> int:
        """Return the cost of a row's unreadable cells that need no knowledge."""
        return max(1, round(self.units[group] * BESIDES))

    def points(self, steps: int) -> float:
        """Convert a number of steps (quarters or hundredths of a point) to points."""
        return steps * self.step


@lru_cache(maxsize=2048)
def worth_of(content: Content, marking: Marking, points: float) -> CellWorth:
    """Return the points of each cell in a part that is worth ``points``."""
    step, total = _steps(content, points)
    if marking == "content" or marking == "whole":
        return _by_content(content, step, total)
    earning = content.earning
    rows, sharing = len(content.known), sum(earning)
    slip = max(1, total // sharing)
    if marking == "rows":
        shares = iter(evenly(total, sharing))
        worth = tuple(next(shares) if earns else 0 for earns in earning)
        cells = tuple((0,) * len(row) for row in content.known)
        return CellWorth(step, total, content, cells, worth, slip, slip)
    all_known = tuple(
        (earns,) * len(row) for earns, row in zip(earning, content.known, strict=True)
    )
    equal = Content(all_known, tuple((0,) * len(row) for row in content.known))
    cells = _cells(equal, evenly(total, equal.count))
    return CellWorth(step, total, equal, cells, (0,) * rows, max(1, total // equal.count), slip)


def _steps(content: Content, points: float) -> tuple[float, int]:
    # Neither the size of a step nor their number depends on the answer.
    rows, cells = content.usual or (sum(content.earning), content.most or content.count)
    is_coarse = points >= max(POINTS_PER_ROW * rows, POINTS_PER_CELL * cells)
    quarters = round(points / QUARTER)
    if is_coarse and abs(points - quarters * QUARTER) < _ROUNDING_ERROR:
        return QUARTER, quarters
    total = max(1, round(points * HUNDREDTHS))
    return points / total, total


def _by_content(content: Content, step: float, total: int) -> CellWorth:
    rows = len(content.known)
    counts = _counts(content)
    if content.equal:
        shares = dict(zip(counts, evenly(total, len(counts)), strict=True))
        parts = {group: iter(evenly(shares[group], n)) for group, n in counts.items()}
        cells = tuple(
            tuple(next(parts[g]) if known else 0 for known, g in zip(row, groups, strict=True))
            for row, groups in zip(content.known, content.groups, strict=True)
        )
        unit = max(1, total // content.count)
        return CellWorth(step, total, content, cells, (0,) * rows, unit, unit)
    # A student's own choices may need more content cells than the reference's; that does not
    # reduce the cost of a wrong cell.
    is_fixed = content.most is not None and content.count > content.most
    if not content.besides:
        cells = _cells(content, evenly(total, content.count))
        # Rounded up, so that an answer with as many mistakes as the reference has cells earns 0.
        unit = -(-total // max(1, content.most or 0)) if is_fixed else total // content.count
        unit = max(1, unit)
        return CellWorth(step, total, content, cells, (0,) * rows, unit, unit, is_fixed)
    unit = _unit(content.count, len(counts), total)
    left = total - unit * content.count
    if left < 0:
        cells = _cells(content, evenly(total, content.count))
        left = 0
    else:
        cells = _cells(content, [unit] * content.count)
    groups = evenly(left, len(counts))
    besides = [0] * rows
    for share, number in zip(groups, counts, strict=True):
        members = [
            i for i, row in enumerate(content.groups) if row[0] == number and content.earning[i]
        ]
        for i, steps in zip(members, evenly(share, len(members)), strict=True):
            besides[i] = steps
    if is_fixed:
        unit = _unit(content.most or 0, len(counts), total)
        groups = evenly(max(0, total - unit * (content.most or 0)), len(counts))
    return CellWorth(step, total, content, cells, tuple(besides), unit, unit, is_fixed, min(groups))


def _unit(cells: int, groups: int, total: int) -> int:
    # The remaining steps are shared by the ``groups``; an answer without knowledge earns them. They
    # are at most a quarter of all steps and, if possible, at least one for each group.
    if not cells:
        return total
    exact = total / (cells + groups * min(BESIDES, MOST_BESIDES * cells / groups))
    least = -(-3 * total // (4 * cells))
    most = max(least, (total - groups) // cells)
    return min(max(round(exact), least), most)


def evenly(total: int, count: int) -> list[int]:
    """Return ``count`` whole numbers that sum to ``total`` and differ by at most 1."""
    ends = [-(-i * total // count) for i in range(count + 1)]
    return [end - start for start, end in pairwise(ends)]


def apportioned(total: int, weights: list[int]) -> list[int]:
    """Return whole numbers in proportion to ``weights`` that sum to ``total``."""
    # The largest remainders are rounded up. If ``total`` is at most the sum of the weights, no
    # number is larger than its weight.
    whole = sum(weights)
    if not whole:
        return [0] * len(weights)
    found = [total * weight // whole for weight in weights]
    by_remainder = sorted(range(len(weights)), key=lambda i: -(total * weights[i] % whole))
    for i in by_remainder[: total - sum(found)]:
        found[i] += 1
    return found


def _cells(content: Content, worth: list[int]) -> tuple[tuple[int, ...], ...]:
    steps = iter(worth)
    return tuple(tuple(next(steps) if known else 0 for known in row) for row in content.known)


def _counts(content: Content) -> dict[int, int]:
    counts: dict[int, int] = {}
    for row, groups in zip(content.known, content.groups, strict=True):
        for known, number in zip(row, groups, strict=True):
            counts[number] = counts.get(number, 0) + known
    return counts
