"""`dh-grader exercises export`: the robot of an exercise as URDF or as a script."""

from enum import StrEnum
from typing import Annotated

import numpy as np
import typer

from service.catalogue.robots.robot import Robot
from service.cli.terminal import give_up, named_exercise, stdout
from service.figures.geometry.symbol_numbers import drawing_numbers
from service.importing.export import toolbox_text, urdf_text
from service.importing.home_statement import HomeRobot
from service.kinematics.dh import Convention
from service.translations import say


class ExportFormat(StrEnum):
    """The format of an exported robot: a URDF file, or a script for the Robotics Toolbox."""

    URDF = "urdf"
    TOOLBOX = "toolbox"


def command(
    exercise_id: Annotated[str, typer.Argument(metavar="ID|FILE", show_default=False)],
    target: Annotated[
        ExportFormat,
        typer.Option("--format", help="A URDF file, or a script for the Robotics Toolbox."),
    ] = ExportFormat.URDF,
) -> None:
    """Print the robot of an exercise as URDF, or as a Python script for the Robotics Toolbox.

    Letters get the lengths with which the robot is drawn.
    """
    exercise = named_exercise(exercise_id)
    robot = exercise.reference
    if not isinstance(robot, Robot):
        give_up(say("the exercise {id} has no robot with a DH table", id=exercise.id))
    table = robot.tables.get(Convention.STANDARD)
    if table is None:
        give_up(say("the robot of {id} has no standard DH table", id=exercise.id))
    numbers = drawing_numbers(exercise.variables)
    numbers |= {joint.variable: 0.0 for joint in robot.joints}
    values = table.values({name: np.array([number]) for name, number in numbers.items()}, 1)
    at_home = HomeRobot(values[:, :, 0], robot.structure, {})
    write = urdf_text if target is ExportFormat.URDF else toolbox_text
    stdout().print(write(at_home, exercise.id), soft_wrap=True, end="")
