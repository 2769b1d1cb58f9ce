"""Describe a robot in words: where each joint axis is, and which way it points.

The axes and the tool frame can be computed from these words alone.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from service.importing.numbers import exact_text, number_text
from service.kinematics.chain import ALPHA, A, D, Table, frames
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
# A sum of letters: the factor of each letter.
LetterSum = Mapping[str, float]
Letters = Mapping[tuple[int, int], LetterSum]


@dataclass(frozen=True, slots=True)
class _Way:
    slides: str
    turns: str
    points: str
    its_points: str
    values: Mapping[str, SentenceValue]


@dataclass(frozen=True)
class HomeRobot:
    """A standard DH table of constants, and the joints' types.

    ``letters`` has the sum of letters that is added to a length of the table, by row and column;
    ``lengths`` has a typical length for each letter. An additional last row is a fixed tool frame.
    ``start`` are a and α from the base frame to the axis of joint 1, which are not 0 only in the
    modified convention; the letters of this a are in row -1.
    """

    # A number as text may take the place of a letter: the statement then has sums such as
    # "0.2 + 0.35".

    table: Table
    structure: str
    letters: Letters = field(default_factory=dict)
    lengths: Mapping[str, float] = field(default_factory=dict)
    start: tuple[float, float] = (0.0, 0.0)
    real: bool = False
    """True if the lengths are those of a real robot."""

    @property
    def variables(self) -> list[str]:
        """The names of the joint variables, such as theta1 and d2 for RP.

        A sliding joint has the variable q2 if d2 is the letter of a length.
        """
        letters = {name.replace("_", "") for name in self.lengths}
        return [
            f"theta{i}" if kind == "R" else f"q{i}" if f"d{i}" in letters else f"d{i}"
            for i, kind in enumerate(self.structure, 1)
        ]

    @property
    def has_numbers(self) -> bool:
        """True if a length is written as a number."""
        of_letters = any(name[0].isalpha() for name in self.lengths)
        return bool(self.table[:, [A, D]].any() or self.start[0]) or not of_letters

    def frames(self, lengths: Mapping[str, float]) -> Matrices:
        """Return the frames on the joint axes and the tool frame at home, in the base frame.

        Letters not in ``lengths`` are 0.
        """
        rows = np.vstack([[*self.start, 0, 0], self.table])
        for (i, j), letters in self.letters.items():
            rows[i + 1, j] += sum(factor * lengths.get(name, 0) for name, factor in letters.items())
        return frames(rows, Convention.STANDARD)[1:]


class UnevenLettersError(ValueError):
    """A coordinate of a real robot contains a letter with a factor such as 0.707107."""

    # The text would be unreadable.


def home_statement(robot: HomeRobot, convention: Convention) -> Sentence:
    """Return the statement of an exercise about the robot.

    Raises UnevenLettersError if a coordinate of a real robot is not a sum of letters.
    """
    at_home = paragraph(
        _structure_in_words(robot.structure),
        say("All lengths are in metres.") if robot.has_numbers else "",
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
    last = len(robot.table) - 1
    last_a, last_alpha = robot.table[last, [A, ALPHA]]
    begins_apart = max(abs(last_a), abs(last_alpha)) > _SAME or (last, A) in robot.letters
    fixed = convention is Convention.MODIFIED and begins_apart
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
    at_home = robot.frames(robot.lengths)
    for i, (letter, origin) in enumerate(zip(robot.structure, _origins(robot), strict=False)):
        way = _way(at_home[i, :3, 2])
        if letter == "P":
            yield say(way.slides, joint=i + 1, **way.values)
        else:
            yield say(way.turns, joint=i + 1, point=origin, **way.values)


def _tool_in_words(robot: HomeRobot, tool_frame: str) -> Sentence:
    *_, origin = _origins(robot)
    end = robot.frames(robot.lengths)[-1]
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
    constant = robot.frames({})[:, :3, 3]
    shares = {name: robot.frames({name: 1.0})[:, :3, 3] - constant for name in robot.lengths}
    return [
        "("
        + ", ".join(
            _coordinate(robot, constant[i, k], {name: each[i, k] for name, each in shares.items()})
            for k in range(3)
        )
        + ")"
        for i in range(len(constant))
    ]


def _coordinate(robot: HomeRobot, constant: float, shares: Mapping[str, float]) -> str:
    factors = {name: share for name, share in shares.items() if abs(share) > _SAME}
    uneven = any(abs(4 * factor - round(4 * factor)) > _SAME for factor in factors.values())
    if uneven and robot.real:
        # A real robot has numbers, which are easier to read.
        raise UnevenLettersError
    rounded = {name: round(factor, 6) for name, factor in factors.items()}
    return sum_text(rounded, number_text(constant))


def sum_text(letters: LetterSum, number: str) -> str:
    """Return a sum of letters and a number as text.

    >>> sum_text({"a1": 1.0, "a2": -2.0}, "-0.5"), sum_text({}, "0")
    ('a1 - 2 a2 - 0.5', '0')
    """
    terms = []
    for name, factor in letters.items():
        times = "" if abs(factor) == 1 else f"{exact_text(abs(factor))} "
        terms.append(("-" if factor < 0 else "+", times + name))
    if number != "0":
        terms.append(("-" if number.startswith("-") else "+", number.removeprefix("-")))
    if not terms:
        return "0"
    (sign, first), *others = terms
    return ("-" if sign == "-" else "") + first + "".join(f" {s} {t}" for s, t in others)
