"""`dh-grader bundle`: write a zip file for a grading platform."""

from pathlib import Path
from typing import Annotated

import typer

from service.bundles import BUNDLES, BundleError, content_of, zipped
from service.catalogue import exercise_files
from service.cli.commands.grade import chosen_assignment
from service.cli.files.output import write
from service.cli.terminal import give_up, installed_exercise
from service.settings import load_settings

commands = typer.Typer(
    help="Write a zip file for a grading platform.",
    no_args_is_help=True,
    add_completion=False,
)

_Exercise = Annotated[
    str | None,
    typer.Option(metavar="ID", help="The exercise to grade.", show_default=False),
]
_Assignment = Annotated[
    Path | None, typer.Option(metavar="F", help="An assignment file with several exercises.")
]
_Output = Annotated[
    Path, typer.Option(metavar="F", help="The zip file to write.", show_default=False)
]


@commands.command("gradescope")
def gradescope(output: _Output, exercise: _Exercise = None, assignment: _Assignment = None) -> None:
    """Write an autograder to upload to Gradescope under "Configure Autograder"."""
    _write("gradescope", output, exercise, assignment)


@commands.command("prairielearn")
def prairielearn(
    output: _Output,
    image: Annotated[
        str,
        typer.Option(
            metavar="NAME",
            help="The name of the grader's image in your registry.",
            show_default=False,
        ),
    ],
    exercise: _Exercise = None,
    assignment: _Assignment = None,
) -> None:
    """Write a folder `image`, which builds the grader, and a folder `question` for a course."""
    _write("prairielearn", output, exercise, assignment, image)


@commands.command("ci")
def ci(output: _Output, exercise: _Exercise = None, assignment: _Assignment = None) -> None:
    """Write a folder with the grader for CI jobs of GitHub, GitLab and others."""
    _write("ci", output, exercise, assignment)


def _write(
    platform: str, output: Path, exercise: str | None, file: Path | None, image: str = ""
) -> None:
    chosen = chosen_assignment(exercise, file, None, installed_exercise)
    catalogue = {found.stem: found for found in exercise_files(*load_settings().exercises_dir)}
    try:
        content = content_of(chosen, file, catalogue, image)
    except BundleError as error:
        give_up(str(error))
    write([zipped(BUNDLES[platform](content))], output, at_once=True)
