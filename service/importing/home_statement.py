"""A robot at home in words: where each axis is, and which way it points.

The words are complete: the axes and the tool frame can be computed from them alone.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from service.kinematics.chain import ALPHA, A, Table, frames
from service.kinematics.dh import Convention
from service.kinematics.transforms import Matrices, Numbers

_SAME = 1e-6
_COUNTS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
Letters = Mapping[tuple[int, int], str]


@dataclass(frozen=True)
class HomeRobot:
    """A standard table of constants, the joints' types, and letters in place of some lengths.

    The table may have one row more than joints, for a fixed tool frame.
    ``letters`` has the letter of a cell by row and column. A minus sign in the table stays in
    front of the letter. A number as text may take the place of a letter: the statement then has
    sums such as "0.2 + 0.35".
    """

    table: Table
    structure: str
    letters: Letters
    real: bool = False
    """True if the lengths are those of a real robot."""

    def lengths(self) -> dict[str, float]:
        """Return the length that each letter stands for."""
        return {name: abs(float(self.table[cell])) for cell, name in self.letters.items()}

    def frames(self, **lengths: float) -> Matrices:
        """Return the frames {0} to {n} at home, with lengths for letters; the others are 0."""
        table = self.table.copy()
        for cell, name in self.letters.items():
            table[cell] = np.sign(table[cell]) * lengths.get(name, 0.0)
        return frames(table, Convention.STANDARD)


class UnevenLettersError(ValueError):
    """A length and a crooked angle meet in one coordinate, so letters give no readable text."""


def home_statement(robot: HomeRobot, convention: Convention) -> str:
    """Return the statement of an exercise about the robot.

    Raises UnevenLettersError if a coordinate is not a sum of letters.
    """
    tool_frame = tool_label(robot, convention)
    wrapped = [*_joints_in_words(robot)]
    lettered = any(name[0].isalpha() for name in robot.letters.values())
    units = "" if lettered else " All lengths are in metres."
    at_home = (
        f"The robot has {_structure_in_words(robot.structure)}.{units} At home all joint variables "
        f"are 0. These are the axes at home, in the base frame {{0}}:"
    )
    positive = "Each joint variable counts positive about or along the direction that is named."
    *_, tool = _origins(robot)
    end = robot.frames(**robot.lengths())[-1]
    x, z = (
        (f"x{tool_frame}", f"z{tool_frame}") if tool_frame != "e" else ("its x axis", "its z axis")
    )
    given = (
        f"The base frame {{0}} and the tool frame {{{tool_frame}}} are given. At home the origin "
        f"of {{{tool_frame}}} is at {tool}, {x} points {_way(end[:3, 0])} and {z} points "
        f"{_way(end[:3, 2])}. The frames on the joints are yours to choose by the "
        f"{convention.value} convention."
    )
    return "\n\n".join([at_home, "\n".join(wrapped), positive, given])


def tool_label(robot: HomeRobot, convention: Convention) -> str:
    """Return the label of the tool frame: the number of rows, or e for a fixed row in addition.

    In the modified convention, frame n is on the last axis. If the tool frame is not, the table
    has a row e.
    """
    last_a, last_alpha = robot.table[-1, [A, ALPHA]]
    fixed = convention is Convention.MODIFIED and max(abs(last_a), abs(last_alpha)) > _SAME
    return "e" if fixed or len(robot.table) > len(robot.structure) else str(len(robot.table))


def _structure_in_words(structure: str) -> str:
    words = [
        f"{_COUNTS[count]} {kind} joint{'' if count == 1 else 's'}"
        for kind, count in (("revolute", structure.count("R")), ("prismatic", structure.count("P")))
        if count
    ]
    return f"{' and '.join(words)} ({structure})"


def _joints_in_words(robot: HomeRobot) -> Iterator[str]:
    at_home = robot.frames(**robot.lengths())
    for i, (letter, origin) in enumerate(zip(robot.structure, _origins(robot), strict=False)):
        way = _way(at_home[i, :3, 2])
        if letter == "P":
            yield f"- Joint {i + 1} slides {way}."
        else:
            yield f"- Joint {i + 1} turns about the axis through {origin}, {way}."


def _way(direction: Numbers) -> str:
    """Return a direction in words, in the axes of frame {0}."""
    for axis, name in enumerate(("x0", "y0", "z0")):
        if abs(direction[axis]) > 1 - _SAME:
            return f"along {name}" if direction[axis] > 0 else f"opposite to {name}"
    return _tilted(direction) or f"along ({', '.join(number_text(each) for each in direction)})"


def _tilted(direction: Numbers) -> str:
    """Return a direction between two axes, 15°, 30° or 45° from one of them; else an empty text.

    >>> _tilted(np.array([-0.5, 0, 0.75**0.5]))
    '30° from z0 towards -x0'
    """
    signed = [
        (abs(each), ("-" if each < 0 else "") + name)
        for each, name in zip(direction, ("x0", "y0", "z0"), strict=True)
    ]
    (least, _), (side, towards), (main, start) = sorted(signed, key=lambda each: each[0])
    angle = math.degrees(math.atan2(side, main))
    steps = round(angle / 15)
    if least > _SAME or abs(angle - 15 * steps) > _SAME:
        return ""
    return f"{15 * steps}° from {start} towards {towards}"


def _origins(robot: HomeRobot) -> list[str]:
    """Return the origins of the frames {0} to {n} at home as texts."""
    constant = robot.frames()[:, :3, 3]
    shares = {name: robot.frames(**{name: 1.0})[:, :3, 3] - constant for name in robot.lengths()}
    return [
        "("
        + ", ".join(
            _sum_text(constant[i, k], {name: share[i, k] for name, share in shares.items()})
            for k in range(3)
        )
        + ")"
        for i in range(len(constant))
    ]


def _sum_text(constant: float, shares: Mapping[str, float]) -> str:
    terms = []
    for name, share in shares.items():
        if abs(share) < _SAME:
            continue
        if abs(abs(share) - 1) > _SAME:
            raise UnevenLettersError
        terms.append(("-" if share < 0 else "+", name))
    if abs(constant) > _SAME:
        terms.append(("-" if constant < 0 else "+", number_text(abs(constant))))
    if not terms:
        return "0"
    (sign, first), *others = terms
    return ("-" if sign == "-" else "") + first + "".join(f" {s} {t}" for s, t in others)


def number_text(value: float) -> str:
    """Return a number with at most six decimals.

    >>> number_text(-0.4250000001), number_text(-1e-12)
    ('-0.425', '0')
    """
    text = f"{value:.6f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text
