"""Write a folder of documents completely or not at all."""

import secrets
import shutil
from collections.abc import Iterable, Iterator, Set
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import Final

from service.formats.earlier_outputs import WRITTEN
from service.formats.shared.report_format import Document
from service.translations import say

# The name of a folder that is still being written begins with this.
_UNFINISHED: Final = ".dh-grader-unfinished-"
_OLD: Final = "old"
# A file with one of these endings holds all pages.
_ONE_FILE: Final = (".html", ".htm", ".zip")


class UnusableFolderError(Exception):
    """Documents cannot be written into the folder; the message says why."""


def is_for_folder(output: Path, *, several: bool) -> bool:
    """True if reports go into a folder, False if they go into a single file."""
    # A new ``output`` becomes a folder if there are several submissions, unless its name ends like
    # an HTML or zip file.
    if output.exists():
        return output.is_dir()
    return several and output.suffix.lower() not in _ONE_FILE


def write_folder(documents: Iterable[Document], folder: Path) -> None:
    """Write all documents into the folder, or none. Raises UnusableFolderError.

    An existing folder must be empty, or contain only documents of an earlier run.
    """
    try:
        _write_all(documents, folder.resolve())
    except OSError as error:
        raise UnusableFolderError(
            say("cannot be written: {reason}", reason=str(error.strerror))
        ) from error


def _write_all(documents: Iterable[Document], folder: Path) -> None:
    if not folder.exists():
        with _unfinished(folder.parent) as written:
            _write(documents, written)
            written.rename(folder)
        return
    old = _replaceable(folder)
    # Write inside the folder: it may be a mount point, into which nothing outside can be renamed.
    with _unfinished(folder) as written:
        _write(documents, written)
        _exchange(folder, written, old)


@contextmanager
def _unfinished(parent: Path) -> Iterator[Path]:
    folder = parent / f"{_UNFINISHED}{secrets.token_hex(8)}"
    folder.mkdir()
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _write(documents: Iterable[Document], folder: Path) -> None:
    paths = []
    for document in documents:
        file = folder / _within(document.path)
        file.parent.mkdir(exist_ok=True)
        with file.open("xb") as opened:
            opened.writelines(document.pieces)
        paths.append(f"{document.path}\n")
    (folder / WRITTEN).write_text("".join(paths), encoding="utf-8")


def _within(path: str) -> PurePosixPath:
    within = PurePosixPath(path)
    if within.is_absolute() or len(within.parts) > 2 or ".." in within.parts or "\n" in path:
        raise ValueError(f"{path!r} does not stay in its folder")
    return within


def _replaceable(folder: Path) -> list[Path]:
    if not folder.is_dir():
        raise UnusableFolderError(say("is no folder"))
    found = [path for path in folder.iterdir() if not path.name.startswith(_UNFINISHED)]
    for path in _foreign(found, _written_before(folder)):
        raise UnusableFolderError(
            say(
                "holds {name!r}, which no earlier run has written; name an empty folder, or "
                "one that does not exist",
                name=path.relative_to(folder).as_posix(),
            )
        )
    return found


def _written_before(folder: Path) -> set[Path]:
    try:
        paths = (folder / WRITTEN).read_text(encoding="utf-8").splitlines()
    except (FileNotFoundError, UnicodeDecodeError):
        return set()
    return {folder / path for path in (WRITTEN, *paths)}


def _foreign(found: Iterable[Path], written: Set[Path]) -> Iterator[Path]:
    # ``written`` are the files of earlier runs. The files in the folders are also checked.
    folders = {file.parent for file in written}
    for path in found:
        if path.is_symlink() or path not in (written if path.is_file() else folders):
            yield path
        elif path.is_dir():
            yield from (each for each in path.iterdir() if each.is_symlink() or each not in written)


def _exchange(folder: Path, written: Path, old: Iterable[Path]) -> None:
    new = list(written.iterdir())
    aside = written / _OLD
    aside.mkdir()
    moves = [*((path, aside / path.name) for path in old)]
    moves += [(path, folder / path.name) for path in new]
    done: list[tuple[Path, Path]] = []
    try:
        for source, target in moves:
            source.rename(target)
            done.append((source, target))
    except BaseException:
        for source, target in reversed(done):
            target.rename(source)
        raise
