"""Count the points of a part from the verdicts on its cells, and marks for what follows.

Here points are shared among rows and cells, and rounded. Which cells are wrong is decided in
``judging.py`` and ``judging_table.py``; how a loss is told, in ``report.py``.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Final

import numpy as np

from dh_grader.catalogue import PartSpec
from dh_grader.catalogue.schema_fields import Marking
from dh_grader.expressions import Kind
from dh_grader.grading.judging import Content, Grading, Judged, StudentChain
from dh_grader.grading.numbers import (
    HALF,
    MOVES,
    NO_MOTION,
    NOT_RIGID,
    SAME_AXIS,
    SAMPLES,
    Samples,
    changes,
)
from dh_grader.grading.report import (
    ALL_OR_NOTHING,
    CELLS,
    NO_ANSWER,
    NO_JOINT_MOVES,
    NOT_READ,
    OUTSIDE,
    SHARED,
    WHOLE,
    Feedback,
    Finding,
    LittleWorth,
    LostPoints,
    PartReport,
    RowReport,
    Severity,
    Verdict,
    combined,
    little_worth,
    lost_in_row,
    lost_points,
    rounded_points,
)
from dh_grader.kinematics import (
    Matrices,
    Numbers,
    exponential,
    inverse,
    is_rigid,
    rank,
    sliding_axis,
    turning_axis,
)
from dh_grader.translations import say

# --- The points that each cell of an answer is worth
#
# Points are counted in steps: quarters or hundredths of a point. ``docs/marks.md`` explains the
# rules.


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

    ``cells`` ``(rows, cells)`` is the worth of each cell, ``besides`` ``(rows,)`` that of each row
    in addition to its cells; all of them sum to ``total``. A cell that needs no knowledge is worth
    nothing, but costs ``unit`` if it is wrong. If ``is_fixed`` is true, every wrong cell costs
    ``unit``. ``slip`` is the cost of a mistake that no cell shows. ``least_besides`` is the
    smallest worth that a group of cells has besides its cells.
    """

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
    """Return whole numbers in proportion to ``weights`` that sum to ``total``.

    The largest remainders are rounded up. If ``total`` is at most the sum of the weights, no number
    is larger than its weight.
    """
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


# --- The points that a judged answer has lost, and its report


# The verdicts on the cells of each row.
_Verdicts = Sequence[Sequence[Verdict]]


@dataclass(frozen=True, slots=True)
class _Loss:
    """The steps lost in one row, or in the whole answer if ``row`` is None."""

    code: str
    steps: int
    row: int | None = None


@dataclass(frozen=True, slots=True)
class _Marks:
    """The loss of an answer, and of each of its rows, in steps."""

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

    Only cells that need knowledge count. A rotation with a position must have earned more than
    ``share``, because later parts that need only a correct rotation are easy.
    """
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


# --- Marks for what follows from an earlier answer
#
# If the answer to a part is wrong, it is also judged by the student's earlier answer instead of the
# reference. The earlier answer must be good enough, so that a trivial table does not earn easy
# points later.


# The step by which a joint is moved, in radians or in the exercise's typical length.
STEPS = (0.4, 1.1)

ToolAt = Callable[[Samples], Matrices]


def can_carry(chain: StudentChain, grading: Grading) -> bool:
    """True if later answers may be judged by this answer instead of by the reference solution.

    The answer must be an arm with the joints and the degrees of freedom of the robot: a rigid
    chain, each joint of which turns about, or slides along, one axis by its own variable. Other
    arms may make later parts much easier.
    """
    robot = grading.exercise.reference
    if robot is None or not is_rigid(chain.frames, NOT_RIGID).all():
        return False
    student = _jacobian(chain.tool_at, grading)
    reference = _jacobian(lambda samples: robot.frame("tool", samples.values, SAMPLES), grading)
    if student is None or reference is None:
        return False
    return rank(student, NO_MOTION) >= rank(reference, NO_MOTION)


def _jacobian(tool_at: ToolAt, grading: Grading) -> Numbers | None:
    # The axes of all joints, (HALF, 6, joints); the unit is the typical length. None if a joint
    # does not turn about, or slide along, one axis.
    found = []
    for i in range(len(grading.exercise.joints)):
        # An axis depends neither on its own joint's variable nor on those of later joints.
        near, far = (_axis(tool_at, i, step, grading, later=step is STEPS[1]) for step in STEPS)
        if near is None or far is None or np.abs(near - far).max() > SAME_AXIS:
            return None
        found.append(near)
    return np.stack(found, axis=-1)


def _axis(tool_at: ToolAt, i: int, step: float, grading: Grading, *, later: bool) -> Numbers | None:
    # The axis (HALF, 6) of joint i in the base frame. None if a small motion of the joint does not
    # move the tool about or along one axis. With ``later``, the later joints have other values.
    scale, joints = grading.exercise.length_scale, grading.exercise.joints
    values = {name: np.tile(numbers[:HALF], 2) for name, numbers in grading.samples.values.items()}
    for joint in joints[i + 1 :] if later else ():
        values[joint.variable] = np.tile(grading.samples.values[joint.variable][HALF:], 2)
    prismatic = joints[i].prismatic
    values[joints[i].variable][HALF:] += step * scale if prismatic else step
    poses = tool_at(Samples(values)).copy()
    poses[:, :3, 3] /= scale
    displacement = poses[HALF:] @ inverse(poses[:HALF])
    axis = sliding_axis(displacement, step) if prismatic else turning_axis(displacement, step)
    error = np.abs(exponential(axis, step) - displacement).max()
    length = np.linalg.norm(axis[:, 3:] if prismatic else axis[:, :3], axis=-1)
    # NaN fails this comparison.
    return axis if max(error, np.abs(length - 1).max()) < SAME_AXIS else None


def stands_still(
    values: Numbers, quantities: Sequence[Kind] | Sequence[Sequence[Kind]], grading: Grading
) -> bool:
    """True if no joint changes any entry ``(rows, columns, SAMPLES)`` of an answer.

    ``quantities`` are the quantities of the columns, or of all entries. An answer with an
    unreadable entry (NaN) counts as moving.
    """
    scales = np.where(np.array(quantities) == "length", grading.exercise.length_scale, 1.0)
    motion = np.abs(changes(values)).max(axis=-1)
    return bool(np.isfinite(motion).all() and (motion < MOVES * scales).all())


STANDS_STILL = Finding(
    "no_joint_variable",
    say(
        "No joint variable has any effect in this answer, so it describes an arm that cannot move: "
        "it earns nothing."
    ),
)


def follows_from(earlier: PartSpec, *, is_right: bool) -> Finding:
    """Return the message that an answer was graded on the basis of an earlier answer.

    The earlier answer ``is_right`` if it differs from the reference only by its choice of frames or
    by rounding.
    """
    title = repr(earlier.title)
    if is_right:
        hint = say("This was graded by your answer to {part}, which is right.", part=title)
    else:
        hint = say(
            "This earns its points, for it follows from your answer to {part}. That answer is "
            "wrong: check it first.",
            part=title,
        )
    return Finding("follow_through", hint, severity=Severity.INFO)
