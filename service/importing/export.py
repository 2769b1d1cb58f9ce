"""Write a robot as a URDF file, or as a script for the Robotics Toolbox for Python."""

import math
from collections.abc import Sequence
from xml.sax.saxutils import quoteattr

import numpy as np

from service.importing.home_statement import HomeRobot
from service.kinematics.chain import ALPHA, THETA, A, D, links
from service.kinematics.dh import Convention
from service.kinematics.transforms import Matrices

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
