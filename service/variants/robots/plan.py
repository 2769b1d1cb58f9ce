"""Choose a random robot: its joints, the relations of their axes, and the lengths."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from service.variants.robots.draws import Draws
from service.variants.robots.geometry.skeleton import AxisDirection, Skeleton, cross, turn
from service.variants.robots.level import Grammar, Relation

# Centimetres. No two lengths of a robot are equal.
_LENGTHS: Final = tuple(range(20, 62, 2))
_PARALLEL: Final = {Relation.PARALLEL, Relation.ANTIPARALLEL, Relation.COLLINEAR}
_AT_A_DISTANCE: Final = {Relation.PARALLEL, Relation.ANTIPARALLEL, Relation.SKEW}
# Two twists about one line that lead back to the axes of the base frame.
_ODD: Final = (
    (30, 60),
    (60, 30),
    (45, 45),
    (30, -30),
    (60, -60),
    (45, -45),
    (60, -150),
    (30, -120),
)


@dataclass(frozen=True, slots=True)
class PlannedRow:
    """A row of the standard DH table: lengths in centimetres, angles in degrees.

    ``relation`` is the relation of the joint's axis to the next axis; None in the last row.
    """

    # A sliding joint moves by its variable in addition to ``d``.

    sliding: bool
    relation: Relation | None
    a: int
    alpha: int
    d: int
    theta: int


@dataclass(frozen=True, slots=True)
class Plan:
    """A random robot, which may still be refused.

    ``letters`` is True if its lengths are letters, and False if they are numbers.
    """

    rows: tuple[PlannedRow, ...]
    letters: bool

    @property
    def structure(self) -> str:
        """A letter for each joint, such as "RRP"."""
        return "".join("P" if row.sliding else "R" for row in self.rows)


def plan(level: Grammar, draws: Draws) -> Plan | None:
    """Return a random robot of a level, or None if the random features do not fit together."""
    count = draws.weighted(level.joints)
    kinds = [draws.chance(level.sliding) for _ in range(count)]
    if sum(kinds) > level.most_sliding:
        return None
    relations = _relations(level, kinds, draws)
    if relations is None:
        return None
    lengths = _Lengths(draws)
    rows: list[PlannedRow] = []
    owed: int | None = None
    for i, relation in enumerate(relations):
        if owed is not None:
            rows.append(_row_back(owed, draws, lengths, sliding=kinds[i]))
            owed = None
            continue
        alpha = _twist(relation, draws)
        if relation is Relation.OBLIQUE:
            first, second = draws.one_of(_ODD)
            sign = draws.one_of((1, -1))
            alpha, owed = sign * first, sign * second
        far = relation in _AT_A_DISTANCE or (relation is Relation.OBLIQUE and draws.chance(40))
        a = lengths.next() if far else 0
        d = lengths.next() if _has_offset(level, draws, sliding=kinds[i]) else 0
        rows.append(PlannedRow(kinds[i], relation, a, alpha, d, _turn(level, draws)))
    aside, along = _tool_place(draws, sliding=kinds[-1])
    alpha = draws.one_of((90, -90)) if draws.chance(level.bent_tool) else 0
    theta = _turn(level, draws) if draws.chance(60) else 0
    rows.append(_last_row(lengths, kinds[-1], (aside, along), alpha, theta))
    return Plan(tuple(rows), letters=not draws.chance(level.numbers))


def plan_along(shape: Skeleton, level: Grammar, draws: Draws) -> Plan | None:
    """Return a random robot whose axes have given directions, or None."""
    # None if the draws contradict the directions.
    lengths = _Lengths(draws)
    x: AxisDirection = (1, 0, 0)
    z: AxisDirection = (0, 0, 1)
    rows: list[PlannedRow] = []
    for i, heading in enumerate(shape.headings):
        both: Sequence[Relation] = (Relation.PARALLEL, Relation.COLLINEAR)
        if heading != z:
            both = (Relation.CROSSING, Relation.SKEW)
        elif shape.sliding[i] == shape.sliding[i + 1]:
            both = (Relation.PARALLEL,)
        relation = draws.weighted([(each, level.relations.get(each, 0)) for each in both])
        if heading == z:
            theta, alpha = _turn(level, draws), 0
        else:
            ways = [
                (turn(x, cross(z, heading), z), 90),
                (turn(x, cross(heading, z), z), -90),
            ]
            # Where the axes meet, both are right: the simpler one is as good.
            theta, alpha = draws.one_of(ways) if relation is Relation.SKEW else min(ways, key=_cost)
        a = lengths.next() if relation in _AT_A_DISTANCE else 0
        d = lengths.next() if _has_offset(level, draws, sliding=shape.sliding[i]) else 0
        rows.append(PlannedRow(shape.sliding[i], relation, a, alpha, d, theta))
        x, z = _about(z, x, theta), heading
    aside, along = _tool_place(draws, sliding=shape.sliding[-1])
    if not shape.sliding[-1]:
        aside, along = shape.beside, along or not shape.beside
    place = aside, along
    rows.append(_last_row(lengths, shape.sliding[-1], place, 0, turn(x, shape.tool_x, z)))
    return Plan(tuple(rows), letters=not draws.chance(level.numbers))


def _cost(way: tuple[int, int]) -> tuple[int, bool]:
    theta, alpha = way
    return abs(theta), alpha < 0


def _about(z: AxisDirection, x: AxisDirection, degrees: int) -> AxisDirection:
    for _ in range(degrees // 90 % 4):
        x = cross(z, x)
    return x


def _has_offset(level: Grammar, draws: Draws, *, sliding: bool) -> bool:
    return draws.chance(level.offset // (4 if sliding else 1))


def _row_back(owed: int, draws: Draws, lengths: "_Lengths", *, sliding: bool) -> PlannedRow:
    theta = draws.one_of((0, 0, 180))
    alpha = owed if theta == 0 else -owed
    a = lengths.next() if draws.chance(30) else 0
    return PlannedRow(sliding, Relation.OBLIQUE, a, _within(alpha), 0, theta)


def _relations(level: Grammar, kinds: Sequence[bool], draws: Draws) -> list[Relation] | None:
    # Return the relation of each axis to the next axis, or None if the draws do not fit.
    # Oblique relations come in pairs: the second relation leads back.
    relations: list[Relation] = []
    pairs = 0
    for i in range(len(kinds) - 1):
        if relations and relations[-1] is Relation.OBLIQUE and pairs % 2:
            relations.append(Relation.OBLIQUE)
            pairs += 1
            continue
        relation = draws.weighted([*level.relations.items()])
        both_slide = kinds[i] and kinds[i + 1]
        if both_slide and relation in _PARALLEL:
            return None
        if relation is Relation.COLLINEAR and kinds[i] == kinds[i + 1]:
            return None
        if relation is Relation.OBLIQUE:
            if i + 2 >= len(kinds):
                return None
            pairs += 1
        relations.append(relation)
    return relations if pairs >= 2 * level.oblique else None


def _twist(relation: Relation, draws: Draws) -> int:
    if relation in (Relation.CROSSING, Relation.SKEW):
        return draws.one_of((90, -90))
    return 180 if relation is Relation.ANTIPARALLEL else 0


def _turn(level: Grammar, draws: Draws) -> int:
    return draws.one_of((90, 90, -90, -90, 180)) if draws.chance(level.turned) else 0


def _tool_place(draws: Draws, *, sliding: bool) -> tuple[bool, bool]:
    if sliding:
        return draws.weighted([((False, False), 60), ((True, False), 25), ((False, True), 15)])
    return draws.weighted([((True, False), 55), ((False, True), 35), ((True, True), 10)])


def _last_row(
    lengths: "_Lengths", sliding: bool, place: tuple[bool, bool], alpha: int, theta: int
) -> PlannedRow:
    aside, along = place
    a = lengths.next() if aside else 0
    d = lengths.next() if along else 0
    return PlannedRow(sliding, None, a, alpha, d, theta)


def _within(angle: int) -> int:
    return 180 - (180 - angle) % 360


class _Lengths:
    def __init__(self, draws: Draws) -> None:
        self._draws = draws
        self._left = list(_LENGTHS)

    def next(self) -> int:
        """Return a length that was not returned before."""
        return self._left.pop(self._draws.below(len(self._left)))
