"""Where reports go: the screen, or a file that is there only when it is whole."""

import io
from collections.abc import Iterable
from pathlib import Path

import typer
from rich.console import Console

from service.cli.terminal import give_up, stdout


def console_of(output: Path | None) -> Console:
    """The console that reports are laid out for: the screen, or 80 columns without colour."""
    if output is None:
        return stdout()
    page = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
    return Console(file=page, width=80, highlight=False, markup=False)


def write(pieces: Iterable[bytes], output: Path | None) -> None:
    """Write the pieces as they come; a file is there only when it is whole."""
    if output is None:
        for piece in pieces:
            typer.echo(piece, nl=False)
        return
    # A pipe or a device is no file to be replaced.
    is_replaced = output.is_file() or not output.exists()
    written = output.with_name(f".{output.name}.part") if is_replaced else output
    try:
        with written.open("wb") as file:
            file.writelines(pieces)
        if is_replaced:
            written.replace(output)
    except OSError as error:
        give_up(f"{output}: cannot be written: {error.strerror}")
    finally:
        if is_replaced:
            written.unlink(missing_ok=True)
