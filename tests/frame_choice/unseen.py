"""Generate random robots with one to seven joints."""

# Neighbouring axes are skew, parallel, intersecting or equal. Lengths are letters or decimals.

import numpy as np

from tests.frame_choice.robots import MODIFIED, STANDARD, Robot, TextRow

NAMED, NUMERIC, MIXED = "letters", "decimals", "mixed"
CONSTANTS = (NAMED, NUMERIC, MIXED)

_USUAL = ("0", "pi/2", "-pi/2", "0", "pi/2", "-pi/2", "pi")
_ODD = ("pi/3", "-pi/4", "pi/6", "-40*pi/180", "0.3", "2*pi/3")


def random_robot(number: int, rng: np.random.Generator) -> Robot:
    """Return a random robot in a random convention."""
    return _Draft(number, rng).robot()


class _Draft:
    def __init__(self, number: int, rng: np.random.Generator) -> None:
        self.number, self.rng = number, rng
        self.constants = CONSTANTS[number % len(CONSTANTS)]
        self.lengths: list[str] = []
        # Most robots have right angles only, like most real ones.
        self.odd = float(rng.choice([0.0, 0.0, 0.3]))
        self.parallel = float(rng.choice([0.0, 0.3, 0.9]))

    def robot(self) -> Robot:
        rng = self.rng
        joints = int(rng.choice([1, 2, 3, 4, 5, 6, 7], p=[0.1, 0.2, 0.2, 0.2, 0.1, 0.15, 0.05]))
        sliding = float(rng.choice([0.0, 0.3, 0.3, 1.0], p=[0.4, 0.3, 0.25, 0.05]))
        structure = "".join("P" if rng.random() < sliding else "R" for _ in range(joints))
        convention = str(rng.choice([STANDARD, MODIFIED]))
        rows = [self._row(kind, i + 1) for i, kind in enumerate(structure)]
        if convention == MODIFIED:
            if rng.random() < 0.6:
                rows[0] = ("0", "0", *rows[0][2:])
            if rng.random() < 0.4:
                rows.append(self._row("", 0))
        return Robot(
            f"unseen {self.number} ({self.constants})",
            structure,
            convention,
            tuple(f"q{i + 1}" for i in range(joints)),
            tuple(rows),
            tuple(self.lengths),
        )

    def _row(self, kind: str, joint: int) -> TextRow:
        a, d = self._length(0.45), self._length(0.5)
        alpha, theta = self._angle(self.parallel), self._angle(0.8)
        variable = f"q{joint}"
        if kind == "P":
            d = variable if d == "0" else f"{variable}+{d}"
        elif kind == "R":
            theta = variable if theta == "0" else f"{variable}+{theta}"
        return a, alpha, d, theta

    def _length(self, none: float) -> str:
        if self.rng.random() < none:
            return "0"
        if self.constants == NUMERIC or (self.constants == MIXED and self.rng.random() < 0.5):
            return f"{self.rng.uniform(0.05, 0.9):.{self.rng.integers(1, 5)}f}"
        if self.lengths and self.rng.random() < 0.2:
            return str(self.rng.choice(self.lengths))
        self.lengths.append(f"l{len(self.lengths) + 1}")
        return self.lengths[-1]

    def _angle(self, none: float) -> str:
        if self.rng.random() < none:
            return "0"
        return str(self.rng.choice(_ODD if self.rng.random() < self.odd else _USUAL))
