"""Describe a robot in words: where each joint axis is, and which way it points.

The axes and the tool frame can be computed from these words alone.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from service.kinematics.chain import ALPHA, A, Table, frames
from service.kinematics.dh import Convention
from service.kinematics.transforms import Matrices, Numbers
from service.translations import Sentence, bulleted, joined, paragraph, say, template
from service.translations.sentence import SentenceValue

_SAME = 1e-6
# The numbers of joints, from one.
_REVOLUTE = (
    template("one revolute joint"),
    template("two revolute joints"),
    template("three revolute joints"),
    template("four revolute joints"),
    template("five revolute joints"),
    template("six revolute joints"),
    template("seven revolute joints"),
    template("eight revolute joints"),
    template("nine revolute joints"),
    template("ten revolute joints"),
)
_PRISMATIC = (
    template("one prismatic joint"),
    template("two prismatic joints"),
    template("three prismatic joints"),
    template("four prismatic joints"),
    template("five prismatic joints"),
    template("six prismatic joints"),
    template("seven prismatic joints"),
    template("eight prismatic joints"),
    template("nine prismatic joints"),
    template("ten prismatic joints"),
)
Letters = Mapping[tuple[int, int], str]


@dataclass(frozen=True, slots=True)
class _Way:
    slides: str
    turns: str
    points: str
    its_points: str
    values: Mapping[str, SentenceValue]


@dataclass(frozen=True)
class HomeRobot:
    """A standard DH table of constants, the joints' types, and letters in place of some lengths.

    ``letters`` has the letter of a cell by row and column. An additional last row is a fixed tool
    frame.
    """

    # A minus sign in the table stays in front of the letter. A number as text may take the place of
    # a letter: the statement then has sums such as "0.2 + 0.35".

    table: Table
    structure: str
    letters: Letters
    real: bool = False
    """True if the lengths are those of a real robot."""

    def lengths(self) -> dict[str, float]:
        """The value of each letter, which is a length."""
        return {name: abs(float(self.table[cell])) for cell, name in self.letters.items()}

    def frames(self, **lengths: float) -> Matrices:
        """Return the poses of the frames {0} to {n} at home. Letters not in ``lengths`` are 0."""
        table = self.table.copy()
        for cell, name in self.letters.items():
            table[cell] = np.sign(table[cell]) * lengths.get(name, 0.0)
        return frames(table, Convention.STANDARD)


class UnevenLettersError(ValueError):
    """A coordinate contains a letter with a factor other than 1 or -1."""

    # The text would be unreadable.


def home_statement(robot: HomeRobot, convention: Convention) -> Sentence:
    """Return the statement of an exercise about the robot.

    Raises UnevenLettersError if a coordinate is not a sum of letters.
    """
    lettered = any(name[0].isalpha() for name in robot.letters.values())
    at_home = paragraph(
        _structure_in_words(robot.structure),
        "" if lettered else say("All lengths are in metres."),
        say("At home all joint variables are 0."),
        say("These are the axes at home, in the base frame {{0}}:"),
    )
    positive = say(
        "Each joint variable counts positive about or along the direction that is named."
    )
    tool_frame = tool_label(robot, convention)
    given = paragraph(
        say("The base frame {{0}} and the tool frame {{{tool}}} are given.", tool=tool_frame),
        _tool_in_words(robot, tool_frame),
        say("The frames on the joints are yours to choose by the standard convention.")
        if convention is Convention.STANDARD
        else say("The frames on the joints are yours to choose by the modified convention."),
    )
    return joined("\n\n", [at_home, bulleted([*_joints_in_words(robot)]), positive, given])


def tool_label(robot: HomeRobot, convention: Convention) -> str:
    """Return the label of the tool frame: "e", or else the number of the last row."""
    # It is "e" if a fixed row leads to the tool frame. In the modified convention, frame n is on
    # the last axis. If the tool frame is not on this axis, the table has a row e.
    last_a, last_alpha = robot.table[-1, [A, ALPHA]]
    fixed = convention is Convention.MODIFIED and max(abs(last_a), abs(last_alpha)) > _SAME
    return "e" if fixed or len(robot.table) > len(robot.structure) else str(len(robot.table))


def _structure_in_words(structure: str) -> Sentence:
    revolute, prismatic = structure.count("R"), structure.count("P")
    if revolute and prismatic:
        return say(
            "The robot has {revolute} and {prismatic} ({structure}).",
            revolute=say(_REVOLUTE[revolute - 1]),
            prismatic=say(_PRISMATIC[prismatic - 1]),
            structure=structure,
        )
    joints = _REVOLUTE[revolute - 1] if revolute else _PRISMATIC[prismatic - 1]
    return say("The robot has {joints} ({structure}).", joints=say(joints), structure=structure)


def _joints_in_words(robot: HomeRobot) -> Iterator[Sentence]:
    at_home = robot.frames(**robot.lengths())
    for i, (letter, origin) in enumerate(zip(robot.structure, _origins(robot), strict=False)):
        way = _way(at_home[i, :3, 2])
        if letter == "P":
            yield say(way.slides, joint=i + 1, **way.values)
        else:
            yield say(way.turns, joint=i + 1, point=origin, **way.values)


def _tool_in_words(robot: HomeRobot, tool_frame: str) -> Sentence:
    *_, origin = _origins(robot)
    end = robot.frames(**robot.lengths())[-1]
    x, z = _way(end[:3, 0]), _way(end[:3, 2])
    if tool_frame == "e":
        x_points = say(x.its_points, axis="x", **x.values)
        z_points = say(z.its_points, axis="z", **z.values)
    else:
        x_points = say(x.points, axis=f"x{tool_frame}", **x.values)
        z_points = say(z.points, axis=f"z{tool_frame}", **z.values)
    return say(
        "At home the origin of {{{tool}}} is at {point}, {x_points} and {z_points}.",
        tool=tool_frame,
        point=origin,
        x_points=x_points,
        z_points=z_points,
    )


def _way(direction: Numbers) -> _Way:
    for axis, name in enumerate(("x0", "y0", "z0")):
        if abs(direction[axis]) > 1 - _SAME:
            return _along(name) if direction[axis] > 0 else _opposite(name)
    numbers = f"({', '.join(number_text(each) for each in direction)})"
    return _tilted(direction) or _along(numbers)


def _along(direction: str) -> _Way:
    return _Way(
        template("Joint {joint} slides along {direction}."),
        template("Joint {joint} turns about the axis through {point}, along {direction}."),
        template("{axis} points along {direction}"),
        template("its {axis} axis points along {direction}"),
        {"direction": direction},
    )


def _opposite(direction: str) -> _Way:
    return _Way(
        template("Joint {joint} slides opposite to {direction}."),
        template("Joint {joint} turns about the axis through {point}, opposite to {direction}."),
        template("{axis} points opposite to {direction}"),
        template("its {axis} axis points opposite to {direction}"),
        {"direction": direction},
    )


def _tilted(direction: Numbers) -> _Way | None:
    """Return a direction between two axes in words, or None if its angle is unusual.

    >>> _tilted(np.array([-0.5, 0, 0.75**0.5])).values
    {'angle': 30, 'start': 'z0', 'towards': '-x0'}
    """
    signed = [
        (abs(each), ("-" if each < 0 else "") + name)
        for each, name in zip(direction, ("x0", "y0", "z0"), strict=True)
    ]
    (least, _), (side, towards), (main, start) = sorted(signed, key=lambda each: each[0])
    angle = math.degrees(math.atan2(side, main))
    steps = round(angle / 15)
    if least > _SAME or abs(angle - 15 * steps) > _SAME:
        return None
    return _Way(
        template("Joint {joint} slides {angle}° from {start} towards {towards}."),
        template(
            "Joint {joint} turns about the axis through {point}, {angle}° from {start} towards "
            "{towards}."
        ),
        template("{axis} points {angle}° from {start} towards {towards}"),
        template("its {axis} axis points {angle}° from {start} towards {towards}"),
        {"angle": 15 * steps, "start": start, "towards": towards},
    )


def _origins(robot: HomeRobot) -> list[str]:
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
