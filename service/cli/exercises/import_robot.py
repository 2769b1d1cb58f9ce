"""`dh-grader exercises import`: a robot from a URDF file or a pasted table -> an exercise file."""

from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from service.authoring import UnusableIdError, template
from service.catalogue.files.regular_file import read_regular
from service.cli.exercises.new_file import write_new
from service.cli.terminal import give_up, stdout
from service.importing.axes import UnclearAxesError, home_axes
from service.importing.exercise_text import Draft, exercise_text, letters_for
from service.importing.frames import Placed, greatest_difference, placed
from service.importing.home_statement import HomeRobot, UnevenLettersError, number_text
from service.importing.pasted_robot import UnusableTableError, robot_of_table
from service.importing.urdf import MOST_BYTES, UnusableUrdfError, read_urdf, tips
from service.kinematics.dh import Convention

_LARGEST_DIFFERENCE = 1e-3
_SAME = 1e-6


def command(
    file: Annotated[Path, typer.Argument(help="A URDF file, or with --table a DH table.")],
    exercise_id: Annotated[
        str, typer.Option("--id", metavar="ID", help="The id of the exercise: its file's name.")
    ] = "",
    tip: Annotated[str, typer.Option(metavar="LINK", help="The link of the tool.")] = "",
    base: Annotated[
        str, typer.Option(metavar="LINK", help="The first link. Default: the root of the file.")
    ] = "",
    table: Annotated[
        bool, typer.Option("--table", help="The file has a DH table, as students paste it.")
    ] = False,
    letters: Annotated[
        bool, typer.Option("--letters", help="Write letters for the lengths instead of numbers.")
    ] = False,
    convention: Annotated[
        Convention, typer.Option(help="The convention of the exercise (and of a table).")
    ] = Convention.STANDARD,
    title: Annotated[str, typer.Option(help="The title of the exercise.")] = "",
    source: Annotated[str, typer.Option(help="Where the robot comes from.")] = "",
    output: Annotated[
        Path, typer.Option(metavar="FOLDER", help="The folder; created if missing.")
    ] = Path(),
) -> None:
    """Make an exercise from a robot's URDF file, or from a DH table.

    Prints the largest difference between the table and the URDF at 100 random poses. Refuses more
    than 1 mm.
    """
    name = exercise_id or file.stem
    try:
        template(name)
        data = read_regular(file, MOST_BYTES)
    except UnusableIdError as error:
        give_up(str(error))
    except OSError as error:
        give_up(f"{file}: cannot be read: {error.strerror}")
    if not data:
        give_up(f"{file}: the file is empty")
    remarks: list[str] = []
    try:
        if table:
            robot = robot_of_table(data.decode("utf-8", errors="replace"), convention)
        else:
            robot, remarks = _robot_of_urdf(data, tip, base, letters=letters)
        draft = Draft(title or name, source or f"Imported from {file.name}", convention, remarks)
        text = exercise_text(robot, draft)
    except (UnusableUrdfError, UnclearAxesError, UnusableTableError) as error:
        give_up(f"{file}: {error}")
    except UnevenLettersError:
        give_up(f"{file}: with these angles, letters give no readable statement; omit --letters")
    made = write_new(output, name, text)
    for remark in remarks:
        stdout().print(remark, soft_wrap=True)
    stdout().print(
        f"{made} is written. Read its statement, then: dh-grader exercises check {made}",
        soft_wrap=True,
    )


def _robot_of_urdf(
    data: bytes, tip: str, base: str, *, letters: bool
) -> tuple[HomeRobot, list[str]]:
    """Return the robot of a URDF file, and remarks on its accuracy and its ends."""
    if not tip:
        ends = tips(data)
        if len(ends) != 1:
            raise UnusableUrdfError(
                f"name the tool's link by --tip; the tree ends at: {', '.join(ends[:20])}"
            )
        [tip] = ends
    arm, exact = read_urdf(data, tip, base or None)
    frames = placed(*home_axes(arm))
    length, angle = greatest_difference(frames, arm.structure, exact.pose)
    if not length <= _LARGEST_DIFFERENCE:
        raise UnusableUrdfError(
            f"the table would differ by {1000 * length:.2f} mm from the file; 1 mm is allowed"
        )
    accuracy = (
        f"Largest difference to the URDF at 100 poses: {1000 * length:.4f} mm, "
        f"{np.degrees(angle):.4f} degrees."
    )
    remarks = [accuracy, *_ends(frames, arm.base, arm.tip, len(arm.structure))]
    chosen = letters_for(frames.table) if letters else {}
    return HomeRobot(frames.table, arm.structure, chosen, real=True), remarks


def _ends(frames: Placed, base: str, tip: str, last: int) -> list[str]:
    """Return where the exercise's first and last frame lie if they are not those of the file."""
    remarks = []
    for pose, frame, link in ((frames.base, "{0}", base), (frames.tool, f"{{{last}}}", tip)):
        if np.abs(pose - np.eye(4)).max() > _SAME:
            rows = "; ".join(" ".join(number_text(each) for each in row) for row in pose[:3])
            words = f"frame {frame} in the link {link}" if link == base else f"{link} in {frame}"
            remarks.append(f"A constant transform is left out, {words}: {rows}.")
    return remarks
