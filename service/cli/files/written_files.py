"""Remember which files earlier runs have written, to protect the files of students."""

from collections.abc import Iterable
from pathlib import Path

from service.cli.terminal import give_up, unreadable
from service.formats.earlier_outputs import WRITTEN, is_earlier_output
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


def require_own(output: Path, folders: Iterable[Path], *, force: bool = False) -> None:
    """Exit with code 2 if the output would replace a file that is no earlier output.

    With ``force``, the output may replace any file that is not among the submissions.
    """
    if not output.is_file() or output.name in _written(output):
        return
    try:
        is_own = is_earlier_output(output)
    except OSError as error:
        give_up(unreadable(output, error))
    if is_own:
        return
    if _holds(folders, output):
        give_up(
            say(
                "{file}: is among the submissions, and no earlier run has written it; name another "
                "--output",
                file=str(output),
            )
        )
    if not force:
        give_up(
            say(
                "{file}: exists, and is no earlier report of this program; name another --output, "
                "or add --force to replace the file",
                file=str(output),
            )
        )


def written_in(folders: Iterable[Path]) -> list[Path]:
    """Return the files in these folders that earlier runs have written."""
    found = [folder / name for folder in folders for name in _written(folder / WRITTEN)]
    return [path for path in found if path.is_file()]


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
