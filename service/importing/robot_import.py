"""Make the text of an exercise file from a URDF file or a pasted DH table."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from service.importing.axes import UnclearAxesError, home_axes
from service.importing.exercise_text import Draft, exercise_text, letters_for
from service.importing.frames import Placed, greatest_difference, placed
from service.importing.home_statement import HomeRobot, UnevenLettersError, number_text
from service.importing.pasted_robot import UnusableTableError, robot_of_table
from service.importing.urdf import UnusableUrdfError, read_urdf, tips
from service.kinematics.dh import Convention
from service.translations import say

_LARGEST_DIFFERENCE: Final = 1e-3
_SAME: Final = 1e-6
_MOST_LINKS: Final = 20
_LONGEST_LINK: Final = 60
_UNEVEN: Final = say("with these angles, letters give no readable statement; do without letters")


class RefusedRobotError(ValueError):
    """The robot cannot become an exercise; the message says why."""


class SeveralTipsError(RefusedRobotError):
    """The robot has several possible tips, and the author has not chosen one."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ImportOptions:
    """The author's choices. ``base`` and ``tip`` are links in a URDF file."""

    title: str
    source: str
    convention: Convention = Convention.STANDARD
    base: str = ""
    tip: str = ""
    letters: bool = False


@dataclass(frozen=True, slots=True)
class ImportedRobot:
    """The text of an exercise file, and remarks for its author."""

    text: str
    remarks: Sequence[str] = ()


def imported_urdf(data: bytes, options: ImportOptions) -> ImportedRobot:
    """Return an exercise about the robot of a URDF file.

    Raises RefusedRobotError or SeveralTipsError.
    """
    try:
        tip = options.tip
        if not tip:
            ends = tips(data)
            if len(ends) != 1:
                raise SeveralTipsError(
                    say("name the tool's link; the tree ends at: {links}", links=_shown(ends))
                )
            [tip] = ends
        arm, exact = read_urdf(data, tip, options.base or None)
        frames = placed(*home_axes(arm))
    except (UnusableUrdfError, UnclearAxesError) as error:
        raise RefusedRobotError(error.args[0]) from error
    length, angle = greatest_difference(frames, arm.structure, exact.pose)
    if not length <= _LARGEST_DIFFERENCE:
        raise RefusedRobotError(
            say(
                "the table would differ by {length} mm from the file; 1 mm is allowed",
                length=f"{1000 * length:.2f}",
            )
        )
    accuracy = say(
        "Largest difference to the URDF at 100 poses: {length} mm, {angle} degrees.",
        length=f"{1000 * length:.4f}",
        angle=f"{np.degrees(angle):.4f}",
    )
    remarks = [accuracy, *_ends(frames, arm.base, arm.tip, len(arm.structure))]
    letters = letters_for(frames.table) if options.letters else {}
    return _written(HomeRobot(frames.table, arm.structure, letters, real=True), options, remarks)


def imported_table(text: str, options: ImportOptions) -> ImportedRobot:
    """Return an exercise about the robot of a pasted DH table. Raises RefusedRobotError."""
    try:
        robot = robot_of_table(text, options.convention)
    except UnusableTableError as error:
        raise RefusedRobotError(error.args[0]) from error
    return _written(robot, options, [])


def _shown(links: Sequence[str]) -> str:
    return ", ".join(link[:_LONGEST_LINK] for link in links[:_MOST_LINKS])


def _written(robot: HomeRobot, options: ImportOptions, remarks: Sequence[str]) -> ImportedRobot:
    draft = Draft(options.title, options.source, options.convention, remarks)
    try:
        return ImportedRobot(exercise_text(robot, draft), remarks)
    except UnevenLettersError as error:
        raise RefusedRobotError(_UNEVEN) from error


def _ends(frames: Placed, base: str, tip: str, last: int) -> list[str]:
    remarks: list[str] = []
    for pose, frame, link in ((frames.base, "{0}", base), (frames.tool, f"{{{last}}}", tip)):
        if np.abs(pose - np.eye(4)).max() > _SAME:
            rows = "; ".join(" ".join(number_text(each) for each in row) for row in pose[:3])
            where = say("frame {frame} in the link {link}", frame=frame, link=link)
            if link != base:
                where = say("{link} in {frame}", link=link, frame=frame)
            left_out = say(
                "A constant transform is left out, {where}: {rows}.", where=where, rows=rows
            )
            remarks.append(left_out)
    return remarks
