"""Where reports go: the screen, or a file that is there only when it is whole."""

import io
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from tempfile import SpooledTemporaryFile
from typing import Final

import typer
from rich.console import Console

from service.cli.terminal import give_up, stdout

# More of a document than this waits on the disk.
_IN_MEMORY: Final = 1024 * 1024


def console_of(output: Path | None) -> Console:
    """The console that reports are laid out for: the screen, or 80 columns without colour."""
    if output is None:
        return stdout()
    page = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
    return Console(file=page, width=80, highlight=False, markup=False)


def write(pieces: Iterable[bytes], output: Path | None, *, at_once: bool) -> None:
    """Write the pieces; a file is there only when it is whole.

    On the screen they appear as they come, or with ``at_once`` when all have come, so that nothing
    half-written goes into a pipe.
    """
    if output is not None:
        _write_file(pieces, output)
        return
    if at_once:
        with SpooledTemporaryFile(_IN_MEMORY) as whole:
            whole.writelines(pieces)
            whole.seek(0)
            _show(iter(lambda: whole.read(_IN_MEMORY), b""))
    else:
        _show(pieces)


def _show(pieces: Iterable[bytes]) -> None:
    for piece in pieces:
        typer.echo(piece, nl=False)


def _write_file(pieces: Iterable[bytes], output: Path) -> None:
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
            # Where it could not be written it is not there, or its folder is none.
            with suppress(OSError):
                written.unlink()
