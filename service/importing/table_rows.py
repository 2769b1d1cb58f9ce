"""The rows of an imported DH table, and the robot that they describe."""

# A table is a chain of factors X_0 Z_1 X_1 … Z_n X_n (see ``kinematics.chain``). Z and X are turned
# over and joined here without solving any equation, so the poses stay the same.

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from service.importing.home_statement import HomeRobot, sum_text
from service.importing.numbers import angle_text, exact_text
from service.kinematics.chain import A, D, Row
from service.kinematics.dh import Convention

_MEAN_LENGTHS = {A: 0.5, D: 0.3}


@dataclass(frozen=True, slots=True)
class CellSum:
    """The sum of a number, of letters with their factors, and of the joint variable.

    ``motion`` is the factor of the joint variable: 1, -1, or 0.
    """

    number: float = 0.0
    letters: Mapping[str, float] = field(default_factory=dict)
    motion: int = 0

    def __add__(self, other: "CellSum") -> "CellSum":
        names = [*self.letters, *(name for name in other.letters if name not in self.letters)]
        sums = {name: self.letters.get(name, 0) + other.letters.get(name, 0) for name in names}
        letters = {name: factor for name, factor in sums.items() if factor}
        return CellSum(self.number + other.number, letters, self.motion + other.motion)

    def __neg__(self) -> "CellSum":
        letters = {name: -factor for name, factor in self.letters.items()}
        return CellSum(-self.number, letters, -self.motion)

    def __bool__(self) -> bool:
        return bool(self.number or self.letters or self.motion)

    def turned(self) -> "CellSum":
        """Return the cell of a constant angle plus half a turn, at most half a turn."""
        angle = self.number + math.pi
        return replace(self, number=angle - math.tau if angle > math.pi + 1e-9 else angle)


@dataclass(frozen=True, slots=True)
class _Factor:
    # Z has d and θ of a row, X has a and α. ``row`` is the index of the row.
    is_z: bool
    length: CellSum
    angle: CellSum
    row: int

    @property
    def motion(self) -> int:
        return self.length.motion or self.angle.motion

    def joined(self, other: "_Factor") -> "_Factor":
        return replace(self, length=self.length + other.length, angle=self.angle + other.angle)


class UnusableRowError(ValueError):
    """The row with the index ``row`` does not fit into the table of an exercise."""

    def __init__(self, row: int) -> None:
        super().__init__(row)
        self.row = row


class FixedRowError(UnusableRowError):
    """A fixed row cannot be joined with the rows beside it."""


class FirstAxisError(UnusableRowError):
    """Frame 0 of a standard table is not on the axis of joint 1."""


class FirstDirectionError(UnusableRowError):
    """Joint 1 of a standard table turns or slides opposite to z0."""


@dataclass(frozen=True, slots=True)
class TableRobot:
    """The robot of a table.

    ``turned`` has the joints whose axes were turned over, so that they count +q instead of -q;
    ``joined`` has the rows, from 1, that became part of the rows beside them.
    """

    robot: HomeRobot
    turned: tuple[int, ...]
    joined: tuple[int, ...]


def robot_of_rows(rows: Sequence[Row[CellSum]], convention: Convention) -> TableRobot:
    """Return the robot of the rows of a table in this convention.

    Raises UnusableRowError.
    """
    factors = list(_factors(rows, convention))
    fixed = [i for i, row in enumerate(rows) if not any(cell.motion for cell in row)]
    joined = tuple(i + 1 for i in fixed if i != len(rows) - 1)
    if joined:
        factors = _joined(factors)
    xs, zs = _alternating(factors, len(rows))
    for z in zs[:-1]:
        if not z.motion:
            raise FixedRowError(z.row)
    turned = tuple(i for i, z in enumerate(zs) if z.motion < 0)
    for i in turned:
        zs[i] = replace(zs[i], length=-zs[i].length, angle=-zs[i].angle)
        for j in (i, i + 1):
            xs[j] = replace(xs[j], angle=xs[j].angle.turned())
    if convention is Convention.STANDARD and (xs[0].length or xs[0].angle):
        raise FirstDirectionError(zs[0].row) if 0 in turned else FirstAxisError(zs[0].row)
    table = [(x.length, x.angle, z.length, z.angle) for x, z in zip(xs[1:], zs, strict=True)]
    return TableRobot(_home_robot(table, xs[0]), tuple(i + 1 for i in turned), joined)


def typed_rows(rows: Sequence[Row[CellSum]], variables: Sequence[str]) -> list[Row[str]]:
    """Return the texts of the cells; the joint variables of the moving rows are ``variables``."""
    names = iter(variables)
    typed = []
    for row in rows:
        name = next(names) if any(cell.motion for cell in row) else ""
        texts = [
            sum_text(
                {name: cell.motion, **cell.letters} if cell.motion else cell.letters,
                exact_text(cell.number) if j in (A, D) else angle_text(cell.number),
            )
            for j, cell in enumerate(row)
        ]
        typed.append((texts[0], texts[1], texts[2], texts[3]))
    return typed


def _factors(rows: Sequence[Row[CellSum]], convention: Convention) -> Iterator[_Factor]:
    for i, (a, alpha, d, theta) in enumerate(rows):
        z, x = _Factor(True, d, theta, i), _Factor(False, a, alpha, i)
        yield from (z, x) if convention is Convention.STANDARD else (x, z)


def _joined(factors: Sequence[_Factor]) -> list[_Factor]:
    # Neighbours along the same axis are one factor, but two joints are not.
    found: list[_Factor] = []
    for factor in factors:
        if not (factor.length or factor.angle):
            continue
        last = found[-1] if found else None
        if last and last.is_z == factor.is_z and not (last.motion and factor.motion):
            moving = factor if factor.motion else last
            found[-1] = replace(last.joined(factor), row=moving.row)
        else:
            found.append(factor)
    return found


def _alternating(factors: Sequence[_Factor], end: int) -> tuple[list[_Factor], list[_Factor]]:
    """Return the factors X_0 … X_n and Z_1 … Z_n; missing ones are the identity."""
    xs: list[_Factor] = []
    zs: list[_Factor] = []
    for factor in factors:
        if factor.is_z:
            if len(xs) == len(zs):
                xs.append(_Factor(False, CellSum(), CellSum(), factor.row))
            zs.append(factor)
        elif len(xs) > len(zs):
            xs[-1] = xs[-1].joined(factor)
        else:
            xs.append(factor)
    if len(xs) == len(zs):
        xs.append(_Factor(False, CellSum(), CellSum(), end - 1))
    return xs, zs


def _home_robot(rows: Sequence[Row[CellSum]], start: _Factor) -> HomeRobot:
    table = np.array([[cell.number for cell in row] for row in rows])
    letters = {
        (i, j): cell.letters
        for i, row in enumerate(rows)
        for j, cell in enumerate(row)
        if cell.letters
    }
    if start.length.letters:
        letters[-1, A] = start.length.letters
    lengths: dict[str, float] = {}
    for (_, j), names in letters.items():
        for name in names:
            lengths.setdefault(name, _MEAN_LENGTHS[j])
    joints = [row for row in rows if any(cell.motion for cell in row)]
    structure = "".join("P" if row[D].motion else "R" for row in joints)
    begins = start.length.number, start.angle.number
    return HomeRobot(table, structure, letters, lengths, begins)
