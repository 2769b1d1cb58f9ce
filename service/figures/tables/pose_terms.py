"""The pose of a table, multiplied out as text: sums of products of sines and cosines.

Angles about parallel axes are added before their sine is taken, as in textbooks.
"""

# The chain is X_0 Z_1 X_1 Z_2 …. Each entry is a sum of terms. The number of terms is bounded, and
# the terms are not simplified afterwards.

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from service.expressions import Expression, evaluate_all
from service.kinematics.chain import Row

# The maximum for all entries together. An arm of two links with a wrist has about a hundred.
_MOST_TERMS: Final = 160
_SAME: Final = 1e-9
_LARGEST_FACTOR: Final = 9
_QUARTER: Final = np.pi / 2

# A sum: for each product, a tuple of factors as texts, its coefficient.
Terms = dict[tuple[str, ...], int]


class LongPoseError(ValueError):
    """The pose has too many terms to be useful."""


@dataclass(frozen=True, slots=True)
class _Angle:
    # A sum of angles and quarter turns. Each part is a text and its factor.
    parts: tuple[tuple[str, int], ...] = ()
    quarters: int = 0

    def plus(self, other: "_Angle") -> "_Angle":
        total = dict(self.parts)
        for text, factor in other.parts:
            total[text] = total.get(text, 0) + factor
        kept = tuple((text, factor) for text, factor in total.items() if factor)
        return _Angle(kept, self.quarters + other.quarters)

    def reversed(self) -> "_Angle":
        return _Angle(tuple((text, -factor) for text, factor in self.parts), -self.quarters)

    def cosine_and_sine(self) -> tuple[Terms, Terms]:
        # Each quarter turn swaps cosine and sine.
        cosine, sine = _number(1), _number(0)
        if self.parts:
            sign = 1 if self.parts[0][1] > 0 else -1
            text = _sum_text([(text, sign * factor) for text, factor in self.parts])
            cosine, sine = {(f"cos({text})",): 1}, {(f"sin({text})",): sign}
        for _ in range(self.quarters % 4):
            cosine, sine = _times(sine, -1), cosine
        return cosine, sine


def _sum_text(parts: Sequence[tuple[str, int]]) -> str:
    # Without a leading +.
    ordered = [
        f"{'-' if factor < 0 else '+'}{'' if abs(factor) == 1 else f'{abs(factor)}*'}{text}"
        for text, factor in parts
    ]
    return "".join(ordered).removeprefix("+")


def _angle(cell: Expression) -> _Angle:
    # A sum of symbols and quarter turns, or else one text.
    names = sorted(cell.symbols)
    # Evaluate with all symbols 0, with each symbol 1, and at a point that shows if it is not a sum.
    points = np.vstack([np.zeros(len(names)), np.eye(len(names)), 0.37 + np.arange(len(names))])
    [found] = evaluate_all([cell], dict(zip(names, points.T, strict=True)), {})
    values = np.broadcast_to(np.asarray(found, dtype=np.float64), len(points))
    whole = _Angle(((_bracketed(cell.text()), 1),))
    if not np.isfinite(values).all():
        return whole
    quarters, factors = values[0] / _QUARTER, values[1:-1] - values[0]
    rest = values[-1] - values[0] - points[-1] @ factors
    exact = [quarters - round(quarters), rest, *(factors - np.round(factors))]
    if np.abs(exact).max() > _SAME or np.abs(factors).max(initial=0) > _LARGEST_FACTOR:
        return whole
    parts = tuple((name, round(factor)) for name, factor in zip(names, factors, strict=True))
    return _Angle(tuple(part for part in parts if part[1]), round(quarters))


def _length(cell: Expression) -> Terms:
    text = cell.text()
    if text == "0":
        return {}
    if text.startswith("-") and not re.search("[+-]", text[1:]):
        return {(text[1:],): -1}
    return {(_bracketed(text),): 1}


def _bracketed(text: str) -> str:
    return f"({text})" if re.search("[+/-]", text) else text


def _number(value: int) -> Terms:
    return {(): value} if value else {}


def _times(terms: Terms, factor: int) -> Terms:
    return {product: factor * count for product, count in terms.items()}


def _product(one: Terms, other: Terms) -> Terms:
    if len(one) * len(other) > _MOST_TERMS:
        raise LongPoseError
    total = Terms()
    for left, m in one.items():
        for right, n in other.items():
            product = left + right
            total[product] = total.get(product, 0) + m * n
    return {product: count for product, count in total.items() if count}


def _plus(one: Terms, other: Terms) -> Terms:
    total = dict(one)
    for product, count in other.items():
        total[product] = total.get(product, 0) + count
    return {product: count for product, count in total.items() if count}


class _Pose:
    # The rotation's columns and the position so far, and a pending turn about z.
    def __init__(self) -> None:
        self.columns = [[_number(int(i == j)) for i in range(3)] for j in range(3)]
        self.position = [Terms() for _ in range(3)]
        self.turn = _Angle()

    def along(self, column: Sequence[Terms], length: Terms) -> None:
        if length:
            self.position = [
                _plus(at, _product(length, each))
                for at, each in zip(self.position, column, strict=True)
            ]

    def about(self, angle: _Angle, first: int, second: int) -> None:
        cosine, sine = angle.cosine_and_sine()
        pairs = list(zip(self.columns[first], self.columns[second], strict=True))
        self.columns[first] = [_plus(_product(u, cosine), _product(v, sine)) for u, v in pairs]
        self.columns[second] = [
            _plus(_product(v, cosine), _times(_product(u, sine), -1)) for u, v in pairs
        ]
        if sum(len(terms) for column in self.columns for terms in column) > _MOST_TERMS:
            raise LongPoseError

    def turn_now(self) -> None:
        self.about(self.turn, 0, 1)
        self.turn = _Angle()

    def x_axis(self) -> list[Terms]:
        # After the pending turn about z.
        cosine, sine = self.turn.cosine_and_sine()
        return [
            _plus(_product(u, cosine), _product(v, sine))
            for u, v in zip(self.columns[0], self.columns[1], strict=True)
        ]

    def twist(self, angle: _Angle) -> None:
        if angle.parts or angle.quarters % 2:
            self.turn_now()
            self.about(angle, 1, 2)
        elif angle.quarters % 4:
            # A half turn about x reverses y, z and all later turns about z.
            self.columns[1:] = [[_times(terms, -1) for terms in each] for each in self.columns[1:]]
            self.turn = self.turn.reversed()


def pose_texts(modified: Iterable[Row[Expression]]) -> list[list[str]]:
    """Return the product of a table's rows in the modified convention, as texts ``(4, 4)``.

    Raises LongPoseError if there are too many terms.
    """
    pose = _Pose()
    for a, alpha, d, theta in modified:
        length = _length(a)
        if length:
            pose.along(pose.x_axis(), length)
        pose.twist(_angle(alpha))
        pose.along(pose.columns[2], _length(d))
        pose.turn = pose.turn.plus(_angle(theta))
    pose.turn_now()
    columns = [*pose.columns, pose.position]
    if sum(len(terms) for column in columns for terms in column) > _MOST_TERMS:
        raise LongPoseError
    rows = [[_text(column[i]) for column in columns] for i in range(3)]
    return [*rows, ["0", "0", "0", "1"]]


def _text(terms: Terms) -> str:
    ordered = [("*".join(product) or "1", count) for product, count in terms.items()]
    return _sum_text(ordered) or "0"
