"""`dh-grader exercises import`: a robot from a URDF file or a pasted table -> an exercise file."""

from pathlib import Path
from typing import Annotated

import typer

from service.authoring import UnusableIdError, template
from service.catalogue.files.regular_file import read_regular
from service.cli.exercises.new_file import write_new
from service.cli.language import spoken
from service.cli.terminal import give_up, stdout, unreadable
from service.importing.robot_import import (
    ImportOptions,
    RefusedRobotError,
    SeveralTipsError,
    imported_table,
    imported_urdf,
)
from service.importing.urdf import MOST_BYTES
from service.kinematics.dh import Convention
from service.translations import joined, say


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
        give_up(error)
    except OSError as error:
        give_up(unreadable(file, error))
    if not data:
        give_up(say("{file}: the file is empty", file=str(file)))
    options = ImportOptions(
        title=title or name,
        source=source or f"Imported from {file.name}",
        convention=convention,
        base=base,
        tip=tip,
        letters=letters,
    )
    try:
        if table:
            found = imported_table(data.decode("utf-8", errors="replace"), options)
        else:
            found = imported_urdf(data, options)
    except SeveralTipsError as error:
        give_up(say("{file}: {reason}. Use --tip LINK.", file=str(file), reason=error.args[0]))
    except RefusedRobotError as error:
        give_up(joined(": ", [str(file), str(error.args[0])]))
    made = write_new(output, name, found.text)
    for remark in found.remarks:
        stdout().print(spoken(remark), soft_wrap=True)
    written = say(
        "{file} is written. Read its statement, then: dh-grader exercises check {file}",
        file=str(made),
    )
    stdout().print(spoken(written), soft_wrap=True)
