"""Generate random arms of two to six joints, as exercises."""

from collections.abc import Iterator
from dataclasses import dataclass
from random import Random

import numpy as np

from tests.pose_slips.unseen.algebra import STANDARD, Cell, Row, Table, numeric_link

NONE: Cell = {}
RANK = 1e-6
PARTS = """
[[parts]]
id = "transform"
kind = "transform"
title = "Pose"
[[parts]]
id = "rotation"
kind = "rotation"
title = "Orientation"
[[parts]]
id = "position"
kind = "position"
title = "Position"
[[parts]]
id = "links"
kind = "link_transforms"
title = "Link transforms"
convention = "{convention}"
[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
convention = "{convention}"
"""


@dataclass(frozen=True)
class Arm:
    """An arm: its table, its joint types and its convention."""

    # Joint i has the variable q<i>. Rows beyond the joints are fixed.
    table: Table
    structure: str
    convention: str

    @property
    def labels(self) -> list[str]:
        fixed = ["e", "e2"][: len(self.table) - len(self.structure)]
        return [str(i + 1) for i in range(len(self.structure))] + fixed

    @property
    def symbols(self) -> set[str]:
        return {name for row in self.table for cell in row for name in cell if name}

    @property
    def text(self) -> str:
        joints = [f"q{i + 1}" for i in range(len(self.structure))]
        rows = [
            [written(cell, column % 2 == 1) for column, cell in enumerate(r)] for r in self.table
        ]
        lengths = sorted(self.symbols - set(joints))
        symbols = [f'{name} = {{ kind = "length", description = "a length" }}' for name in lengths]
        return (
            'title = "Unseen"\nsource = "none"\nstatement = "Nothing to see."\n'
            f'[robot]\nstructure = "{self.structure}"\nconvention = "{self.convention}"\n'
            f"joints = {joints}\ntable = {rows}\n[symbols]\n"
            + "\n".join(symbols)
            + PARTS.format(convention=self.convention)
        )


def written(cell: Cell, is_angle: bool) -> str:
    """Return the cell as text, with angles in degrees."""

    def term(name: str, factor: float) -> str:
        if not name:
            return f"{90 * factor:g}deg" if is_angle else f"{factor:g}"
        return name if factor == 1 else f"({factor:g})*{name}"

    return " + ".join(term(name, factor) for name, factor in cell.items() if factor) or "0"


def arms(seed: int, count: int) -> Iterator[Arm]:
    """Yield ``count`` random arms."""
    random = Random(seed)
    found = 0
    while found < count:
        arm = _arm(random, 2 + found % 5, letters=found % 2 == 0)
        if arm is not None:
            found += 1
            yield arm


def _arm(random: Random, joints: int, *, letters: bool) -> Arm | None:
    convention = random.choice([STANDARD, "modified"])
    structure = "".join(random.choices("RP", [4, 1], k=joints))
    numbers = random.sample(range(15, 95), 20)

    def length(name: str, share: float) -> Cell:
        if random.random() > share:
            return NONE
        return {name: 1.0} if letters else {"": numbers.pop() / 100}

    rows: list[Row] = []
    for i, letter in enumerate(structure, 1):
        first = convention != STANDARD and i == 1
        a = NONE if first else length(f"a{i}", 0.6)
        turn = 0 if first else random.choices([0, 1, -1, 2], [4, 4, 4, 1])[0]
        alpha: Cell = {"": turn} if turn else NONE
        offset = random.choices([0, 1, -1, 2], [6, 1, 1, 1])[0]
        theta: dict[str, float] = {"": offset} if offset else {}
        d: dict[str, float] = {}
        if letter == "R":
            theta[f"q{i}"] = 1.0
            d = dict(length(f"d{i}", 0.4))
        else:
            d[f"q{i}"] = 1.0
        rows.append((a, alpha, d, theta))
    if convention != STANDARD and random.random() < 0.6:
        rows.append((length("ae", 0.8), NONE, length("de", 0.3), NONE))
    arm = Arm(tuple(rows), structure, convention)
    return arm if _moves_freely(arm, random) else None


def _moves_freely(arm: Arm, random: Random) -> bool:
    if not arm.table[-1][0] and len(arm.table) > len(arm.structure) and not arm.table[-1][2]:
        return False
    values = {name: random.uniform(0.3, 1.2) for name in sorted(arm.symbols)}
    moved = []
    for i in range(len(arm.structure)):
        change = []
        for step in (-1e-4, 1e-4):
            at = {**values, f"q{i + 1}": values[f"q{i + 1}"] + step}
            change.append(np.linalg.multi_dot([np.eye(4), *links_at(arm, at)])[:3])
        moved.append(((change[1] - change[0]) / 2e-4).ravel())
    scales = np.linalg.svd(np.array(moved), compute_uv=False)
    return bool(scales[-1] > 1e-3)


def links_at(arm: Arm, values: dict[str, float]) -> list[np.ndarray]:
    """Return the numeric link transforms of an arm."""
    return [numeric_link(row, arm.convention, values) for row in arm.table]
