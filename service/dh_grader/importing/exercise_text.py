"""The text of an exercise file for a robot, and the robot as URDF or as a script.

Rounded numbers become exact: 1.5708 becomes π/2.
"""

import json
import math
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final
from xml.sax.saxutils import quoteattr

import numpy as np

from dh_grader.kinematics import (
    ALPHA,
    COLUMNS,
    THETA,
    A,
    Convention,
    D,
    Matrices,
    Numbers,
    Row,
    Table,
    frames,
    links,
    modified_rows,
)
from dh_grader.translations import (
    Sentence,
    SentenceValue,
    bulleted,
    joined,
    paragraph,
    say,
    template,
)

# --- Undo the rounding in robot files and tables: 1.5708 becomes π/2
#
# Numbers are snapped before any common normal is computed: two axes that should be parallel and are
# 0.000004 rad apart have a common normal kilometres away.


STEP: Final = math.radians(15)
NEAR: Final = 1e-4
_FEWEST_DECIMALS: Final = 2
_LENGTH_DECIMALS: Final = 5
# Smaller changes are errors of floating-point numbers, not of a file.
_LEAST_SNAP: Final = 1e-12


def snapped_angle(value: float, decimals: int = 0) -> float:
    """Return an angle in radians; a rounded multiple of 15° becomes exact.

    ``decimals`` is the number of decimals with which the angle was written in radians, or 0.

    >>> snapped_angle(1.57, 2) == math.pi / 2, snapped_angle(0.7847, 4)
    (True, 0.7847)
    """
    return _multiple(value) if is_multiple(value, decimals) else value


def is_multiple(value: float, decimals: int = 0) -> bool:
    """True if an angle in radians is a multiple of 15°, exact or rounded."""
    # A number is a rounded multiple if it is within 1e-4 of the multiple. A number with two or more
    # decimals is also a rounded multiple if it equals the multiple, rounded to the same number of
    # decimals.
    multiple = _multiple(value)
    rounded = round(multiple, decimals) if decimals >= _FEWEST_DECIMALS else multiple
    return abs(value - multiple) <= NEAR or abs(value - rounded) < _LEAST_SNAP


def _multiple(value: float) -> float:
    return round(value / STEP) * STEP


def decimals_of(text: str) -> int:
    """Return the number of decimals of a written number; 0 for a number such as 1e-3."""
    return len(text.partition(".")[2]) if "e" not in text.lower() else 0


def snapped_length(value: float) -> float:
    """Return a length in metres, rounded to 0.01 mm."""
    return round(value, _LENGTH_DECIMALS)


def snapped_direction(direction: Numbers) -> Numbers:
    """Return a unit vector in which entries near 0 are exactly 0."""
    kept = np.where(np.abs(direction) <= NEAR, 0.0, direction)
    return np.asarray(kept / np.linalg.norm(kept))


class Snaps:
    """The numbers that were changed, one by one, as remarks for the author."""

    def __init__(self) -> None:
        self.remarks: list[Sentence] = []

    def angle(self, place: str, value: float, written: str = "") -> float:
        """Return the snapped angle. ``written`` is its text in radians, if it was written so."""
        snapped = snapped_angle(value, decimals_of(written))
        self._note(place, value - snapped, written or angle_text(value), angle_text(snapped))
        return snapped

    def length(self, place: str, written: str) -> float:
        """Return the snapped length."""
        value = float(written)
        snapped = snapped_length(value)
        self._note(place, value - snapped, written, exact_text(snapped))
        return snapped

    def direction(self, place: str, direction: Numbers) -> Numbers:
        """Return the snapped direction."""
        snapped = snapped_direction(direction)
        change = float(np.abs(snapped - direction).max())
        self._note(place, change, _vector(direction), _vector(snapped))
        return snapped

    def _note(self, place: str, change: float, written: str, value: str) -> None:
        if abs(change) > _LEAST_SNAP and written != value:
            self.remarks.append(
                say("{place}: {written} became {value}.", place=place, written=written, value=value)
            )


def _vector(numbers: Sequence[float] | Numbers) -> str:
    return f"({', '.join(map(exact_text, numbers))})"


# --- Write numbers into statements and tables of exercise files


def number_text(value: float) -> str:
    """Return a number with at most six decimals, for a statement.

    >>> number_text(-0.4250000001), number_text(-1e-12)
    ('-0.425', '0')
    """
    return _text(value, 6)


def exact_text(value: float) -> str:
    """Return a number with at most twelve decimals, for a table.

    >>> exact_text(0.12345678), exact_text(131.2 * 0.001)
    ('0.12345678', '0.1312')
    """
    return _text(value, 12)


def _text(value: float, decimals: int) -> str:
    text = f"{value:.{decimals}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def angle_text(angle: float) -> str:
    """Return an angle in degrees, for a table.

    >>> angle_text(math.pi / 2), angle_text(-1e-15)
    ('90deg', '0')
    """
    # The rounding error is less than 1e-12 rad.
    text = _text(math.degrees(angle), 10)
    return text if text == "0" else f"{text}deg"


# --- Describe a robot in words: where each joint axis is, and which way it points
#
# The axes and the tool frame can be computed from these words alone.


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


# --- Write a robot as a URDF file, or as a script for the Robotics Toolbox for Python


_LIMIT = {"R": (-math.pi, math.pi), "P": (-1.0, 1.0)}


def urdf_text(robot: HomeRobot, name: str) -> str:
    """Return a URDF file of the robot.

    The file has joints, but no shapes and no masses. The link ``frame0`` is the base frame, and the
    last link is the tool frame.
    """
    # The file has the lengths of the table instead of letters.
    transforms = links(robot.table, Convention.STANDARD)
    before = np.eye(4)
    lines = [f"<robot name={quoteattr(name)}>", '  <link name="frame0"/>']
    for i, transform in enumerate(transforms):
        kind = robot.structure[i] if i < len(robot.structure) else ""
        # A joint turns about or slides along z before the constants of its row.
        lines += _joint(i + 1, kind, before, f"link{i}" if i else "frame0")
        before = transform
    return "\n".join([*lines, *_tool(len(transforms), before), "</robot>", ""])


def _joint(number: int, kind: str, origin: Matrices, parent: str) -> list[str]:
    types = {"R": "revolute", "P": "prismatic", "": "fixed"}
    moving = []
    if kind:
        low, high = _LIMIT[kind]
        moving = [
            '    <axis xyz="0 0 1"/>',
            f'    <limit lower="{low:.6g}" upper="{high:.6g}" effort="0" velocity="0"/>',
        ]
    return [
        f'  <link name="link{number}"/>',
        f'  <joint name="joint{number}" type="{types[kind]}">',
        f'    <parent link="{parent}"/>',
        f'    <child link="link{number}"/>',
        f"    {_origin(origin)}",
        *moving,
        "  </joint>",
    ]


def _tool(last: int, origin: Matrices) -> list[str]:
    return [
        '  <link name="tool"/>',
        '  <joint name="tool_joint" type="fixed">',
        f'    <parent link="link{last}"/>',
        '    <child link="tool"/>',
        f"    {_origin(origin)}",
        "  </joint>",
    ]


def _origin(pose: Matrices) -> str:
    rotation = pose[:3, :3]
    pitch = math.asin(float(np.clip(-rotation[2, 0], -1, 1)))
    if abs(rotation[2, 0]) > 1 - 1e-12:
        # Roll and yaw turn about one axis: all of the turn is yaw.
        roll, yaw = 0.0, math.atan2(-rotation[0, 1], rotation[1, 1])
    else:
        roll = math.atan2(rotation[2, 1], rotation[2, 2])
        yaw = math.atan2(rotation[1, 0], rotation[0, 0])
    return f'<origin xyz="{_words(pose[:3, 3])}" rpy="{_words([roll, pitch, yaw])}"/>'


def _words(numbers: Sequence[float] | Matrices) -> str:
    return " ".join(f"{float(number) + 0.0:.12g}" for number in numbers)


def toolbox_text(robot: HomeRobot, name: str) -> str:
    """Return a Python script that makes the robot with the Robotics Toolbox."""
    calls = []
    for i, row in enumerate(robot.table[: len(robot.structure)]):
        a, alpha, d, theta = (f"{float(row[j]) + 0.0:.12g}" for j in (A, ALPHA, D, THETA))
        if robot.structure[i] == "P":
            calls.append(f"PrismaticDH(a={a}, alpha={alpha}, theta={theta}, offset={d})")
        else:
            calls.append(f"RevoluteDH(a={a}, alpha={alpha}, d={d}, offset={theta})")
    lines = ["from roboticstoolbox import DHRobot, PrismaticDH, RevoluteDH", ""]
    lines += ["robot = DHRobot(", "    ["]
    lines += [f"        {call}," for call in calls]
    lines += ["    ],", f"    name={name!r},", ")"]
    for row in robot.table[len(robot.structure) :]:
        numbers = links(row[None], Convention.STANDARD)[0]
        matrix = ", ".join(f"[{', '.join(_words(line).split())}]" for line in numbers)
        lines.append(f"robot.tool = [{matrix}]")
    return "\n".join([*lines, "print(robot)", ""])


_WIDTH = 104
_POINTS_OF_A_ROW = 2
_MINUTES_A_ROW = 6
_INDUSTRIAL = 6
# Half of the last decimal that a statement shows, in metres.
_NO_LENGTH = 5e-7
# x1 turns over between row 1 and row 2.
_ROWS_TO_TURN = 2
_MEANINGS = {"a": "distance between two axes", "d": "distance along an axis"}


@dataclass(frozen=True)
class Draft:
    """The author's choices for a new exercise.

    ``typed`` has the cells of the author's own table, if it is another one than the robot's.
    """

    title: str
    source: str
    convention: Convention = Convention.STANDARD
    remarks: Sequence[str] = ()
    typed: Sequence[Row[str]] = ()


def lettered(robot: HomeRobot) -> HomeRobot:
    """Return the robot with a letter for each length that is not 0, such as a2 and d4.

    A length along the axis of a sliding joint gets h3 instead of d3, which is its variable.
    """
    table = robot.table.copy()
    letters, lengths = {}, {}
    for i, j in np.argwhere(np.abs(table) > _NO_LENGTH).tolist():
        if j not in (A, D):
            continue
        slides = j == D and robot.structure[i : i + 1] == "P"
        name = f"{'h' if slides else COLUMNS[j]}{i + 1}"
        letters[i, j] = {name: math.copysign(1.0, table[i, j])}
        lengths[name] = abs(float(table[i, j]))
        table[i, j] = 0
    return replace(robot, table=table, letters=letters, lengths=lengths)


def exercise_text(robot: HomeRobot, draft: Draft) -> str:
    """Return an exercise file that asks for the table and the pose of the robot."""
    statement = home_statement(robot, draft.convention)
    rows = rows_in(robot, draft.convention)
    joint_count, tool = len(robot.structure), tool_label(robot, draft.convention)
    points = _POINTS_OF_A_ROW * len(rows)
    asked = "one row for each joint" + (
        ", and a row e for the tool frame" if len(rows) > joint_count else ""
    )
    remarks = "".join(f"# {_plain(remark)}\n" for remark in draft.remarks)
    return f"""{remarks}title = {_string(draft.title)}
source = {_string(draft.source)}
level = "{_level(robot)}"
minutes = {_MINUTES_A_ROW * len(rows)}
summary = {_string(_summary(robot))}

statement = \"\"\"
{_wrapped(statement)}
\"\"\"

[robot]
structure = {_string(robot.structure)}
convention = {_string(draft.convention.value)}
joints = {json.dumps(robot.variables)}
table = [
    # a, alpha, d, theta
{_table(rows)}
]
{_symbols(robot)}
[[parts]]
id = "table"
kind = "dh_table"
title = "Denavit-Hartenberg table"
prompt = "Give the {draft.convention.value} DH table, {asked}."
points = {points}
convention = {_string(draft.convention.value)}
frames = "free"

[[parts]]
id = "pose"
kind = "transform"
title = "Pose of the tool"
prompt = "Give the homogeneous transform from frame {{0}} to frame {{{tool}}}."
points = {points}
follows = "table"

[[checks]]
title = "The table of this file"
kind = "right"
answers.table = {_answer(rows)}
{_typed_check(draft.typed)}{_equivalent_check(robot, draft.convention)}"""


def _answer(rows: Sequence[Row[str]]) -> str:
    lines = ["a, alpha, d, theta", *(", ".join(row) for row in rows)]
    return '"""\n' + "\n".join(lines) + '\n"""'


def _typed_check(typed: Sequence[Row[str]]) -> str:
    if not typed:
        return ""
    return f"""
[[checks]]
title = "The table as it was imported"
kind = "equivalent"
answers.table = {_answer(typed)}
"""


def _equivalent_check(robot: HomeRobot, convention: Convention) -> str:
    """Return a check with another valid table, in which x1 is reversed."""
    # This table is valid, too.
    if len(robot.table) < _ROWS_TO_TURN:
        return ""
    table = robot.table.copy()
    table[0, [A, ALPHA]] *= -1
    table[0, THETA] += math.pi
    table[1, THETA] -= math.pi
    letters = dict(robot.letters)
    if (0, A) in letters:
        letters[0, A] = {name: -factor for name, factor in letters[0, A].items()}
    rows = rows_in(replace(robot, table=table, letters=letters), convention)
    return f"""
[[checks]]
title = "The same robot with x1 turned over"
kind = "equivalent"
answers.table = {_answer(rows)}
"""


def rows_in(robot: HomeRobot, convention: Convention) -> list[Row[str]]:
    """Return the cells of the robot's DH table in a convention, as texts."""
    rows = _rows(robot)
    if convention is Convention.MODIFIED:
        rows = modified_rows(rows, "0")
        a, alpha = robot.start
        first = sum_text(robot.letters.get((-1, A), {}), exact_text(a)), angle_text(alpha)
        rows[0] = (*first, *rows[0][2:])
        if set(rows[-1]) == {"0"}:
            rows.pop()
    return rows


def _level(robot: HomeRobot) -> str:
    return "industrial" if len(robot.structure) >= _INDUSTRIAL else "arms"


def _summary(robot: HomeRobot) -> str:
    lengths = "lengths as letters" if robot.letters else "lengths in metres"
    return f"{len(robot.structure)} joints ({robot.structure}), {lengths}."


def _rows(robot: HomeRobot) -> list[Row[str]]:
    rows = []
    for i, row in enumerate(robot.table.tolist()):
        sums: list[dict[str, float]] = [dict(robot.letters.get((i, j), {})) for j in range(4)]
        if i < len(robot.structure):
            j = D if robot.structure[i] == "P" else THETA
            sums[j] = {robot.variables[i]: 1.0, **sums[j]}
        cells = zip(sums, row, strict=True)
        a, alpha, d, theta = (
            sum_text(letters, angle_text(number) if j in (ALPHA, THETA) else exact_text(number))
            for j, (letters, number) in enumerate(cells)
        )
        rows.append((a, alpha, d, theta))
    return rows


def _table(rows: Sequence[Row[str]]) -> str:
    quoted = [[_string(cell) for cell in row] for row in rows]
    widths = [max(len(row[j]) + 1 for row in quoted) for j in range(len(COLUMNS))]
    lines = [
        "".join(f"{cell + ',':{width}} " for cell, width in zip(row[:-1], widths, strict=False))
        + row[-1]
        for row in quoted
    ]
    return "\n".join(f"    [{line}]," for line in lines)


def _symbols(robot: HomeRobot) -> str:
    """Return the section ``[symbols]`` of an exercise file."""
    # It has the variables of sliding joints and the letters, with ranges.
    lines = []
    for i, kind in enumerate(robot.structure):
        if kind == "P":
            lines.append(
                f'{robot.variables[i]} = {{ kind = "length", unit = "m", range = [0.1, 0.6], '
                f'description = "displacement of joint {i + 1}" }}'
            )
    along = {name for (_, j), letters in robot.letters.items() if j == D for name in letters}
    across = {name for (_, j), letters in robot.letters.items() if j == A for name in letters}
    for name, length in robot.lengths.items():
        low, high = (exact_text(float(f"{factor * length:.3g}")) for factor in (0.7, 1.3))
        meaning = _MEANINGS["a" if name in across else "d"]
        if name in across & along:
            meaning = "length of links"
        if robot.real:
            meaning += f" ({number_text(length)} m on the real robot)"
        lines.append(
            f'{name} = {{ kind = "length", unit = "m", range = [{low}, {high}], '
            f'description = "{meaning}" }}'
        )
    return "\n[symbols]\n" + "\n".join(lines) + "\n" if lines else ""


def _wrapped(statement: str) -> str:
    blocks = []
    for block in statement.split("\n\n"):
        lines = block.split("\n")
        blocks.append(
            "\n".join(
                textwrap.fill(line, _WIDTH, subsequent_indent="  " if line[:2] == "- " else "")
                for line in lines
            )
        )
    return "\n\n".join(blocks)


def _string(text: str) -> str:
    """Return a TOML string."""
    return json.dumps(_plain(text), ensure_ascii=False)


def _plain(text: str) -> str:
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())
