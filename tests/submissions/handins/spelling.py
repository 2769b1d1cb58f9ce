"""Type an answer as students do: units, Greek letters, indices, orders of columns, signs."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from dh_grader.catalogue import Exercise

from tests.shipped import shipped_exercises
from tests.submissions.handins.answers import COLUMNS, Answer, Cells

# "headed" writes bare degrees below headers with the unit.
ANGLES: Final = ("deg", "°", "pi", "π", "decimal", "headed degrees", "headed radians")
_ORDERS: Final = (
    ("a", "alpha", "d", "theta"), ("theta", "d", "a", "alpha"), ("alpha", "a", "theta", "d"),
    ("a", "alpha", "theta", "d"), ("d", "theta", "a", "alpha"),
)  # fmt: skip
_WORDS: Final = {"a": "a", "alpha": "alpha", "d": "d", "theta": "theta"}
_GREEK: Final = {"a": "a", "alpha": "α", "d": "d", "theta": "θ"}
_STANDARD: Final = {"a": "a_i", "alpha": "α_i", "d": "d_i", "theta": "θ_i"}
_MODIFIED: Final = {"a": "a_{i-1}", "alpha": "α_{i-1}", "d": "d_i", "theta": "θ_i"}
_NUMBERED: Final = ("i", "Link", "Joint", "#")
_TOKEN: Final = re.compile(r"(-?)(\d+)deg|([a-zA-Z]+)(\d+)(?![\d.])|-")
_RADIANS: Final = {
    0: "0", 30: "pi/6", 45: "pi/4", 60: "pi/3", 90: "pi/2", 135: "3*pi/4", 180: "pi",
}  # fmt: skip


@dataclass(frozen=True)
class Typed:
    """The typed cells of an answer; the first row has the headers if there are headers."""

    rows: Cells
    has_header: bool = False
    # True if the cells are a DH table.
    is_table: bool = False


def typed(
    answer: Answer,
    rng: np.random.Generator,
    angles: Sequence[str] = ANGLES,
    *,
    is_plain: bool = False,
) -> Typed:
    """Return the answer as somebody types it.

    ``angles`` are the allowed ways to write an angle. A plain text has no Greek letters, no headers
    and the order a, alpha, d, theta, as in a script.
    """
    exercise = shipped_exercises()[answer.exercise]
    angle = str(rng.choice(angles))
    write = _Writer(exercise, answer, angle, rng, is_plain=is_plain)
    if not answer.is_table:
        return Typed([[write.cell(cell) for cell in row] for row in answer.cells])
    if is_plain:
        return Typed([[write.cell(cell) for cell in row] for row in answer.cells], False, True)
    order = _ORDERS[int(rng.integers(len(_ORDERS)))]
    places = [COLUMNS.index(name) for name in order]
    names = _headers(exercise, rng)
    rows = [[names[name] + _unit(name, angle) for name in order]]
    rows += [[write.cell(row[place]) for place in places] for row in answer.cells]
    if rng.random() < 0.6:
        rows = _numbered(rows, exercise, rng)
    return Typed(rows, has_header=True, is_table=True)


def _headers(exercise: Exercise, rng: np.random.Generator) -> dict[str, str]:
    indexed = _MODIFIED if exercise.robot.convention == "modified" else _STANDARD
    return (_WORDS, _GREEK, indexed)[int(rng.integers(3))]


def _unit(name: str, angle: str) -> str:
    if name not in ("alpha", "theta"):
        return ""
    return {"headed degrees": " (deg)", "headed radians": " [rad]"}.get(angle, "")


def _numbered(rows: Cells, exercise: Exercise, rng: np.random.Generator) -> Cells:
    # The joints of a wrist have numbers that do not begin with 1.
    joints = exercise.robot.joints
    first = joints[0].index
    labels = [str(first + i) if i < len(joints) else "e" for i in range(len(rows) - 1)]
    head = str(rng.choice(_NUMBERED))
    return [[label, *row] for label, row in zip([head, *labels], rows, strict=True)]


class _Writer:
    """Writes the cells of one answer in one style."""

    def __init__(
        self,
        exercise: Exercise,
        answer: Answer,
        angle: str,
        rng: np.random.Generator,
        *,
        is_plain: bool,
    ) -> None:
        joints = exercise.robot.joints
        self._angles = frozenset(joint.variable for joint in joints if not joint.prismatic)
        self._angle = angle
        self._is_table = answer.is_table
        self._variable = "plain" if is_plain else str(rng.choice(("plain", "q", "_", "θ", "θ_")))
        self._letter = "" if is_plain else str(rng.choice(("", "", "_")))
        self._minus = "-" if is_plain else str(rng.choice(("-", "-", "−", "–")))

    def cell(self, text: str) -> str:
        """Return a cell such as ``theta2 + 90deg`` in this style."""
        return _TOKEN.sub(self._token, text)

    def _token(self, found: re.Match[str]) -> str:
        if found[2]:
            return (self._minus if found[1] else "") + self._of_angle(int(found[2]))
        if found[3] is None:
            return self._minus
        letters, index = found[3], found[4]
        if found[0] in self._angles:
            return self._of_joint(letters, index)
        if letters in ("c", "s"):
            return found[0]
        return f"{letters}{self._letter}{index}"

    def _of_joint(self, letters: str, index: str) -> str:
        return {
            "plain": f"{letters}{index}", "q": f"q{index}", "_": f"{letters}_{index}",
            "θ": f"θ{index}", "θ_": f"θ_{index}",
        }[self._variable]  # fmt: skip

    def _of_angle(self, degrees: int) -> str:
        match self._angle:
            case "deg" | "°":
                return f"{degrees}{self._angle}"
            case "headed degrees":
                return str(degrees)
            case "decimal":
                return f"{np.radians(degrees):.4f}"
            case "π":
                return _RADIANS[degrees].replace("pi", "π")
        return _RADIANS[degrees]
