"""`dh-grader bundle`: write a zip file for a grading platform."""

import os
from pathlib import Path
from secrets import token_hex
from typing import Annotated, Final

import typer

from service.bundles import BUNDLES, BundleError, content_of, zipped
from service.catalogue import exercise_files
from service.cli.commands.grade import chosen_assignment
from service.cli.files.output import write
from service.cli.terminal import give_up, installed_exercise, unwritable
from service.regex import regex
from service.settings import load_settings
from service.translations import say
from service.variants.variant import NoVariantError

_SECRET: Final = regex(r"[0-9a-f]{64}")

commands = typer.Typer(
    help="Write a zip file for a grading platform.",
    no_args_is_help=True,
    add_completion=False,
)

_Exercise = Annotated[
    str | None,
    typer.Option(
        metavar="ID|FILE",
        help="The exercise to grade: its id, or an exercise file (….toml).",
        show_default=False,
    ),
]
_Assignment = Annotated[
    Path | None, typer.Option(metavar="F", help="An assignment file with several exercises.")
]
_Output = Annotated[
    Path, typer.Option(metavar="F", help="The zip file to write.", show_default=False)
]
_Secret = Annotated[
    Path | None,
    typer.Option(
        metavar="F",
        help="The file with the secret of the students' variants; a new one is written if it is "
        "missing. Keep it: with another secret, students get other variants.",
    ),
]


@commands.command("gradescope")
def gradescope(
    output: _Output,
    exercise: _Exercise = None,
    assignment: _Assignment = None,
    secret: _Secret = None,
) -> None:
    """Write an autograder to upload to Gradescope under "Configure Autograder"."""
    _write("gradescope", output, exercise, assignment, secret_file=secret)


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
    secret: _Secret = None,
) -> None:
    """Write a folder `image`, which builds the grader, and a folder `question` for a course."""
    _write("prairielearn", output, exercise, assignment, image, secret)


@commands.command("ci")
def ci(output: _Output, exercise: _Exercise = None, assignment: _Assignment = None) -> None:
    """Write a folder with the grader for CI jobs of GitHub, GitLab and others."""
    _write("ci", output, exercise, assignment)


def _write(
    platform: str,
    output: Path,
    exercise: str | None,
    file: Path | None,
    image: str = "",
    secret_file: Path | None = None,
) -> None:
    chosen = chosen_assignment(exercise, file, None, installed_exercise)
    catalogue = {found.stem: found for found in exercise_files(*load_settings().exercises_dir)}
    has_secret = chosen.variants and platform != "ci"
    secret = _secret(secret_file) if has_secret else ""
    try:
        content = content_of(chosen, file, catalogue, image, secret)
        files = BUNDLES[platform](content)
    except (BundleError, NoVariantError) as error:
        give_up(error)
    write([zipped(files)], output, at_once=True)


def _secret(file: Path | None) -> str:
    if file is None:
        give_up(
            say(
                "The assignment has variants: name a file for their secret, --secret F. It is "
                "written if it is missing; keep it, or students get other variants with the next "
                "bundle."
            )
        )
    try:
        # Nobody else may read it.
        descriptor = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(descriptor, "w", encoding="utf-8") as opened:
            opened.write(f"{token_hex(32)}\n")
    except FileExistsError:
        pass
    except OSError as error:
        give_up(unwritable(file, error))
    try:
        found = file.read_text(encoding="utf-8").strip()
    except (OSError, ValueError):
        found = ""
    if not _SECRET.fullmatch(found):
        give_up(
            say("{file}: contains no secret; name another file, and it is written.", file=str(file))
        )
    return found
