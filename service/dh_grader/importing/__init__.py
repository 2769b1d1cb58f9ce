"""Make the text of an exercise file from a URDF file or a pasted DH table."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final, Literal, Self

import numpy as np

from dh_grader.catalogue import CatalogueError
from dh_grader.catalogue.load import read_exercise
from dh_grader.catalogue.robot import Robot
from dh_grader.expressions import AngleUnit
from dh_grader.importing.exercise_text import (
    Draft,
    HomeRobot,
    Snaps,
    UnevenLettersError,
    exercise_text,
    lettered,
    number_text,
)
from dh_grader.importing.pasted_robot import (
    OpenQuestionsError,
    PastedRobot,
    Question,
    TableChoices,
    UnusableTableError,
    pasted_robot,
)
from dh_grader.importing.urdf import (
    Placed,
    UnclearAxesError,
    UnusableUrdfError,
    greatest_difference,
    home_axes,
    placed,
    read_urdf,
    tips,
)
from dh_grader.kinematics import ALPHA, COLUMNS, THETA, Convention, Row, Table, pose
from dh_grader.translations import say

_LARGEST_DIFFERENCE: Final = 1e-3
_SAME: Final = 1e-6
_MOST_LINKS: Final = 20
_LONGEST_LINK: Final = 60
_UNEVEN: Final = say("with these angles, letters give no readable statement; do without letters")
_POSES: Final = 100
_SAME_TABLE: Final = 1e-9


class RefusedRobotError(ValueError):
    """The robot cannot become an exercise; the message says why."""


class SeveralTipsError(RefusedRobotError):
    """The robot has several possible tips, and the author has not chosen one."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ImportOptions:
    """The author's choices. ``base`` and ``tip`` are links in a URDF file.

    ``order`` and ``unit`` (of lengths) and ``angles`` say what a DH table leaves open. Without
    ``convention``, it is the convention that a table names, or else the standard one.
    """

    title: str
    source: str
    convention: Convention | None = None
    base: str = ""
    tip: str = ""
    letters: bool = False
    order: str = ""
    unit: str = ""
    angles: Literal["", AngleUnit] = ""

    def with_answers(self, answers: Mapping[str, str]) -> Self:
        """Return the choices with answers to questions, by the names of the questions."""
        values: dict[str, Any] = dict(answers)
        if "convention" in values:
            values["convention"] = Convention(values["convention"])
        return replace(self, **values)


@dataclass(frozen=True, slots=True)
class ImportedRobot:
    """The text of an exercise file, and remarks for its author.

    If the text of a table leaves something open, there are only ``questions``.
    """

    text: str = ""
    remarks: Sequence[str] = ()
    questions: Sequence[Question] = ()


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
        snaps = Snaps()
        arm, exact = read_urdf(data, tip, options.base or None, snaps=snaps)
        frames = placed(*home_axes(arm), snaps)
    except (UnusableUrdfError, UnclearAxesError) as error:
        raise RefusedRobotError(error.args[0]) from error
    frames = replace(frames, table=_written_numbers(frames.table))
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
    remarks = [
        accuracy,
        *snaps.remarks,
        *_ends(frames, arm.base, arm.tip, len(arm.structure)),
    ]
    robot = HomeRobot(frames.table, arm.structure, real=True)
    convention = options.convention or Convention.STANDARD
    made = _written(lettered(robot) if options.letters else robot, convention, options, remarks)
    return ImportedRobot(made, remarks)


def _written_numbers(table: Table) -> Table:
    """Return the table with lengths and angles as a person would write them."""
    # Lengths have six decimals in metres, angles six in degrees.
    angles = np.isin(np.arange(len(COLUMNS)), (ALPHA, THETA))
    rounded = np.where(angles, np.radians(np.round(np.degrees(table), 6)), np.round(table, 6))
    return np.asarray(rounded) + 0.0


def imported_table(text: str, options: ImportOptions) -> ImportedRobot:
    """Return an exercise about the robot of a pasted DH table, or questions about the table.

    Raises RefusedRobotError.
    """
    choices = TableChoices(
        order=options.order,
        unit=options.unit,
        angles=options.angles,
        convention=options.convention,
    )
    try:
        found = pasted_robot(text, choices)
    except OpenQuestionsError as error:
        return ImportedRobot(questions=error.questions)
    except UnusableTableError as error:
        raise RefusedRobotError(error.args[0]) from error
    robot, convention = found.made.robot, found.table.convention
    file = _written(robot, convention, options, found.remarks, found.typed)
    difference = _difference(file, found)
    if not difference <= _SAME_TABLE:
        raise RefusedRobotError(
            say(
                "the robot of the file would differ by {difference} from the table",
                difference=f"{difference:.1e}",
            )
        )
    accuracy = say(
        "Largest difference to the table at 100 poses: {difference} (m, or entries of the "
        "rotation matrix).",
        difference=f"{difference:.1e}",
    )
    return ImportedRobot(file, [accuracy, *found.remarks])


def _difference(file: str, found: PastedRobot) -> float:
    """Return the greatest difference between the poses of a file and those of the text as read.

    Raises RefusedRobotError if the file cannot be read.
    """
    try:
        exercise = read_exercise(Path("imported.toml"), file)
    except CatalogueError as error:
        raise RefusedRobotError(error.faults[0].reason) from error
    robot = exercise.reference
    assert isinstance(robot, Robot)
    rng = np.random.default_rng(1)
    lengths = {v.name: rng.uniform(0.1, 2, _POSES) for v in exercise.variables if v.joint is None}
    variables = [rng.uniform(-np.pi, np.pi, _POSES) for _ in robot.joints]
    moves = iter(variables)
    motions = [next(moves) if own else np.zeros(_POSES) for own in found.table.own]
    named = zip(robot.joints, variables, strict=True)
    values = lengths | {joint.variable: value for joint, value in named}
    reached = robot.pose(values, _POSES)
    expected = pose(found.table.values(lengths, motions), found.table.convention)
    return float(np.abs(reached - expected).max())


def _shown(links: Sequence[str]) -> str:
    return ", ".join(link[:_LONGEST_LINK] for link in links[:_MOST_LINKS])


def _written(
    robot: HomeRobot,
    convention: Convention,
    options: ImportOptions,
    remarks: Sequence[str],
    typed: Sequence[Row[str]] = (),
) -> str:
    draft = Draft(options.title, options.source, convention, remarks, typed)
    try:
        return exercise_text(robot, draft)
    except UnevenLettersError as error:
        raise RefusedRobotError(_UNEVEN) from error


def _ends(frames: Placed, base: str, tip: str, last: int) -> list[str]:
    remarks: list[str] = []
    for shift, frame, link in ((frames.base, "{0}", base), (frames.tool, f"{{{last}}}", tip)):
        if np.abs(shift - np.eye(4)).max() > _SAME:
            rows = "; ".join(" ".join(number_text(each) for each in row) for row in shift[:3])
            where = say("frame {frame} in the link {link}", frame=frame, link=link)
            if link != base:
                where = say("{link} in {frame}", link=link, frame=frame)
            left_out = say(
                "A constant transform is left out, {where}: {rows}.", where=where, rows=rows
            )
            remarks.append(left_out)
    return remarks
