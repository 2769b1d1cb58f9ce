"""Find the submissions in files, folders of a class, and folders of single students.

In the folder of a class, each file and each subfolder is the submission of one student. Files that
a learning platform names after the same student belong together.
"""

import os
import sys
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from service.submissions.file_content import STANDARD_INPUT, UnusableFileError, read_file
from service.submissions.platform_names import platform_name, student_and_part
from service.submissions.strict_json import MAX_BODY_SIZE
from service.translations import say

MAX_SUBMISSIONS_IN_FOLDER: Final = 100_000
# The most files and levels of folders of one student: a cloned repository has more than answers.
MAX_FILES: Final = 2_000
MAX_FOLDERS_DEEP: Final = 8

_JUNK: Final = frozenset({"__macosx", "thumbs.db", "desktop.ini", "__pycache__", "node_modules"})


@dataclass(frozen=True, slots=True)
class HandedFile:
    """One file of a submission."""

    path: Path
    # The path in the submission, as the student named it.
    name: str
    # The reason why the file must not be read.
    problem: str = ""
    # Set if the file has been read already.
    content: bytes | None = field(default=None, repr=False)

    @property
    def own_name(self) -> str:
        """The name that the student gave the file, without a path or the student's name."""
        if self.name != self.path.as_posix():
            return self.name
        found = platform_name(self.path.name)
        return (found and found.file) or self.path.name

    def read(self) -> bytes:
        """Return the bytes of the file. Raises UnusableFileError."""
        if self.problem:
            raise UnusableFileError(self.problem)
        return read_file(self.path) if self.content is None else self.content


@dataclass(frozen=True, slots=True)
class HandedIn:
    """The submission of one student: files and folders."""

    # Unique among all submissions.
    name: str
    # The student's name in a gradebook.
    learner: str
    entries: tuple[HandedFile, ...]
    # The class folder, out of which no link may lead; None if the caller named the files.
    folder: Path | None = None
    # The reason why nothing can be graded.
    problem: str = ""

    def files(self) -> list[HandedFile]:
        """Return all files sorted by name. Raises UnusableFileError."""
        if self.problem:
            raise UnusableFileError(self.problem)
        found: list[HandedFile] = []
        for entry in self.entries:
            inside = None if _is_folder(entry.path) else self.folder
            boundary = inside or entry.path
            for file in _files_below(entry, boundary, MAX_FOLDERS_DEEP):
                if len(found) == MAX_FILES:
                    raise UnusableFileError(f"holds more than {MAX_FILES:,} files")
                found.append(file)
        return found


def all_handed_in(
    paths: Iterable[Path],
    *,
    folder_is_one: bool = False,
    left_out: Path | None = None,
    parts: Collection[str] = (),
) -> Iterator[HandedIn]:
    """Yield the submissions in files and folders.

    With ``folder_is_one``, a folder is the submission of one student. ``left_out`` is a file that
    is not a submission. ``parts`` are the possible parts in file names such as
    ``STUDENT.PART.csv``.
    """
    for path in paths:
        if str(path) == STANDARD_INPUT:
            content = sys.stdin.buffer.read(MAX_BODY_SIZE + 1)
            entry = HandedFile(path, STANDARD_INPUT, content=content)
            yield HandedIn(STANDARD_INPUT, STANDARD_INPUT, (entry,))
        elif not path.is_dir():
            entry = HandedFile(path, path.as_posix())
            yield HandedIn(str(path), _learner(entry, parts), (entry,))
        elif folder_is_one:
            entry = HandedFile(path, "")
            yield HandedIn(str(path), _learner(entry), (entry,))
        else:
            yield from _of_class(path, left_out, parts)


def _of_class(folder: Path, left_out: Path | None, parts: Collection[str]) -> Iterator[HandedIn]:
    try:
        names = _names(folder, MAX_SUBMISSIONS_IN_FOLDER)
    except UnusableFileError as error:
        yield HandedIn(str(folder), folder.name, (), problem=error.args[0])
        return
    by_student: dict[str, list[str]] = {}
    for name in names:
        if left_out is None or not _is_same(folder / name, left_out):
            by_student.setdefault(_student(folder, name, parts), []).append(name)
    for student, own in by_student.items():
        entries = tuple(_entry(folder, name) for name in own)
        shown = folder / (own[0] if len(own) == 1 else student[1:])
        yield HandedIn(str(shown), _learner(entries[0], parts), entries, folder)


def _student(folder: Path, name: str, parts: Collection[str]) -> str:
    if found := platform_name(name):
        return f"/{found.student}"
    named = student_and_part(name, parts)
    return f"/{named[0]}" if named and not _is_folder(folder / name) else name


def _entry(folder: Path, name: str) -> HandedFile:
    path = folder / name
    found = platform_name(name)
    own = found.file if found else name
    return HandedFile(path, "" if _is_folder(path) else own)


def _files_below(entry: HandedFile, boundary: Path, levels: int) -> Iterator[HandedFile]:
    if entry.path != boundary and entry.path.is_symlink():
        yield HandedFile(entry.path, entry.name, _link_problem(entry.path, boundary))
    elif entry.content is not None or not entry.path.is_dir():
        yield entry
    elif levels == 0:
        raise UnusableFileError(
            say("has folders nested more than {most} deep", most=MAX_FOLDERS_DEEP)
        )
    else:
        for name in _names(entry.path, MAX_FILES):
            below = f"{entry.name}/{name}" if entry.name else name
            yield from _files_below(HandedFile(entry.path / name, below), boundary, levels - 1)


def _names(folder: Path, most: int) -> list[str]:
    try:
        names = sorted(name for name in os.listdir(folder) if not _is_junk(name))  # noqa: PTH208
    except OSError as error:
        raise UnusableFileError(
            say("cannot be read: {reason}", reason=str(error.strerror))
        ) from error
    if len(names) > most:
        raise UnusableFileError(say("holds more than {most:,} files", most=most))
    return names


def _is_junk(name: str) -> bool:
    return name.startswith((".", "~$")) or name.endswith("~") or name.lower() in _JUNK


def _link_problem(link: Path, boundary: Path) -> str:
    try:
        target = link.resolve(strict=True)
        is_inside = target.is_relative_to(boundary.resolve())
    except (OSError, RuntimeError):  # RuntimeError is a circle, in older Pythons
        return say("is a symbolic link to nothing")
    if not is_inside:
        return say("is a symbolic link out of the folder")
    return say("is a symbolic link to a folder") if target.is_dir() else ""


def _is_folder(path: Path) -> bool:
    return path.is_dir() and not path.is_symlink()


def _is_same(path: Path, other: Path) -> bool:
    return path.name == other.name and path.resolve() == other.resolve()


def _learner(entry: HandedFile, parts: Collection[str] = ()) -> str:
    name = entry.path.name or entry.path.resolve().name
    if found := platform_name(name):
        return found.learner
    if _is_folder(entry.path):
        return name
    named = student_and_part(name, parts)
    return named[0] if named else entry.path.stem
