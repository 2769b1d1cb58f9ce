"""The difficulty of a generated robot, and what a student can practise with it."""

from dataclasses import dataclass
from enum import StrEnum

from service.variants.robots.level import Relation
from service.variants.robots.plan import Plan


class Situation(StrEnum):
    """A feature of a robot that a student may want to practise."""

    OFFSET = "offset"
    """A row with a length along its axis and one between the axes, or two axes that are skew."""
    SLIDING = "sliding"
    """A joint that slides."""
    PARALLEL = "parallel"
    """Two parallel axes in a row."""
    TURNED = "turned"
    """A row with a constant angle beside the joint variable."""


@dataclass(frozen=True, slots=True)
class Difficulty:
    """Counts of what makes a robot difficult.

    ``turns`` counts the changes of direction from one axis to the next. ``choices`` counts the rows
    with a free choice of frame (parallel axes, sliding joints). ``odd`` counts the twists of 30°,
    45° or 60°.
    """

    joints: int
    turns: int
    offsets: int
    sliding: int
    choices: int
    odd: int

    @property
    def total(self) -> int:
        """The difficulty as one number."""
        # It is the sum of the counts, in which odd twists and joints count twice.
        once = self.turns + self.offsets + self.sliding + self.choices
        return 2 * (self.joints + self.odd) + once


def difficulty(plan: Plan) -> Difficulty:
    """Return the difficulty of a robot."""
    rows = plan.rows
    return Difficulty(
        joints=len(rows),
        turns=sum(bool(row.alpha % 180) for row in rows),
        offsets=sum(bool(row.a and (row.d or row.alpha % 180)) for row in rows),
        sliding=sum(row.sliding for row in rows),
        choices=sum(row.sliding or bool(row.relation and not row.alpha % 180) for row in rows),
        odd=sum(bool(row.alpha % 90) for row in rows),
    )


def situations(plan: Plan) -> set[Situation]:
    """Return the features of a robot that a student may want to practise."""
    found = set()
    for row in plan.rows:
        if row.a and (row.d or row.relation is Relation.SKEW):
            found.add(Situation.OFFSET)
        if row.sliding:
            found.add(Situation.SLIDING)
        if row.relation in (Relation.PARALLEL, Relation.ANTIPARALLEL):
            found.add(Situation.PARALLEL)
        if row.theta:
            found.add(Situation.TURNED)
    return found
