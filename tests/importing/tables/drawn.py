"""Random and real DH tables, and their poses, without the tested code."""

import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
EXERCISES = Path(__file__).parents[3] / "exercises"
COLUMNS = ("a", "alpha", "d", "theta")
ANGLES = ("alpha", "theta")
NAMES = ("a1", "a2", "l1", "l2", "L0", "L_1", "h", "H", "l_arm", "d_6", "r", "b2", "L_AB", "e1")
_TERM = re.compile(r"([+-]?)\s*(?:(\d+(?:\.\d+)?)\s*(deg)?)?\s*\*?\s*([A-Za-z]\w*)?")


@dataclass(frozen=True)
class Cell:
    """A number in millimetres or degrees, letters with factors, and the factor of the variable."""

    number: float = 0.0
    letters: Mapping[str, float] = field(default_factory=dict)
    motion: int = 0


@dataclass(frozen=True)
class Drawn:
    """A table of cells by column; ``kinds`` has R, P or "" (a fixed row) for each row."""

    convention: str
    kinds: Sequence[str]
    rows: Sequence[Mapping[str, Cell]]

    @property
    def joints(self) -> list[int]:
        """The number of the joint of each row; a fixed row has the number of the next joint."""
        return [1 + sum(map(bool, self.kinds[:i])) for i in range(len(self.kinds))]


def random_table(rng: np.random.Generator) -> Drawn:
    """Return a random table of 2 to 6 joints."""
    count = int(rng.integers(2, 7))
    kinds = [str(rng.choice(["R", "R", "R", "P"])) for _ in range(count)]
    if rng.random() < 0.15:
        kinds.append("")
    if rng.random() < 0.1:
        kinds.insert(int(rng.integers(1, count)), "")
    lettered = rng.choice([0.0, 0.5, 1.0])
    names = [str(name) for name in rng.permutation(NAMES)]
    reverse = rng.random() < 0.3
    convention = str(rng.choice(["standard", "modified"]))
    rows = []
    for i, kind in enumerate(kinds):
        row = {
            "a": _length(rng, 0.5, lettered, names),
            "alpha": Cell(_angle(rng)),
            "d": _length(rng, 0.5, lettered, names),
            "theta": Cell(_angle(rng) if rng.random() < 0.5 else 0.0),
        }
        if i == 0 and convention == "modified" and rng.random() < 0.7:
            row["a"] = row["alpha"] = Cell()
        if kind:
            column = "theta" if kind == "R" else "d"
            cell = row[column]
            sign = -1 if reverse and i and rng.random() < 0.5 else 1
            if reverse and rng.random() < 0.1:
                sign = -1
            if kind == "P" and rng.random() < 0.5:
                cell = Cell()
            row[column] = Cell(cell.number, cell.letters, sign)
        rows.append(row)
    return Drawn(convention, kinds, rows)


def _angle(rng: np.random.Generator) -> float:
    common = [0, 0, 90, 90, -90, -90, 180, 45, -45, 30, -60, 135, -120]
    odd = [12.5, -37.25, 5, 2.5, 44.96, 79.34995, -100.01]
    return float(rng.choice(common if rng.random() < 0.9 else odd))


def _length(rng: np.random.Generator, share: float, lettered: float, names: list[str]) -> Cell:
    if rng.random() > share:
        return Cell()
    if rng.random() >= lettered:
        return Cell(float(rng.choice([1, -1, 1]) * round(rng.uniform(5, 900), rng.integers(0, 3))))
    # The first name is used again and again: equal links.
    name = names[0] if rng.random() < 0.3 or len(names) == 1 else names.pop()
    factor = float(rng.choice([1, 1, 1, 1, -1, 2, 0.5]))
    letters = {name: factor}
    if rng.random() < 0.1 and len(names) > 2:
        letters[names.pop()] = 1.0
    number = float(rng.integers(10, 400)) if rng.random() < 0.08 else 0.0
    return Cell(number, letters)


def real_table(name: str) -> Drawn:
    """Return the table in the file of a shipped exercise."""
    robot = tomllib.loads((EXERCISES / f"{name}.toml").read_text("utf-8"))["robot"]
    structure, joints = robot["structure"], robot["joints"]
    rows = []
    for i, texts in enumerate(robot["table"]):
        own = joints[i] if i < len(joints) else ""
        row = {}
        for column, text in zip(COLUMNS, texts, strict=True):
            cell = terms(str(text), own)
            scale = 1.0 if column in ANGLES else 1000.0
            row[column] = Cell(round(cell.number * scale, 9), cell.letters, cell.motion)
        rows.append(row)
    kinds = [*structure, *[""] * (len(rows) - len(structure))]
    return Drawn(robot["convention"], kinds, rows)


def terms(text: str, variable: str) -> Cell:
    """Read a sum such as "theta2 - 90deg" of an exercise file; angles are in degrees."""
    number, letters, motion = 0.0, dict[str, float](), 0
    position = 0
    while position < len(text):
        found = _TERM.match(text, position)
        assert found, text
        assert found.end() > position, text
        position = found.end() + len(text[found.end() :]) - len(text[found.end() :].lstrip())
        sign = -1.0 if found[1] == "-" else 1.0
        factor = sign * float(found[2] or 1)
        if found[4] is None:
            number += factor
        elif found[4] == variable:
            assert found[2] is None, text
            motion += int(sign)
        else:
            letters[found[4]] = letters.get(found[4], 0.0) + factor
    return Cell(number, letters, motion)


def pose(
    rows: Sequence[Mapping[str, Cell]],
    convention: str,
    lengths: Mapping[str, float],
    variables: Sequence[float],
) -> Numbers:
    """Return the pose of the last frame; cells are in metres and degrees.

    ``variables`` has the value of the joint variable of each row.
    """
    reached = np.eye(4)
    for row, q in zip(rows, variables, strict=True):
        a, d = (_metres(row[column], lengths, q) for column in ("a", "d"))
        alpha, theta = (np.radians(row[name].number) + row[name].motion * q for name in ANGLES)
        along_z, along_x = _screw(2, theta, d), _screw(0, alpha, a)
        link = along_z @ along_x if convention == "standard" else along_x @ along_z
        reached = reached @ link
    return reached


def _metres(cell: Cell, lengths: Mapping[str, float], q: float) -> float:
    letters = sum(factor * lengths[name] for name, factor in cell.letters.items())
    return float(cell.number + letters + cell.motion * q)


def _screw(axis: int, angle: float, shift: float) -> Numbers:
    """Return the turn about an axis of the frame, and the shift along it."""
    cross = np.zeros((3, 3))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    cross[j, i], cross[i, j] = 1.0, -1.0
    matrix = np.eye(4)
    matrix[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    matrix[axis, 3] = shift
    return matrix
