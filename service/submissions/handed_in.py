"""Find the submissions in files, folders of a class, and folders of single students.

In the folder of a class, each file and each subfolder is the submission of one student. Files that
a learning platform names after the same student belong together. A zip file of a class is read like
its folder, and a zip file of a student like a folder of the student's files.
"""

import os
import sys
import zipfile
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath
from typing import Final

from service.submissions.file_content import STANDARD_INPUT, ending, most_bytes, read_file
from service.submissions.office_files import UnusableFileError, open_archive, unpacked
from service.submissions.platform_names import platform_name, student_and_part
from service.submissions.strict_json import MAX_BODY_SIZE
from service.translations import say

MAX_SUBMISSIONS_IN_FOLDER: Final = 100_000
# The most files and levels of folders of one student: a cloned repository has more than answers.
MAX_FILES: Final = 2_000
MAX_FOLDERS_DEEP: Final = 8
# Bytes of a zip file of a whole class.
MAX_CLASS_ARCHIVE: Final = 1024 * 1024 * 1024
# Bytes of all files in the zip file of a student.
MAX_UNPACKED: Final = 16 * 1024 * 1024
# Zip files in zip files: that of a student, and one more in it.
_MOST_ARCHIVES: Final = 2
_ARCHIVE: Final = ".zip"
_INDEX: Final = "index.html"

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
    # The zip file that holds the file, and the name of the file in it.
    archive: Path | None = None
    member: str = ""

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
        if self.archive is not None:
            with _opened(self.archive) as archive:
                return unpacked(archive, self.member, most_bytes(self.name))
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
    left_out: Collection[Path] = (),
    parts: Collection[str] = (),
) -> Iterator[HandedIn]:
    """Yield the submissions in files and folders.

    With ``folder_is_one``, a folder is the submission of one student. ``left_out`` are files that
    are no submissions. ``parts`` are the possible parts in file names such as
    ``STUDENT.PART.csv``.
    """
    for path in paths:
        if str(path) == STANDARD_INPUT:
            content = sys.stdin.buffer.read(MAX_BODY_SIZE + 1)
            entry = HandedFile(path, STANDARD_INPUT, content=content)
            yield HandedIn(STANDARD_INPUT, STANDARD_INPUT, (entry,))
        elif ending(path.name) == _ARCHIVE and not folder_is_one and path.is_file():
            yield from _of_class_archive(path, parts)
        elif not path.is_dir():
            entry = HandedFile(path, path.as_posix())
            yield HandedIn(str(path), _learner(entry, parts), (entry,))
        elif folder_is_one:
            entry = HandedFile(path, "")
            yield HandedIn(str(path), _learner(entry), (entry,))
        else:
            yield from _of_class(path, left_out, parts)


def _of_class(
    folder: Path, left_out: Collection[Path], parts: Collection[str]
) -> Iterator[HandedIn]:
    try:
        names = _names(folder, MAX_SUBMISSIONS_IN_FOLDER)
    except UnusableFileError as error:
        yield HandedIn(str(folder), folder.name, (), problem=error.args[0])
        return
    by_student: dict[str, list[str]] = {}
    for name in _without_index(names):
        if not any(_is_same(folder / name, each) for each in left_out):
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
    elif entry.content is not None or entry.archive is not None or not entry.path.is_dir():
        yield from _unpacked_files(entry)
    elif levels == 0:
        raise UnusableFileError(
            say("has folders nested more than {most} deep", most=MAX_FOLDERS_DEEP)
        )
    else:
        for name in _names(entry.path, MAX_FILES):
            below = f"{entry.name}/{name}" if entry.name else name
            yield from _files_below(HandedFile(entry.path / name, below), boundary, levels - 1)


def _unpacked_files(file: HandedFile) -> Iterator[HandedFile]:
    # The files in a student's zip file, or the file itself if it is another one or damaged.
    if ending(_own(file)) != _ARCHIVE:
        yield file
        return
    try:
        found = _Unpacking().files(file, _MOST_ARCHIVES)
        if not found:
            raise UnusableFileError(say("holds no file"))
    except UnusableFileError as error:
        yield replace(file, problem=error.args[0])
    else:
        yield from found


class _Unpacking:
    """The files in a zip file of a student, with a limit on the bytes of all files together."""

    def __init__(self) -> None:
        self._left = MAX_UNPACKED

    def files(self, file: HandedFile, levels: int) -> list[HandedFile]:
        """Return the files in this zip file, and those in zip files in it."""
        found: list[HandedFile] = []
        with open_archive(file.read()) as archive:
            for name in _members(archive):
                content = unpacked(archive, name, min(self._left, most_bytes(name)))
                self._left -= len(content)
                steps = [step for step in name.split("/") if step not in ("", ".", "..")]
                below = str(PurePosixPath(_own(file)).with_suffix("").joinpath(*steps))
                inner = HandedFile(file.path.joinpath(*steps), below, content=content)
                if ending(name) == _ARCHIVE and levels > 1:
                    found += self.files(inner, levels - 1)
                else:
                    found.append(inner)
        return found


def _own(file: HandedFile) -> str:
    return file.name or file.path.name


def _members(archive: zipfile.ZipFile) -> list[str]:
    # The names of the files in a zip file, in order. Steps such as ".." only name the file.
    names = [name for name in archive.namelist() if not name.endswith("/")]
    return sorted(name for name in names if not any(map(_is_junk, name.split("/"))))


def _opened(path: Path) -> zipfile.ZipFile:
    try:
        return zipfile.ZipFile(path)
    except (zipfile.BadZipFile, OSError, ValueError) as error:
        raise UnusableFileError(say("is damaged, or not what its name says")) from error


def _of_class_archive(path: Path, parts: Collection[str]) -> Iterator[HandedIn]:
    try:
        with _opened(path) as archive:
            names = _members(archive)
        if len(names) > MAX_SUBMISSIONS_IN_FOLDER:
            raise UnusableFileError(
                say("holds more than {most:,} files", most=MAX_SUBMISSIONS_IN_FOLDER)
            )
    except UnusableFileError as error:
        yield HandedIn(str(path), path.stem, (), problem=error.args[0])
        return
    start = _common_folder(names)
    by_student: dict[str, list[HandedFile]] = {}
    tops = {name: name[len(start) :].split("/") for name in names}
    own = frozenset(_without_index([first for first, *_ in tops.values()]))
    for name, (first, *steps) in tops.items():
        if first not in own:
            continue
        found = platform_name(first)
        student = f"/{found.student}" if found else first
        if not steps and not found and (named := student_and_part(first, parts)):
            student = f"/{named[0]}"
        inner = "/".join(steps) if steps else (found.file if found and found.file else first)
        file = HandedFile(path / name[len(start) :], inner, archive=path, member=name)
        by_student.setdefault(student, []).append(file)
    for student, files in by_student.items():
        shown = path / student.lstrip("/")
        yield HandedIn(str(shown), _learner_in_archive(files, parts), tuple(files))


def _without_index(names: Sequence[str]) -> list[str]:
    # Brightspace puts a page with the list of all submissions beside them.
    others = [name for name in names if name != _INDEX]
    return others if others and all(map(platform_name, others)) else list(names)


def _common_folder(names: Sequence[str]) -> str:
    # A folder around everything, such as the name of the zip file; not the folder of a student.
    first = names[0].partition("/")[0] if names else ""
    if not all(name.startswith(f"{first}/") for name in names) or platform_name(first):
        return ""
    return f"{first}/" if len({name.split("/")[1] for name in names}) > 1 else ""


def _learner_in_archive(files: Sequence[HandedFile], parts: Collection[str]) -> str:
    [top, *below] = files[0].path.relative_to(files[0].archive or "").parts
    if found := platform_name(top):
        return found.learner
    if below:
        return top
    named = student_and_part(top, parts)
    return named[0] if named else PurePosixPath(top).stem


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
