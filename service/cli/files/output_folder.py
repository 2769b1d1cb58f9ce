"""Writing a folder of documents, all of it or nothing."""

import secrets
import shutil
from collections.abc import Iterable, Iterator, Set
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import Final

from service.formats.shared.report_format import Document

# What is being written has a name that nobody takes for finished.
_UNFINISHED: Final = ".dh-grader-unfinished-"
# Lists the files that a run has written, a path in each line, so that a later one may replace them.
WRITTEN: Final = ".dh-grader-written"
_OLD: Final = "old"
_PAGES: Final = (".html", ".htm")


class UnusableFolderError(Exception):
    """A folder that must not be written to; the text says why."""


def is_for_folder(output: Path, *, several: bool) -> bool:
    """Whether an output is meant as a folder: it is one, or it is new and has no ending of a page.

    A single submission needs no folder, so a new output is then a file.
    """
    if output.exists():
        return output.is_dir()
    return several and output.suffix.lower() not in _PAGES


def write_folder(documents: Iterable[Document], folder: Path) -> None:
    """Write the documents into the folder, which has them only when all are written.

    A folder that exists must be empty, or hold nothing but what an earlier run has written: that is
    replaced. Raises UnusableFolderError, before it takes a document or where the disk refuses.
    """
    try:
        _write_all(documents, folder.resolve())
    except OSError as error:
        raise UnusableFolderError(f"cannot be written: {error.strerror}") from error


def _write_all(documents: Iterable[Document], folder: Path) -> None:
    if not folder.exists():
        with _unfinished(folder.parent) as written:
            _write(documents, written)
            written.rename(folder)
        return
    old = _replaceable(folder)
    # Within it, for a folder that is mounted has no neighbours.
    with _unfinished(folder) as written:
        _write(documents, written)
        _exchange(folder, written, old)


@contextmanager
def _unfinished(parent: Path) -> Iterator[Path]:
    """A new folder that is gone in the end, unless it was renamed."""
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
    """The path of a file in a folder or one below, which must not lead out of it."""
    within = PurePosixPath(path)
    if within.is_absolute() or len(within.parts) > 2 or ".." in within.parts or "\n" in path:
        raise ValueError(f"{path!r} does not stay in its folder")
    return within


def _replaceable(folder: Path) -> list[Path]:
    """What stands in the folder, which is empty or was written by an earlier run."""
    if not folder.is_dir():
        raise UnusableFolderError("is no folder")
    found = [path for path in folder.iterdir() if not path.name.startswith(_UNFINISHED)]
    for path in _strange(found, _written_before(folder)):
        raise UnusableFolderError(
            f"holds {path.relative_to(folder).as_posix()!r}, which no earlier run has written; "
            "name an empty folder, or one that does not exist"
        )
    return found


def _written_before(folder: Path) -> set[Path]:
    try:
        paths = (folder / WRITTEN).read_text(encoding="utf-8").splitlines()
    except (FileNotFoundError, UnicodeDecodeError):
        return set()
    return {folder / path for path in (WRITTEN, *paths)}


def _strange(found: Iterable[Path], written: Set[Path]) -> Iterator[Path]:
    """Of the paths and of what is directly below them, those that were not written."""
    folders = {file.parent for file in written}
    for path in found:
        if path.is_symlink() or path not in (written if path.is_file() else folders):
            yield path
        elif path.is_dir():
            yield from (each for each in path.iterdir() if each.is_symlink() or each not in written)


def _exchange(folder: Path, written: Path, old: Iterable[Path]) -> None:
    """Put what was written into the folder in place of what is old; undone if that fails."""
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
