"""`dh-grader exercises import`: a robot from a URDF file or a pasted table -> an exercise file."""

import sys
from pathlib import Path
from typing import Annotated

import click
import typer

from service.authoring import UnusableIdError, template
from service.catalogue.files.regular_file import read_regular
from service.cli.exercises.new_file import write_new
from service.cli.language import spoken
from service.cli.terminal import give_up, stdout, unreadable
from service.importing.pasted_robot import Question
from service.importing.robot_import import (
    ImportedRobot,
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
        Convention | None,
        typer.Option(
            help="The convention of the exercise and of a table. Default: as the table says, or "
            "standard.",
            show_default=False,
        ),
    ] = None,
    order: Annotated[
        str,
        typer.Option(
            metavar="COLUMNS",
            help='The order of the columns of a table without headers, such as "a alpha d theta".',
        ),
    ] = "",
    unit: Annotated[
        str,
        typer.Option(
            metavar="UNIT",
            help="The unit of lengths in a table without units: m, cm, mm, in or ft.",
        ),
    ] = "",
    degrees: Annotated[
        bool | None,
        typer.Option(
            "--degrees/--radians",
            help="The unit of angles in a table without units.",
            show_default=False,
        ),
    ] = None,
    title: Annotated[str, typer.Option(help="The title of the exercise.")] = "",
    source: Annotated[str, typer.Option(help="Where the robot comes from.")] = "",
    output: Annotated[
        Path, typer.Option(metavar="FOLDER", help="The folder; created if missing.")
    ] = Path(),
) -> None:
    """Make an exercise from a robot's URDF file, or from a DH table.

    Prints each number that was rounded, and the largest difference between the exercise and the
    file at 100 random poses. Refuses more than 1 mm for a URDF file, and more than 1e-9 for a
    table. Asks for what a table does not say.
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
        order=order,
        unit=unit,
        angles="" if degrees is None else "degrees" if degrees else "radians",
    )
    try:
        if table:
            found = _imported_table(file, data.decode("utf-8", errors="replace"), options)
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


def _imported_table(file: Path, text: str, options: ImportOptions) -> ImportedRobot:
    """Return the robot of a table. Asks on a terminal for what the table does not say."""
    found = imported_table(text, options)
    while found.questions:
        if not is_terminal():
            asked = [
                say(
                    "{file}: {question} Use one of these options: {options}.",
                    file=str(file),
                    question=question.text,
                    options=", ".join(_option(question.name, each) for each in question.usual),
                )
                for question in found.questions
            ]
            give_up(joined("\n", asked))
        options = options.with_answers({each.name: _answer(each) for each in found.questions})
        found = imported_table(text, options)
    return found


def is_terminal() -> bool:
    """True if a person can answer at the terminal."""
    return sys.stdin.isatty()


def _option(name: str, choice: str) -> str:
    """Return the option that answers a question.

    >>> _option("angles", "degrees"), _option("order", "a alpha d theta")
    ('--degrees', '--order "a alpha d theta"')
    """
    if name == "angles":
        return f"--{choice}"
    return f'--{name} "{choice}"' if " " in choice else f"--{name} {choice}"


def _answer(question: Question) -> str:
    text = f"{spoken(question.text)} ({', '.join(question.usual)})"
    choices = click.Choice(question.choices)
    return str(typer.prompt(text, type=choices, show_choices=False))
