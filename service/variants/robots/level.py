"""The four levels of generated robots: which joint axes they have, and how often."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Final


class Relation(StrEnum):
    """The relation of a joint axis to the next joint axis, such as parallel."""

    PARALLEL = "parallel"
    """Parallel, at a distance."""
    ANTIPARALLEL = "antiparallel"
    """Parallel at a distance, with the opposite direction."""
    COLLINEAR = "collinear"
    """One axis on which a joint slides and another one turns."""
    CROSSING = "crossing"
    """The axes meet at a right angle."""
    SKEW = "skew"
    """At a right angle, with an offset."""
    OBLIQUE = "oblique"
    """At 30°, 45° or 60°, meeting or with an offset."""


@dataclass(frozen=True, slots=True)
class Grammar:
    """The weights and percentages for choosing random robots of a level."""

    # ``joints`` and ``relations`` have the weight of each choice. ``sliding`` is the percentage of
    # sliding joints, and ``most_sliding`` is the greatest number of sliding joints. The other
    # percentages are ``turned`` for rows with a constant angle, ``offset`` for rows with a length
    # along the axis, ``numbers`` for robots with numbers as lengths, and ``bent_tool`` for tool
    # frames that are turned about x. ``oblique`` is the least number of pairs of odd twists.

    joints: Sequence[tuple[int, int]]
    relations: Mapping[Relation, int]
    sliding: int
    most_sliding: int
    turned: int
    offset: int
    numbers: int
    bent_tool: int = 0
    oblique: int = 0


LEVELS: Final[Mapping[int, Grammar]] = {
    1: Grammar(
        joints=[(2, 2), (3, 8)],
        relations={Relation.PARALLEL: 40, Relation.CROSSING: 45, Relation.COLLINEAR: 15},
        sliding=30,
        most_sliding=2,
        turned=30,
        offset=45,
        numbers=0,
    ),
    2: Grammar(
        joints=[(3, 5), (4, 5)],
        relations={
            Relation.PARALLEL: 30,
            Relation.CROSSING: 35,
            Relation.SKEW: 25,
            Relation.COLLINEAR: 10,
        },
        sliding=28,
        most_sliding=2,
        turned=35,
        offset=50,
        numbers=25,
    ),
    3: Grammar(
        joints=[(4, 3), (5, 4), (6, 3)],
        relations={
            Relation.PARALLEL: 25,
            Relation.ANTIPARALLEL: 10,
            Relation.CROSSING: 35,
            Relation.SKEW: 25,
            Relation.COLLINEAR: 5,
        },
        sliding=22,
        most_sliding=2,
        turned=40,
        offset=50,
        numbers=30,
        bent_tool=15,
    ),
    4: Grammar(
        joints=[(5, 3), (6, 5), (7, 2)],
        relations={
            Relation.PARALLEL: 18,
            Relation.ANTIPARALLEL: 9,
            Relation.CROSSING: 35,
            Relation.SKEW: 20,
            Relation.COLLINEAR: 4,
            Relation.OBLIQUE: 14,
        },
        sliding=18,
        most_sliding=2,
        turned=45,
        offset=55,
        numbers=30,
        bent_tool=20,
        oblique=1,
    ),
}
