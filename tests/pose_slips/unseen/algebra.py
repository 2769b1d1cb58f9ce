"""Matrices of trigonometric formulas, and their text."""

# An entry maps (letters, frequencies) to a complex factor: `(("a2",), (("q1", 1),))` is
# a2·exp(i·q1). So a product of cosines is at once a sum of cosines of sums of angles, and no
# program for algebra is needed.

from collections.abc import Mapping
from functools import reduce

import numpy as np

# A cell: the factor of each symbol; under "" a number, which counts quarter turns in an angle.
Cell = Mapping[str, float]
Row = tuple[Cell, Cell, Cell, Cell]
Table = tuple[Row, ...]
Entry = dict[tuple[tuple[str, ...], tuple[tuple[str, int], ...]], complex]
Matrix = list[list[Entry]]

ONE: Entry = {((), ()): 1.0}
SMALL = 1e-12
STANDARD = "standard"


def _sum(*entries: Entry) -> Entry:
    total: Entry = {}
    for entry in entries:
        for key, factor in entry.items():
            total[key] = total.get(key, 0) + factor
    return {key: factor for key, factor in total.items() if abs(factor) > SMALL}


def _times(one: Entry, other: Entry) -> Entry:
    products = []
    for (letters, turns), factor in one.items():
        for (more, others), second in other.items():
            sums = dict(turns)
            for name, count in others:
                sums[name] = sums.get(name, 0) + count
            key = tuple(sorted(letters + more)), tuple(sorted((n, c) for n, c in sums.items() if c))
            products.append({key: factor * second})
    return _sum(*products)


def _product(one: Matrix, other: Matrix) -> Matrix:
    return [
        [_sum(*(_times(one[i][k], other[k][j]) for k in range(4))) for j in range(4)]
        for i in range(4)
    ]


def _length(cell: Cell) -> Entry:
    return {((name,) if name else (), ()): factor for name, factor in cell.items() if factor}


def _cosine_and_sine(angle: Cell) -> tuple[Entry, Entry]:
    turns = tuple(sorted((name, int(count)) for name, count in angle.items() if name and count))
    back = tuple((name, -count) for name, count in turns)
    turn = 1j ** (angle.get("", 0) % 4)
    forward: Entry = {((), turns): turn / 2}
    backward: Entry = {((), back): 1 / turn / 2}
    sine = _sum(
        {key: factor / 1j for key, factor in forward.items()},
        {key: -factor / 1j for key, factor in backward.items()},
    )
    return _sum(forward, backward), sine


def _minus(entry: Entry) -> Entry:
    return {key: -factor for key, factor in entry.items()}


def link(row: Row, convention: str) -> Matrix:
    """Return the link transform of a row (a, α, d, θ)."""
    a, alpha, d, theta = row
    (ca, sa), (ct, st) = _cosine_and_sine(alpha), _cosine_and_sine(theta)
    x: Matrix = [[ONE, {}, {}, _length(a)], [{}, ca, _minus(sa), {}], [{}, sa, ca, {}], [{}] * 3]
    z: Matrix = [[ct, _minus(st), {}, {}], [st, ct, {}, {}], [{}, {}, ONE, _length(d)], [{}] * 3]
    x[3], z[3] = [{}, {}, {}, ONE], [{}, {}, {}, ONE]
    return _product(z, x) if convention == STANDARD else _product(x, z)


def product(links: list[Matrix]) -> Matrix:
    """Return the product of link transforms."""
    return reduce(_product, links)


def text(entry: Entry) -> str:
    """Return the entry as text, such as ``0.5*a2*cos(q1 + q2) - d4``."""
    terms = []
    for (letters, turns), factor in sorted(entry.items(), key=str):
        opposite = tuple((name, -count) for name, count in turns)
        if not turns:
            terms.append(_term(factor.real, letters, ""))
        elif turns[0][1] > 0:
            other = entry.get((letters, opposite), 0)
            angle = " + ".join(n if c == 1 else f"({c})*{n}" for n, c in turns)
            terms.append(_term((factor + other).real, letters, f"cos({angle})"))
            terms.append(_term((1j * (factor - other)).real, letters, f"sin({angle})"))
    return " + ".join(filter(None, terms)) or "0"


def _term(factor: float, letters: tuple[str, ...], function: str) -> str:
    if abs(factor) < SMALL:
        return ""
    named = [*letters, *([function] if function else [])]
    number = f"{factor:.12g}"
    if abs(factor) == 1 and named:
        return ("-" if factor < 0 else "") + "*".join(named)
    return "*".join([f"({number})" if factor < 0 else number, *named])


def numeric_link(row: Row, convention: str, values: Mapping[str, float]) -> np.ndarray:
    """Return the numeric link transform of a row."""

    def size(cell: Cell, unit: float) -> float:
        return sum(
            factor * (values[name] if name else unit) for name, factor in cell.items() if factor
        )

    a, d = size(row[0], 1.0), size(row[2], 1.0)
    alpha, theta = size(row[1], np.pi / 2), size(row[3], np.pi / 2)
    x, z = np.eye(4), np.eye(4)
    x[1:3, 1:3] = [[np.cos(alpha), -np.sin(alpha)], [np.sin(alpha), np.cos(alpha)]]
    z[:2, :2] = [[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]]
    x[0, 3], z[2, 3] = a, d
    return z @ x if convention == STANDARD else x @ z
