"""Remember which files earlier runs have written, to protect the files of students."""

from collections.abc import Iterable
from pathlib import Path

from service.cli.files.output_folder import WRITTEN
from service.cli.terminal import give_up
from service.translations import say


def require_no_input(output: Path, read: Iterable[Path]) -> None:
    """Exit if the output file would replace an input file."""
    for path in read:
        if path.is_file() and output.exists() and path.samefile(output):
            give_up(
                say(
                    "{file}: is read, and would be overwritten; name another --output",
                    file=str(output),
                )
            )


def require_own(output: Path, folders: Iterable[Path]) -> None:
    """Exit with code 2 if the output would replace a student's file."""
    # A file in one of the folders may be replaced only if an earlier run has written it.
    if output.is_file() and _holds(folders, output) and output.name not in _written(output):
        give_up(
            say(
                "{file}: is among the submissions, and no earlier run has written it; name another "
                "--output",
                file=str(output),
            )
        )


def remember(output: Path | None, folders: Iterable[Path]) -> None:
    """Record that a run has written this file, so that a later run may replace it."""
    if output is not None and output.is_file() and _holds(folders, output):
        names = _written(output)
        if output.name not in names:
            lines = "".join(f"{name}\n" for name in [*names, output.name])
            _list_beside(output).write_text(lines, encoding="utf-8")


def _holds(folders: Iterable[Path], output: Path) -> bool:
    place = output.resolve()
    return any(place.is_relative_to(folder.resolve()) for folder in folders)


def _list_beside(output: Path) -> Path:
    return output.with_name(WRITTEN)


def _written(output: Path) -> list[str]:
    try:
        return _list_beside(output).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError):
        return []
