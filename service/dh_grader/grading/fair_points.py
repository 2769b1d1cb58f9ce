"""Limit the points of a wrong table, so that an empty row never earns more than a wrong row.

A wrong row can mislead the search for the frames that the student chose. Then correct rows look
wrong. An empty row cannot mislead the search.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import takewhile

import numpy as np

from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.grading.frames.roles import usual_rows
from dh_grader.grading.frames.rows import FrameFreedom, freedom_of, reference_values
from dh_grader.grading.grading import Grading, Judged
from dh_grader.grading.judging_table import (
    empty_cells,
    with_empty_cells,
    with_wrong_cells,
    with_wrong_rows,
)
from dh_grader.grading.marks import least_lost, steps_lost
from dh_grader.grading.numbers import SAME_CONTENT
from dh_grader.grading.reading.table import StudentTable
from dh_grader.grading.report import Verdict
from dh_grader.kinematics import ALPHA, COLUMNS, A, Convention

# So a wrong table earns at least as much as the same table with one wrong row replaced by numbers
# that are wrong in all frames, and as the table without the wrong rows after the rows of all joints
# (there, empty rows are left out). A table with empty cells earns at most as much as the same table
# with such numbers in these cells.


# The most wrong cells that are looked for in all rows at once if nothing but the frames is free.
FEW = 2
# The work of judging a table with a row given up, as a share of that of a table with messages.
AGAIN = 0.5


@dataclass(frozen=True, slots=True)
class FairPoints:
    """Limits the points of a wrong table, so that empty rows never earn more than wrong rows.

    ``judged_again`` judges similar tables, whose points are the limits.
    """

    part: DhTableSpec
    judged_again: Callable[[StudentTable], Judged]
    # The work of judging a table with messages.
    work: float
    grading: Grading

    def limited(self, answer: StudentTable, judged: Judged) -> Judged:
        """Return ``judged``, the judgement of a wrong table, with limits on its points."""
        budget = self.grading.reader.budget
        unread = np.isnan(answer.values).any(axis=-1)
        if missing := _missing_at_end(self.part, answer, judged, self.grading):
            # A missing row counts as a wrong one.
            if judged.count_wrong == missing * len(COLUMNS):
                return judged
            budget.charge_search(self.work)
            full = with_wrong_rows(answer, missing, self.grading)
            fair = self.limited(full, self.judged_again(full))
            least = None if unread.any() else self._without_a_row(answer, judged, fair)
            return replace(judged, at_most=fair, at_least=least)
        # A table without any readable cell earns nothing anyway.
        if unread.all():
            return judged
        shorter = self._without_wrong_end(answer, judged)
        if not unread.any():
            best = judged if shorter is None else min(judged, shorter, key=self._lost)
            best = self._without_a_row(answer, judged, best)
            return judged if best is judged else replace(judged, at_least=best)
        empty = empty_cells(answer)
        if not empty.any():
            return judged if shorter is None else replace(judged, at_least=shorter)
        budget.charge_search(self.work)
        others = [self.judged_again(with_wrong_cells(answer, empty, self.grading))]
        others += [] if judged.at_most is None else [judged.at_most]
        return replace(judged, at_most=max(others, key=self._lost), at_least=shorter)

    def _without_a_row(self, answer: StudentTable, judged: Judged, best: Judged) -> Judged:
        """Return the best judgement of several.

        The candidates are ``best`` and the judgements of the table without one wrong row.
        """
        part, grading = self.part, self.grading
        counts = _counts_wrong(judged)
        # All tables that differ from the answer in as few cells, or in one row, have been compared.
        is_searched = _has_given_ends(part, judged) and (
            sum(counts) <= FEW or np.count_nonzero(counts) == 1
        )
        wrong = _wrong_rows(part, judged, len(answer.rows))
        for row, content in _content_in_any_frames(part, answer, wrong, grading):
            least = least_lost(part, judged, content)
            if self._lost(best) <= least or (content and is_searched):
                continue
            if not grading.reader.budget.affords_search(AGAIN * self.work):
                break
            cells = np.zeros(answer.values.shape[:2], np.bool_)
            cells[row] = True
            other = self.judged_again(with_wrong_cells(answer, cells, grading))
            if other.is_right:
                # The row may be anything, such as the last one if the tool is free.
                other = self.judged_again(with_empty_cells(answer, cells))
            best = min(best, other, key=self._lost)
        return best

    def _without_wrong_end(self, answer: StudentTable, judged: Judged) -> Judged | None:
        """Return the judgement of the table without its wrong last rows.

        Return None if there are no such rows, or if the table is right without them.
        """
        budget = self.grading.reader.budget
        shorter = _shortened(self.part, answer, judged, self.grading)
        if shorter is None or not budget.affords_search(AGAIN * self.work):
            return None
        other = self.judged_again(shorter)
        # Rows that belong to no right table must cost something.
        return None if other.is_right else self.limited(shorter, other)

    def _lost(self, judged: Judged) -> int:
        return steps_lost(self.part, judged)


def _missing_at_end(
    part: DhTableSpec, answer: StudentTable, judged: Judged, grading: Grading
) -> int:
    convention = _convention_of(part, answer)
    # The other convention may need fewer rows.
    if convention is None or part.frames == "given" or judged.whole_cost is not None:
        return 0
    missing = usual_rows(convention, grading) - len(answer.rows)
    after = [cell for row in judged.rows[len(answer.rows) :] for cell in row.cells]
    is_at_end = all(cell.verdict is Verdict.MISSING for cell in after)
    return missing if is_at_end and len(after) == missing * len(COLUMNS) else 0


def _shortened(
    part: DhTableSpec, answer: StudentTable, judged: Judged, grading: Grading
) -> StudentTable | None:
    """Return the table up to its first wrong row after the joints' rows; None if all are right."""
    robot = grading.exercise.robot
    rows, kept = len(answer.rows), len(robot.joints)
    counts = _counts_wrong(judged)
    if part.frames == "given" or part.tool != "given" or len(counts) != rows:
        return None
    if rows > len(part.asked_table(robot).rows) or answer.rows[-1].is_given_up:
        return None
    kept += sum(1 for _ in takewhile(lambda count: not count, counts[kept:]))
    if kept >= rows:
        return None
    return replace(answer, rows=answer.rows[:kept], values=answer.values[:kept])


def _convention_of(part: DhTableSpec, answer: StudentTable) -> Convention | None:
    return answer.convention if part.convention == "either" else part.convention


def _wrong_rows(part: DhTableSpec, judged: Judged, rows: int) -> list[int]:
    # Rows with the most wrong cells come first.
    if part.frames == "given":
        return []
    if judged.whole_cost is not None:
        # A slip in several rows is not cured by one empty row.
        if judged.beside is not None:
            judged = judged.beside
        elif np.count_nonzero(_counts_wrong(judged)) > FEW:
            return []
    if len(judged.rows) != rows:
        return list(range(rows))
    counts = _counts_wrong(judged)
    has_given_ends = _has_given_ends(part, judged)
    if has_given_ends and sum(counts) == 1:
        # The other rows determine this row.
        return []
    # If base, tool or directions are free, a wrong row may make another one look wrong.
    takes_all = not has_given_ends and sum(counts) > FEW
    return sorted((i for i in range(rows) if counts[i] or takes_all), key=lambda i: -counts[i])


def _counts_wrong(judged: Judged) -> list[int]:
    return [sum(c.verdict is not Verdict.CORRECT for c in row.cells) for row in judged.rows]


def _has_given_ends(part: DhTableSpec, judged: Judged) -> bool:
    return freedom_of(part) == FrameFreedom() and judged.at_most is None


def _content_in_any_frames(
    part: DhTableSpec, answer: StudentTable, rows: list[int], grading: Grading
) -> list[tuple[int, int]]:
    # Two cells of a row are not trivial in any frames: the angle between its two axes, unless they
    # are parallel; and their distance, unless one axis only has a direction.
    convention = _convention_of(part, answer)
    table = grading.exercise.robot.tables.get(convention) if convention else None
    if not rows or table is None or len(table.rows) != len(answer.rows):
        return [(i, 0) for i in rows]
    cells = reference_values(table, grading.samples)
    turned = np.abs(np.sin(cells[:, ALPHA])).min(axis=-1) > SAME_CONTENT
    apart = np.abs(cells[:, A]).min(axis=-1) > SAME_CONTENT * grading.exercise.length_scale
    has_base = part.base != "free"
    has_tool = part.tool != "free" and len(table.joints) == len(table.rows)
    # For each axis, whether it is a line or only a direction; None for base and tool.
    is_line = [None, *(not joint.prismatic for joint in table.joints), None]
    first = 0 if convention is Convention.MODIFIED else 1
    found = []
    for i in rows:
        between = is_line[i + first : i + first + 2]
        is_fixed = (
            len(between) == 2
            and (between[0] is not None or has_base)
            and (between[1] is not None or has_tool)
        )
        is_apart = apart[i] and False not in between
        found.append((i, int(is_fixed and turned[i]) + int(is_fixed and is_apart)))
    return found
