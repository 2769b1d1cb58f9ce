"""The geometry of generated robots: levels, axes, lengths, paths, and reasons to refuse."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import cache
from hashlib import sha256
from itertools import combinations, count, pairwise, product
from math import gcd
from typing import Final, TypeVar

import numpy as np

from dh_grader.kinematics import ALPHA, THETA, A, Convention, D, Table, rank, space_jacobian

# --- The four levels of generated robots: which joint axes they have, and how often


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


# --- The axis directions of simple robots, determined by the robot's number
#
# There are few simple robots: of 500 random robots, 100 are like an earlier robot. So the number of
# a simple robot determines its directions, and only the rest is random.


AxisDirection = tuple[int, int, int]
_AXES: Final[tuple[AxisDirection, ...]] = (
    (1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, -1, 0), (0, 0, -1),
)  # fmt: skip
# A step through all numbers, which leads far from similar ones.
_STEP: Final = 377
# How far to go if some directions make no robot. It has no divisor in common with the number of
# all directions of a level, and the first 500 seeds get different robots with it.
DIFFERENT: Final = 711


@dataclass(frozen=True, slots=True)
class Skeleton:
    """The joints of a robot, and the directions of its axes and of the tool's x axis."""

    # The directions of the axes 2 to n, at home. ``beside`` is True if the tool is not on the last
    # axis.

    sliding: tuple[bool, ...]
    headings: tuple[AxisDirection, ...]
    tool_x: AxisDirection
    beside: bool


def skeleton(level: Grammar, number: int) -> Skeleton | None:
    """Return the skeleton (joints and axis directions) with this number, or None."""
    # Numbers after the last skeleton repeat the skeletons. None if two consecutive sliding joints
    # would be parallel.
    sizes = _sizes(level)
    total = sum(size for _, size in sizes)
    step = next(each for each in range(_STEP, total + _STEP) if gcd(each, total) == 1)
    left = number * step % total
    for sliding, size in sizes:
        if left < size:
            return _decoded(sliding, left)
        left -= size
    raise AssertionError("the sizes add up to more than their sum")


@cache
def _patterns(joints: int, most_sliding: int) -> tuple[tuple[bool, ...], ...]:
    return tuple(
        each for each in product((False, True), repeat=joints) if sum(each) <= most_sliding
    )


def _sizes(level: Grammar) -> list[tuple[tuple[bool, ...], int]]:
    return [
        (sliding, 5 ** (joints - 1) * 4 * (1 if sliding[-1] else 2))
        for joints, _ in level.joints
        for sliding in _patterns(joints, level.most_sliding)
    ]


def _decoded(sliding: tuple[bool, ...], left: int) -> Skeleton | None:
    headings: list[AxisDirection] = []
    here: AxisDirection = (0, 0, 1)
    for i in range(1, len(sliding)):
        left, digit = divmod(left, 5)
        if digit == 4:
            if sliding[i - 1] and sliding[i]:
                return None
        else:
            here = perpendicular(here)[digit]
        headings.append(here)
    left, digit = divmod(left, 4)
    return Skeleton(sliding, tuple(headings), perpendicular(here)[digit], beside=bool(left))


def perpendicular(direction: AxisDirection) -> list[AxisDirection]:
    """Return the four directions perpendicular to ``direction``, in a fixed order."""
    return [each for each in _AXES if not any(a * b for a, b in zip(each, direction, strict=True))]


def cross(first: AxisDirection, second: AxisDirection) -> AxisDirection:
    """Return the vector product of two directions."""
    a, b, c = first
    d, e, f = second
    return b * f - c * e, c * d - a * f, a * e - b * d


def turn(start: AxisDirection, end: AxisDirection, about: AxisDirection) -> int:
    """Return the angle in degrees from one direction to another about a third direction."""
    # Both directions are at a right angle to ``about``.
    if start == end:
        return 0
    across = cross(about, start)
    if end == across:
        return 90
    return -90 if end == (-across[0], -across[1], -across[2]) else 180


# --- Pseudo-random numbers that are the same on every computer: integers from SHA-256 of a text


T = TypeVar("T")

_BITS: Final = 32


class Draws:
    """A sequence of pseudo-random numbers. Equal texts give equal sequences."""

    def __init__(self, text: str) -> None:
        self._words = _words(text)

    def below(self, limit: int) -> int:
        """Return a pseudo-random integer from 0 to ``limit - 1``."""
        # All have nearly the same probability.
        return next(self._words) * limit >> _BITS

    def chance(self, percent: int) -> bool:
        """True with a probability of ``percent`` %."""
        return self.below(100) < percent

    def one_of(self, choices: Sequence[T]) -> T:
        """Return one of the choices; all are equally likely."""
        return choices[self.below(len(choices))]

    def weighted(self, choices: Sequence[tuple[T, int]]) -> T:
        """Return one of the choices, each with a weight; a greater weight is more probable."""
        # At least one weight must be positive.
        left = self.below(sum(weight for _, weight in choices))
        for choice, weight in choices:
            left -= weight
            if left < 0:
                return choice
        raise AssertionError("the weights add up to more than their sum")


def _words(text: str) -> Iterator[int]:
    for block in count():
        digest = sha256(f"{text}\n{block}".encode()).digest()
        for i in range(0, len(digest), _BITS // 8):
            yield int.from_bytes(digest[i : i + _BITS // 8], "big")


# --- Choose a random robot: its joints, the relations of their axes, and the lengths


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


# --- The path of a generated robot's links, as its figure draws them
#
# Sliding joints are extended. The module uses plain floats and a table of sines, so that every
# machine refuses the same robots.


HomePoint = tuple[float, float, float]
# The range of a sliding joint's variable in centimetres, and its share that figures draw.
SLIDE: Final = (10, 60)
_EXTENDED: Final = 30.0
_SINES: Final = {0: 0.0, 30: 0.5, 45: 0.707106781, 60: 0.866025404, 90: 1.0}


@dataclass(frozen=True, slots=True)
class HomePath:
    """The corners of the path from the base to the tool, in centimetres."""

    # Consecutive corners differ.

    corners: tuple[HomePoint, ...]

    @property
    def pieces(self) -> list[tuple[HomePoint, HomePoint]]:
        """The line segments of the path."""
        return list(pairwise(self.corners))


def home_path(rows: Sequence[PlannedRow]) -> HomePath:
    """Return the path of a robot through the origins of its frames."""
    # It follows z, then x of each row.
    here: HomePoint = (0.0, 0.0, 0.0)
    x: HomePoint = (1.0, 0.0, 0.0)
    y: HomePoint = (0.0, 1.0, 0.0)
    z: HomePoint = (0.0, 0.0, 1.0)
    corners = [here]
    for row in rows:
        x, y = _turned(x, y, row.theta)
        for step, way in ((row.d + (_EXTENDED if row.sliding else 0.0), z), (float(row.a), x)):
            if step:
                here = _sum(here, _scaled(way, step))
                corners.append(here)
        y, z = _turned(y, z, row.alpha)
    return HomePath(tuple(corners))


def cosine_sine(degrees: int) -> tuple[float, float]:
    """Return the cosine and the sine of an angle in degrees, with 9 decimals."""
    # Only angles that robots have are in the table.
    return _sine(degrees + 90), _sine(degrees)


def _sine(degrees: int) -> float:
    turn = degrees % 360
    sign, turn = (-1.0, turn - 180) if turn >= 180 else (1.0, turn)
    return sign * _SINES[min(turn, 180 - turn)]


def _turned(first: HomePoint, second: HomePoint, degrees: int) -> tuple[HomePoint, HomePoint]:
    c, s = cosine_sine(degrees)
    return (
        _sum(_scaled(first, c), _scaled(second, s)),
        _sum(_scaled(second, c), _scaled(first, -s)),
    )


def _scaled(vector: HomePoint, factor: float) -> HomePoint:
    return vector[0] * factor, vector[1] * factor, vector[2] * factor


def _sum(first: HomePoint, second: HomePoint) -> HomePoint:
    return first[0] + second[0], first[1] + second[1], first[2] + second[2]


def difference(first: HomePoint, second: HomePoint) -> HomePoint:
    """Return ``first - second``."""
    return first[0] - second[0], first[1] - second[1], first[2] - second[2]


def dot(first: HomePoint, second: HomePoint) -> float:
    """Return the scalar product of two vectors."""
    return first[0] * second[0] + first[1] * second[1] + first[2] * second[2]


def gap(one: tuple[HomePoint, HomePoint], other: tuple[HomePoint, HomePoint]) -> float:
    """Return the distance between two line segments."""
    # Source: Ericson, *Real-Time Collision Detection*, §5.1.9.
    u, v = difference(one[1], one[0]), difference(other[1], other[0])
    w = difference(one[0], other[0])
    a, e, b, c, f = dot(u, u), dot(v, v), dot(u, v), dot(u, w), dot(v, w)
    parting = a * e - b * b
    s = _clamped((b * f - c * e) / parting) if parting > 1e-6 * a * e else 0.0
    t = (b * s + f) / e
    if not 0.0 <= t <= 1.0:
        t = _clamped(t)
        s = _clamped((b * t - c) / a)
    apart = difference(_sum(one[0], _scaled(u, s)), _sum(other[0], _scaled(v, t)))
    return float(dot(apart, apart) ** 0.5)


def _clamped(share: float) -> float:
    return min(max(share, 0.0), 1.0)


def seen(
    points: Sequence[HomePoint], azimuth: int, elevation: int
) -> Iterator[tuple[float, float]]:
    """Yield the coordinates of points in a view, to the right and upwards."""
    # These are the coordinates of ``service/dh_grader/figures/mechanism.py``.
    ca, sa, ce, se = _VIEWS[azimuth, elevation]
    for px, py, pz in points:
        yield ca * py - sa * px, ce * pz - se * (ca * px + sa * py)


# Views as (azimuth, elevation), the best ones first: cos and sin of each, with 9 decimals.
_VIEWS: Final = {
    (-60, 25): (0.5, -0.866025404, 0.906307787, 0.422618262),
    (30, 25): (0.866025404, 0.5, 0.906307787, 0.422618262),
    (-50, 30): (0.64278761, -0.766044443, 0.866025404, 0.5),
    (40, 30): (0.766044443, 0.64278761, 0.866025404, 0.5),
    (-35, 20): (0.819152044, -0.573576436, 0.939692621, 0.342020143),
    (55, 20): (0.573576436, 0.819152044, 0.939692621, 0.342020143),
    (-70, 35): (0.342020143, -0.939692621, 0.819152044, 0.573576436),
    (20, 35): (0.939692621, 0.342020143, 0.819152044, 0.573576436),
    (125, 25): (-0.573576436, 0.819152044, 0.906307787, 0.422618262),
    (-145, 25): (-0.819152044, -0.573576436, 0.906307787, 0.422618262),
}
VIEWS: Final = tuple(_VIEWS)


# --- The reasons to refuse a random robot
#
# If a robot is refused, another random robot gets its number.


# Links are drawn about 6 cm thick, joints 10.
_CLEARANCE: Final = 13.3
# In shares of the larger side of the picture, which is about 330 pixels on a phone.
_CORNERS_APART: Final = 0.0531
_LABELS_APART: Final = 0.0713
_FORESHORTENED: Final = 0.2703
# A table must have about as many cells with something to know as rows, or a lazy answer earns much.
_LEAST_CONTENT: Final = 0.7903
# With few rows, wrong cells that are not counted matter more: more cells than rows, and even more
# if the last row is split. The few robots in which a lazy answer earns more all the same are not
# dealt (``asks_enough``).
_FEW: Final = 4
_SPLIT: Final = 3
_SPATIAL: Final = 6
# Joint values without any relation, in radians and in metres.
_GENERIC: Final = (0.731, -1.157, 0.419, 1.933, -0.587, 2.311, -1.723)


@dataclass(frozen=True, slots=True)
class Seen:
    """The direction from which a figure shows a robot."""

    azimuth: int
    elevation: int


def reason_against(plan: Plan, path: HomePath) -> str | None:
    """Return the reason to refuse a planned robot, or None."""
    if _tells_little(plan.rows):
        return "a lazy answer earns too much"
    if _turns_back(path) or _touches(path):
        return "links go through each other"
    if rank_of(plan) < min(len(plan.rows), _SPATIAL):
        return "joints depend on each other"
    return None


def _tells_little(rows: Sequence[PlannedRow]) -> bool:
    known = sum(bool(row.a) + bool(row.alpha) + bool(row.d) + bool(row.theta) for row in rows)
    if len(rows) <= _FEW:
        # In the modified table, the angle of the last joint and the length from there to the tool
        # are in two rows, and marks may give up the second one to save the angle.
        last = rows[-1]
        is_split = bool(last.a and last.theta and not last.sliding)
        return known <= len(rows) + (_SPLIT if is_split else 0)
    return known < _LEAST_CONTENT * len(rows)


def _turns_back(path: HomePath) -> bool:
    """True if a segment of the path leads back along the segment before it."""
    steps = [difference(end, start) for start, end in path.pieces]
    return any(
        dot(one, other) < -0.87 * (dot(one, one) * dot(other, other)) ** 0.5
        for one, other in pairwise(steps)
    )


def _touches(path: HomePath) -> bool:
    """True if two segments of the path that are not neighbours come near each other."""
    pieces = path.pieces
    for i, j in combinations(range(len(pieces)), 2):
        if j > i + 1 and gap(pieces[i], pieces[j]) < _CLEARANCE:
            return True
    return False


def table_of(plan: Plan) -> Table:
    """Return the standard DH table of a robot with all joint variables 0, in metres and radians."""
    table = np.zeros((len(plan.rows), 4))
    for i, row in enumerate(plan.rows):
        table[i, A], table[i, D] = row.a / 100, row.d / 100
        table[i, ALPHA], table[i, THETA] = np.radians([row.alpha, row.theta])
    return table


def rank_of(plan: Plan) -> int:
    """Return the number of independent motions of the robot's tool."""
    # At a generic configuration.
    count = len(plan.rows)
    table = np.repeat(table_of(plan)[..., None], 3, axis=2)
    for i, row in enumerate(plan.rows):
        values = [_GENERIC[(i + k) % len(_GENERIC)] for k in (0, 2, 5)]
        table[i, D if row.sliding else THETA] += values
    slides = [row.sliding for row in plan.rows]
    return rank(space_jacobian(table, Convention.STANDARD, range(count), slides))


def clear_view(path: HomePath) -> Seen | None:
    """Return the first view in which the figure's corners and labels do not overlap, or None."""
    pieces = path.pieces
    middles = [((p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2) for p, q in pieces]
    different = _different(path.corners)
    for azimuth, elevation in VIEWS:
        flat = list(seen(different, azimuth, elevation))
        size = max(max(each[k] for each in flat) - min(each[k] for each in flat) for k in (0, 1))
        if not _apart(flat, _CORNERS_APART * size):
            continue
        if not _apart(list(seen(middles, azimuth, elevation)), _LABELS_APART * size):
            continue
        if _long_enough(pieces, azimuth, elevation):
            return Seen(azimuth, elevation)
    return None


def _different(points: Sequence[HomePoint]) -> list[HomePoint]:
    found: list[HomePoint] = []
    for point in points:
        if all(dot(d := difference(point, other), d) > 1e-3 for other in found):
            found.append(point)
    return found


def _apart(points: Sequence[tuple[float, float]], least: float) -> bool:
    square = least * least
    return all((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2 > square for p, q in combinations(points, 2))


def _long_enough(
    pieces: Sequence[tuple[HomePoint, HomePoint]], azimuth: int, elevation: int
) -> bool:
    """True if no link points at the viewer."""
    for start, end in pieces:
        (a, b), (c, d) = seen((start, end), azimuth, elevation)
        along = difference(end, start)
        if (c - a) ** 2 + (d - b) ** 2 < _FORESHORTENED**2 * dot(along, along):
            return False
    return True
