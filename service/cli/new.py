"""`dh-grader exercises new`: a file to start from."""

from pathlib import Path
from typing import Annotated

import typer

from service.authoring import template
from service.cli.terminal import give_up, stdout


def command(
    exercise_id: Annotated[
        str, typer.Argument(metavar="ID", help="Becomes the file's name.", show_default=False)
    ],
    output: Annotated[
        Path, typer.Option(metavar="FOLDER", help="Where to write it; made if need be.")
    ] = Path(),
) -> None:
    """Write a commented exercise file to start from. It passes `exercises check` as it is."""
    text = template(exercise_id)
    file = output / f"{exercise_id}.toml"
    try:
        output.mkdir(parents=True, exist_ok=True)
        with file.open("x", encoding="utf-8") as new:
            new.write(text)
    except FileExistsError:
        give_up(f"{file} is there already, and stays as it is; choose another id or folder")
    except OSError as error:
        give_up(f"{file}: cannot be written: {error.strerror}")
    stdout().print(
        f"{file} is written. Edit it, then: dh-grader exercises check {file}", soft_wrap=True
    )
