"""Write reports to the screen or to a file. An incomplete file never appears."""

import io
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from tempfile import SpooledTemporaryFile
from typing import Final

import typer
from rich.console import Console

from service.cli.terminal import give_up, stdout, unwritable

# Larger documents are buffered on the disk (bytes).
_IN_MEMORY: Final = 1024 * 1024


def console_of(output: Path | None) -> Console:
    """Return the console that lays out reports; a file has 80 columns and no colour."""
    if output is None:
        return stdout()
    page = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
    return Console(file=page, width=80, highlight=False, markup=False)


def write(
    pieces: Iterable[bytes], output: Path | None, *, at_once: bool, quiet: bool = False
) -> None:
    """Write the pieces to the file ``output``, or to the screen if ``output`` is None.

    With ``at_once``, the screen shows all pieces at the end.
    """
    # A file appears only when it is complete, and a pipe never gets an incomplete document.
    if output is not None:
        _write_file(pieces, output)
    elif quiet:
        for _ in pieces:
            pass
    elif at_once:
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
    # A pipe or a device cannot be replaced: write to it directly.
    is_replaced = output.is_file() or not output.exists()
    written = output.with_name(f".{output.name}.part") if is_replaced else output
    try:
        with written.open("wb") as file:
            file.writelines(pieces)
        if is_replaced:
            written.replace(output)
    except OSError as error:
        give_up(unwritable(output, error))
    finally:
        if is_replaced:
            # After a failure the file may be missing, or its folder is not a folder.
            with suppress(OSError):
                written.unlink()
