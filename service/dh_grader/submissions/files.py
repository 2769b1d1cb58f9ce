"""The submissions in files, folders of a class and folders of students, and their content."""

import datetime
import errno
import io
import os
import re
import sys
import tomllib
import zipfile
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import chain, islice
from pathlib import Path, PurePosixPath
from typing import Any, Final, Protocol

from dh_grader.catalogue import read_regular
from dh_grader.regex import regex
from dh_grader.submissions import platform_name, student_and_part
from dh_grader.submissions.bodies import (
    MAX_BODY_SIZE,
    MAX_DEPTH,
    MalformedError,
    nested_deeper,
    read_json,
)
from dh_grader.submissions.documents import (
    Excerpt,
    UnusableFileError,
    around_rows,
    around_table,
    decoded,
    pasted_from,
    typed_text,
)
from dh_grader.submissions.office_files import (
    OFFICE_ENDINGS,
    UNREADABLE_ARCHIVE,
    excerpts,
    has_pictures,
    open_archive,
    unpacked,
)
from dh_grader.translations import Sentence, reason_of, say

# --- Find the submissions in files, folders of a class, and folders of single students
#
# x


# --- Read the content of a submitted file: JSON, TOML, or the answer to one part
#
# The answer to one part is a pasted text, or an excerpt of a file of an office program, a notebook
# or a web editor (`office_files.py`).


# Python reads TOML a hundred times more slowly than JSON, and the memory for a key with many dots
# grows with their square.
MAX_TOML_SIZE: Final = 64 * 1024
MAX_TOML_DOTS: Final = 2_000

STANDARD_INPUT: Final = "-"
DATA_ENDINGS: Final = (".json", ".toml")
_TEXT_ENDINGS: Final = (".csv", ".tsv", ".md", ".tex", ".m", ".py", ".txt")
PASTED_ENDINGS: Final = (*_TEXT_ENDINGS, *OFFICE_ENDINGS)
# Files that only a person can read.
BY_HAND_ENDINGS: Final = frozenset(
    [
        ".pdf",
        ".png",
        ".jpg",
        ".jpeg",
        ".heic",
        ".heif",
        ".gif",
        ".webp",
        ".bmp",
        ".tif",
        ".tiff",
        ".svg",
        ".doc",
        ".odt",
        ".pages",
        ".numbers",
        ".ppt",
        ".pptx",
        ".mlx",
        ".nb",
        ".url",
        ".webloc",
        ".mp4",
        ".mov",
        ".rar",
        ".7z",
        ".tar",
        ".gz",
        ".tgz",
        ".xlsb",
    ]
)
# Bytes of a file of an office program, which may hold pictures besides the answer.
MAX_OFFICE_SIZE: Final = 10 * 1024 * 1024


@dataclass(frozen=True, slots=True)
class FileContent:
    """The value of a JSON or TOML file, or the pasted text.

    If ``excerpts`` has several pieces, the answer may be any of them; ``value`` is the first.
    ``has_pictures`` is true if the file has pictures or drawn boxes, which are not read.
    """

    value: object
    is_pasted: bool = False
    excerpts: tuple[Excerpt, ...] = ()
    has_pictures: bool = False


def ending(name: str) -> str:
    """The suffix of a file name in lower case: ``.json``."""
    return PurePosixPath(name).suffix.lower()


def read_file(path: Path) -> bytes:
    """Read a file up to the size limit of its kind. Raises UnusableFileError."""
    try:
        return read_regular(path, most_bytes(path.name))
    except OSError as error:
        raise UnusableFileError(_unread(error, path.name)) from error
    except ValueError as error:  # a zero byte in the name
        raise UnusableFileError(say("cannot be read: {reason}", reason=str(error))) from error


def most_bytes(name: str) -> int:
    """Return the size limit of a file with this name."""
    return MAX_OFFICE_SIZE if ending(name) in _LARGE_ENDINGS else MAX_BODY_SIZE


_LARGE_ENDINGS: Final = frozenset({*OFFICE_ENDINGS, ".zip"})


def _too_large(name: str) -> str:
    return say("is larger than {most} KiB", most=most_bytes(name) // 1024)


def _unread(error: OSError, name: str) -> str:
    if error.errno == errno.EFBIG:
        return _too_large(name)
    return say("cannot be read: {reason}", reason=reason_of(error))


def read_content(data: bytes, name: str) -> FileContent:
    """Parse the content of a file with this name. Raises UnusableFileError.

    The suffix of the name determines the format. For ``.txt`` and standard input, the content
    determines it.
    """
    kind = ending(name)
    if len(data) > most_bytes(name):
        raise UnusableFileError(_too_large(name))
    if kind in BY_HAND_ENDINGS:
        raise UnusableFileError(
            say("can only be graded by hand: this program cannot read {ending}", ending=kind)
        )
    if kind in OFFICE_ENDINGS:
        return _excerpted(data, kind)
    text = _text(data, kind)
    match kind:
        case ".toml":
            return FileContent(_toml(text))
        case ".txt":
            return _recognised(text)
        case known if known in PASTED_ENDINGS:
            pasted = pasted_from(text, known)
            around = around_table(text, known)
            return FileContent(pasted, is_pasted=True, excerpts=(Excerpt(pasted, around=around),))
        case _ if name == STANDARD_INPUT:
            return _recognised(text)
        case known if known in DATA_ENDINGS:
            return _notebook_or(_json(text), data)
        case other:
            return _notebook_or(_json_without_suffix(text, other), data)


def _text(data: bytes, kind: str) -> str:
    try:
        text = decoded(data)
    except UnusableFileError:
        if kind in (*DATA_ENDINGS, *PASTED_ENDINGS, ""):
            raise
        raise UnusableFileError(_with_known_kinds(_kind(kind))) from None
    if not text.strip():
        raise UnusableFileError(say("is empty"))
    return text


def _excerpted(data: bytes, kind: str) -> FileContent:
    found = excerpts(data, kind)
    if (len(found) == 1 and found[0].text.startswith(("{", "["))) or '"answers"' in found[0].text:
        # JSON that was typed into the editor of a platform.
        return _recognised(found[0].text)
    pictures = has_pictures(data, kind)
    return FileContent(found[0].text, is_pasted=True, excerpts=found, has_pictures=pictures)


def _notebook_or(value: object, data: bytes) -> FileContent:
    # A notebook is JSON, but never the JSON of an answer.
    if isinstance(value, dict) and "nbformat" in value:
        return _excerpted(data, ".ipynb")
    return FileContent(value)


def _json(text: str) -> object:
    try:
        return read_json(text.encode())
    except MalformedError as error:
        raise UnusableFileError(_json_reason(error)) from error


def _json_reason(error: MalformedError) -> str:
    return say("is not usable JSON: {reason}", reason=str(error))


def _json_without_suffix(text: str, found: str) -> object:
    try:
        return _json(text)
    except UnusableFileError as error:
        problem = _kind(found)
        # Do not complain about JSON in a PDF or a photo.
        if text.lstrip().startswith("{"):
            problem = say("{first}, and {second}", first=problem, second=error.args[0])
        raise UnusableFileError(_with_known_kinds(problem)) from error


def _kind(found: str) -> Sentence:
    if not found:
        return say("is a file without an ending")
    return say("is a file of a kind that this program does not read ({ending})", ending=found)


def _with_known_kinds(problem: str) -> Sentence:
    known = " ".join((*DATA_ENDINGS, *PASTED_ENDINGS))
    return say("{problem}; known are {endings}", problem=problem, endings=known)


def typed_in_receipt(text: str) -> str | None:
    """Return what a student typed, if the text is Blackboard's receipt of an attempt, else None.

    The receipt names the student, the assignment and the files; the typed text may be empty.
    """
    head, field, rest = text.replace("\r\n", "\n").partition("\nSubmission Field:")
    typed, comments, _ = rest.rpartition("\nComments:")
    if not (head.lstrip("\ufeff").startswith("Name: ") and field and comments):
        return None
    return typed.replace(_NOTHING_TYPED, "").strip()


_NOTHING_TYPED: Final = "There is no student submission text data for this assignment."


def _recognised(text: str) -> FileContent:
    typed = typed_in_receipt(text)
    if typed == "":
        raise UnusableFileError(say("is empty"))
    # Empty lines at the beginning stay, because messages name lines by their numbers.
    text = (typed or text).rstrip()
    if _TAGS.search(text) and not _HAS_TABLE.search(text):
        # Text from the editor of a platform, saved under the name of a text file.
        text = typed_text(text)
    if text.lstrip().startswith(("{", "[")):
        try:
            return FileContent(read_json(text.encode()))
        except MalformedError as error:
            if '"answers"' in text:
                raise UnusableFileError(_json_reason(error)) from error
    if "answers" in text:
        try:
            value = _toml(text)
        except UnusableFileError:
            pass
        else:
            if isinstance(value, dict) and "answers" in value:
                return FileContent(value)
    return FileContent(text, is_pasted=True, excerpts=(Excerpt(text, around=around_rows(text)),))


_TAGS: Final = regex("</(?:p|div|span)>|<br ?/?>", re.IGNORECASE)
_HAS_TABLE: Final = regex("<t(?:able|r)[ >]", re.IGNORECASE)


def _toml(text: str) -> object:
    if len(text) > MAX_TOML_SIZE or text.count(".") > MAX_TOML_DOTS:
        raise UnusableFileError(
            say(
                "is more TOML than {size} KiB or {dots:,} dots",
                size=MAX_TOML_SIZE // 1024,
                dots=MAX_TOML_DOTS,
            )
        )
    try:
        content: object = tomllib.loads(text)
    except RecursionError as error:
        raise _too_deep() from error
    except tomllib.TOMLDecodeError as error:
        raise UnusableFileError(say("is not usable TOML: {reason}", reason=str(error))) from error
    except ValueError as error:
        raise UnusableFileError(
            say("is not usable TOML: a number has thousands of digits")
        ) from error
    if nested_deeper(content, MAX_DEPTH):
        raise _too_deep()
    return _as_json(content)


def _too_deep() -> UnusableFileError:
    return UnusableFileError(say("has tables or lists nested too deep"))


def _as_json(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _as_json(child) for key, child in value.items()}
    if isinstance(value, list):
        return [_as_json(child) for child in value]
    if isinstance(value, datetime.date | datetime.time):
        return value.isoformat()
    return value


# --- Find the submissions in files, folders of a class, and folders of single students
#
# In the folder of a class, each file and each subfolder is the submission of one student. Files
# that a learning platform names after the same student belong together. A zip file of a class is
# read like its folder, and a zip file of a student like a folder of the student's files.


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
# Bytes of the zip file of a class in another zip file. It is unpacked into memory.
MAX_INNER_ARCHIVE: Final = 128 * 1024 * 1024
# The files in a zip file are compressed already, so that another zip file around it saves little.
# A zip file that grows much more is hostile.
_LEAST_INNER_ARCHIVE: Final = 1024 * 1024
_MOST_EXPANSION: Final = 4
# Folders and zip files around the download of a platform.
_MOST_LEVELS: Final = 4
# Bytes of a file that show whether it is a submission.
MAX_START: Final = 64 * 1024
_ARCHIVE: Final = ".zip"
_INDEX: Final = "index.html"
_DRIVE: Final = regex("[A-Za-z]:/")
# The flag of a zip file whose names are UTF-8.
_SAYS_UTF_8: Final = 0x800

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
    # The zip file that holds the file, the zip files between the two, and the name in the last one.
    archive: Path | None = None
    outer: tuple[str, ...] = ()
    member: str = ""
    # True if the name in the zip file leads out of it, as ``../table.csv`` does.
    is_misplaced: bool = False

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
        if self.is_misplaced:
            raise UnusableFileError(
                say(
                    "has a path in the zip file that leads out of it ({path}), so it was not read",
                    path=self.member,
                )
            )
        if self.archive is not None:
            with _opened(self.archive, self.outer) as archive:
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
    # The name of the person, if it is known and not the name in a gradebook.
    person: str = ""

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
                    raise UnusableFileError(say("holds more than {most:,} files", most=MAX_FILES))
                found.append(file)
        return found


@dataclass(frozen=True, slots=True)
class ClassEntry:
    """A file or folder in the folder or zip file of a class, before anything decides whose it is.

    ``inside`` returns the names in a folder, or the paths of all files in a zip file. ``start``
    returns the first bytes of the file with this path inside, or those of the entry itself.
    """

    path: str
    name: str
    inside: Callable[[], Sequence[str]]
    start: Callable[[str], bytes]


def all_handed_in(
    paths: Iterable[Path],
    *,
    folder_is_one: bool = False,
    left_out: Collection[Path] = (),
    parts: Collection[str] = (),
    is_output: Callable[[ClassEntry], bool] = lambda _: False,
    outputs: list[str] | None = None,
) -> Iterator[HandedIn]:
    """Yield the submissions in files and folders.

    With ``folder_is_one``, a folder is the submission of one student. ``left_out`` are files that
    are no submissions. ``parts`` are the possible parts in file names such as
    ``STUDENT.PART.csv``. ``is_output`` is asked about each entry of a class that no platform has
    named, and returns True if the entry is no submission; ``outputs`` collects the paths of these
    entries. Raises UnusableClassError.
    """
    outputs = [] if outputs is None else outputs
    for path in paths:
        if str(path) == STANDARD_INPUT:
            content = sys.stdin.buffer.read(MAX_BODY_SIZE + 1)
            entry = HandedFile(path, STANDARD_INPUT, content=content)
            yield HandedIn(STANDARD_INPUT, STANDARD_INPUT, (entry,))
        elif ending(path.name) == _ARCHIVE and not folder_is_one and path.is_file():
            yield from _Class(left_out, parts, is_output, outputs).found(_ZipFile, path)
        elif not path.is_dir():
            entry = HandedFile(path, path.as_posix())
            yield HandedIn(str(path), _learner(path.name, parts, is_folder=False), (entry,))
        elif folder_is_one:
            entry = HandedFile(path, "")
            name = path.name or path.resolve().name
            yield HandedIn(str(path), _learner(name, (), is_folder=True), (entry,))
        else:
            yield from _Class(left_out, parts, is_output, outputs).found(_Folder, path)


class UnusableClassError(Exception):
    """The students cannot be told apart; the message says what to give instead."""


class _Level(Protocol):
    """The folder of a class, or its zip file, or a folder in this zip file."""

    path: Path

    def names(self) -> Sequence[str]:
        """Return the names of all entries. Raises UnusableFileError."""

    def is_folder(self, name: str) -> bool:
        """True if the entry is a folder."""

    def opened(self, name: str) -> "_Level | None":
        """Return the level in a folder or a zip file; None for others and for damaged ones."""

    def files(self, name: str, own: str) -> Sequence[HandedFile]:
        """Return the files of an entry, which the student named ``own``."""

    def all_names(self) -> Sequence[str]:
        """Return the names in a folder, or the paths of all files in a zip file."""

    def start(self, path: str) -> bytes:
        """Return the first bytes of a file; none if it cannot be read."""


class _Folder:
    """A folder on the disk."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def names(self) -> Sequence[str]:
        return _names(self.path, MAX_SUBMISSIONS_IN_FOLDER)

    def is_folder(self, name: str) -> bool:
        return _is_folder(self.path / name)

    def opened(self, name: str) -> _Level | None:
        path = self.path / name
        if path.is_symlink():
            return None
        with suppress(UnusableFileError):
            if path.is_dir():
                return _Folder(path)
            if ending(name) == _ARCHIVE and path.is_file():
                return _ZipFile(path)
        return None

    def files(self, name: str, own: str) -> Sequence[HandedFile]:
        path = self.path / name
        return [HandedFile(path, "" if _is_folder(path) else own)]

    def all_names(self) -> Sequence[str]:
        try:
            return os.listdir(self.path)  # noqa: PTH208
        except OSError:
            return []

    def start(self, path: str) -> bytes:
        place = self.path / path
        if place.is_symlink() or not place.is_file():
            return b""
        try:
            with place.open("rb") as file:
                return file.read(MAX_START)
        except OSError:
            return b""


@dataclass(frozen=True, slots=True)
class _Member:
    # The steps of the path without those that only lead elsewhere.
    steps: tuple[str, ...]
    # The name in the zip file.
    name: str
    is_misplaced: bool


class _OpenArchive:
    """A zip file that stays open, so that its directory is read once and not for each file."""

    def __init__(self, archive: Path, outer: tuple[str, ...]) -> None:
        """Open a zip file. Raises UnusableFileError."""
        # The file is closed when this object is deleted.
        self._zip = _opened(archive, outer)

    def members(self) -> list[_Member]:
        """Return the files in the zip file."""
        return _members(self._zip)

    def start(self, name: str) -> bytes:
        """Return the first bytes of a file; none if it cannot be read."""
        try:
            with self._zip.open(name) as file:
                return file.read(MAX_START)
        except UNREADABLE_ARCHIVE:
            return b""


class _ZipFile:
    """A zip file, or a folder in it."""

    def __init__(
        self,
        archive: Path,
        outer: tuple[str, ...] = (),
        shown: Path | None = None,
        folder: "tuple[_OpenArchive, Sequence[_Member]] | None" = None,
    ) -> None:
        """Read the names in a zip file. Raises UnusableFileError.

        ``outer`` are the zip files between ``archive`` and this one. With ``folder``, this is a
        folder of an open zip file, with these files.
        """
        self.path = shown or archive
        self._archive = archive
        self._outer = outer
        if folder is None:
            self._opened = _OpenArchive(archive, outer)
            found = self._opened.members()
            start = _common_folder([each.steps for each in found])
            members: Sequence[_Member] = [replace(each, steps=each.steps[start:]) for each in found]
        else:
            self._opened, members = folder
        self._entries: dict[str, list[_Member]] = {}
        for each in members:
            self._entries.setdefault(each.steps[0], []).append(each)

    def names(self) -> Sequence[str]:
        found = [name for name in self._entries if not _is_junk(name)]
        if sum(map(len, self._entries.values())) > MAX_SUBMISSIONS_IN_FOLDER:
            raise UnusableFileError(
                say("holds more than {most:,} files", most=MAX_SUBMISSIONS_IN_FOLDER)
            )
        return found

    def all_names(self) -> Sequence[str]:
        members = chain.from_iterable(self._entries.values())
        return ["/".join(each.steps) for each in islice(members, MAX_FILES)]

    def is_folder(self, name: str) -> bool:
        return len(self._entries[name][0].steps) > 1

    def opened(self, name: str) -> _Level | None:
        members = self._entries[name]
        shown = self.path / name
        if self.is_folder(name):
            below = [replace(each, steps=each.steps[1:]) for each in members if each.steps[1:]]
            return _ZipFile(self._archive, self._outer, shown, (self._opened, below))
        if ending(name) == _ARCHIVE and len(self._outer) < _MOST_ARCHIVES:
            with suppress(UnusableFileError):
                return _ZipFile(self._archive, (*self._outer, members[0].name), shown)
        return None

    def files(self, name: str, own: str) -> Sequence[HandedFile]:
        return [
            HandedFile(
                self.path.joinpath(*each.steps),
                "/".join(each.steps[1:]) or own,
                archive=self._archive,
                outer=self._outer,
                member=each.name,
                is_misplaced=each.is_misplaced,
            )
            for each in self._entries[name]
            if not any(map(_is_junk, each.steps))
        ]

    def start(self, path: str) -> bytes:
        steps = tuple(path.split("/"))
        found = [each for each in self._entries.get(steps[0], ()) if each.steps == steps]
        return self._opened.start(found[0].name) if found else b""


def _entry(level: _Level, name: str) -> ClassEntry:
    def inside() -> Sequence[str]:
        opened = level.opened(name)
        return opened.all_names() if opened else []

    def start(path: str = "") -> bytes:
        opened = level.opened(name) if path else None
        return (opened.start(path) if opened else b"") if path else level.start(name)

    return ClassEntry(str(level.path / name), name, inside, start)


class _Class:
    """Finds the students in the folder or zip file of a class.

    A tutor may give the download of a platform in a folder or in another zip file, beside earlier
    outputs of this program. So an entry that holds the files of several students is a class.
    """

    def __init__(
        self,
        left_out: Collection[Path],
        parts: Collection[str],
        is_output: Callable[[ClassEntry], bool],
        outputs: list[str],
    ) -> None:
        self._left_out = left_out
        self._parts = parts
        self._is_output = is_output
        self._outputs = outputs
        # The download in which a platform's student was found.
        self._places: dict[str, Path] = {}

    def found(self, opened: Callable[[Path], _Level], path: Path) -> Iterator[HandedIn]:
        """Yield the submissions in a folder or zip file."""
        try:
            level = opened(path)
            names = level.names()
        except UnusableFileError as error:
            name = path.stem if path.is_file() else path.name
            yield HandedIn(str(path), name, (), problem=error.args[0])
        else:
            yield from self._below(level, names, _MOST_LEVELS)

    def _below(self, level: _Level, names: Sequence[str], left: int) -> Iterator[HandedIn]:
        names = _without_index([name for name in names if self._is_submission(level, name)])
        if len(names) == 1:
            _require_no_closed_archive(level, names[0])
        by_student: dict[str, list[str]] = {}
        for name in names:
            if left and (inner := self._download(level, name, is_alone=len(names) == 1)):
                yield from self._below(inner, inner.names(), left - 1)
            else:
                by_student.setdefault(self._student(level, name), []).append(name)
        for student, own in by_student.items():
            yield self._handed_in(level, student, own)

    def _is_submission(self, level: _Level, name: str) -> bool:
        if any(_is_same(level.path / name, each) for each in self._left_out):
            return False
        if not self._is_named_output(level, name):
            return True
        self._outputs.append(str(level.path / name))
        return False

    def _download(self, level: _Level, name: str, *, is_alone: bool) -> _Level | None:
        # The level in an entry that holds the files of several students, as a platform names them.
        # A single entry may also hold those of one student.
        if platform_name(name):
            return None
        inner = level.opened(name)
        if inner is None:
            return None
        try:
            found = [each for each in inner.names() if not self._is_named_output(inner, each)]
        except UnusableFileError:
            return None
        students = [named.student for each in found if (named := platform_name(each))]
        if is_alone and len(found) == 1 and not students:
            return inner if self._download(inner, found[0], is_alone=True) else None
        is_class = len(students) * 2 > len(found) and (is_alone or len(set(students)) > 1)
        return inner if is_class else None

    def _is_named_output(self, level: _Level, name: str) -> bool:
        return not platform_name(name) and self._is_output(_entry(level, name))

    def _student(self, level: _Level, name: str) -> str:
        if found := platform_name(name):
            first = self._places.setdefault(found.student, level.path)
            if first != level.path:
                raise UnusableClassError(
                    say(
                        "{first} and {second} hold submissions of the same student, {student}. "
                        "Give only one of them.",
                        first=str(first),
                        second=str(level.path),
                        student=found.student,
                    )
                )
            return f"/{found.student}"
        named = student_and_part(name, self._parts)
        return f"/{named[0]}" if named and not level.is_folder(name) else name

    def _handed_in(self, level: _Level, student: str, own: Sequence[str]) -> HandedIn:
        entries: list[HandedFile] = []
        for name in own:
            found = platform_name(name)
            entries += level.files(name, found.file if found and found.file else name)
        shown = level.path / (own[0] if len(own) == 1 else student[1:])
        if isinstance(level, _ZipFile):
            shown = level.path / student.lstrip("/")
        learner = _learner(own[0], self._parts, is_folder=level.is_folder(own[0]))
        folder = level.path if isinstance(level, _Folder) else None
        found = platform_name(own[0])
        person = found.person if found else ""
        return HandedIn(str(shown), learner, tuple(entries), folder, person=person)


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
    if ending(_own(file)) != _ARCHIVE or file.is_misplaced:
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
            for member in _members(archive):
                name = member.steps[-1]
                below = str(PurePosixPath(_own(file)).with_suffix("").joinpath(*member.steps))
                path = file.path.joinpath(*member.steps)
                if member.is_misplaced:
                    found.append(HandedFile(path, below, member=member.name, is_misplaced=True))
                    continue
                content = unpacked(archive, member.name, min(self._left, most_bytes(name)))
                self._left -= len(content)
                inner = HandedFile(path, below, content=content)
                if ending(name) == _ARCHIVE and levels > 1:
                    found += self.files(inner, levels - 1)
                else:
                    found.append(inner)
        return found


def _own(file: HandedFile) -> str:
    return file.name or file.path.name


def _members(archive: zipfile.ZipFile) -> list[_Member]:
    # The files in a zip file, in the order of their paths.
    found = []
    for info in archive.infolist():
        path = _readable_name(info)
        steps = _steps(path)
        if path.endswith(("/", "\\")) or not steps or any(map(_is_junk, steps)):
            continue
        found.append(_Member(steps, info.filename, leads_out(path)))
    return sorted(found, key=lambda each: each.steps)


def leads_out(path: str) -> bool:
    """True if a path in a zip file leads out of the folder into which it is unpacked."""
    path = path.replace("\\", "/")
    return path.startswith("/") or ".." in path.split("/") or bool(_DRIVE.match(path))


def _steps(path: str) -> tuple[str, ...]:
    # Without the steps that lead elsewhere.
    steps = path.replace("\\", "/").split("/")
    return tuple(step for step in steps if step not in ("", ".", ".."))


def handed_in_out_of_place(path: str, parts: Collection[str]) -> HandedIn:
    """Return the submission of a file whose path leads out of its zip file. It is not read."""
    steps = _steps(path) or ("?",)
    first, *below = steps[next((i for i in range(len(steps)) if platform_name(steps[i])), 0) :]
    found = platform_name(first)
    own = "/".join(below) or (found.file if found else "") or first
    file = HandedFile(Path(first, *below), own, member=path, is_misplaced=True)
    learner = _learner(first, parts, is_folder=bool(below))
    return HandedIn(path, learner, (file,), person=found.person if found else "")


def _readable_name(info: zipfile.ZipInfo) -> str:
    # Some programs (such as Archive Utility on a Mac) write UTF-8, but do not say so.
    if not info.flag_bits & _SAYS_UTF_8:
        with suppress(UnicodeError):
            return info.filename.encode("cp437").decode()
    return info.filename


def _opened(path: Path, outer: Sequence[str] = ()) -> zipfile.ZipFile:
    """Open a zip file, or the zip file ``outer[-1]`` in it. Raises UnusableFileError."""
    try:
        if outer:
            return zipfile.ZipFile(io.BytesIO(_inner_archive(path, tuple(outer))))
        return zipfile.ZipFile(path)
    except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError) as error:
        raise UnusableFileError(say("is damaged, or not what its name says")) from error


@lru_cache(maxsize=1)
def _inner_archive(path: Path, outer: tuple[str, ...]) -> bytes:
    # All files of a class are read from one inner zip file, so that it is unpacked once.
    with _opened(path, outer[:-1]) as archive:
        packed = archive.getinfo(outer[-1]).compress_size
        most = min(MAX_INNER_ARCHIVE, _LEAST_INNER_ARCHIVE + _MOST_EXPANSION * packed)
        return unpacked(archive, outer[-1], most)


def _require_no_closed_archive(level: _Level, name: str) -> None:
    # A zip file alone in a zip file is the class, unless it is too large or damaged.
    is_archive = ending(name) == _ARCHIVE and not platform_name(name)
    if isinstance(level, _ZipFile) and is_archive and level.opened(name) is None:
        raise UnusableClassError(
            say(
                "{outer} holds only the zip file {inner}, which is too large to be read in it, or "
                "damaged. Unpack {outer}, and give {inner}.",
                outer=str(level.path),
                inner=name,
            )
        )


def _without_index(names: Sequence[str]) -> list[str]:
    # Brightspace puts a page with the list of all submissions beside them.
    others = [name for name in names if name != _INDEX]
    return others if others and all(map(platform_name, others)) else list(names)


def _common_folder(paths: Sequence[tuple[str, ...]]) -> int:
    # 1 if a folder is around everything, such as the name of the zip file, otherwise 0. The folder
    # of a student is none.
    first = paths[0][0] if paths else ""
    if platform_name(first) or not all(steps[0] == first and len(steps) > 1 for steps in paths):
        return 0
    return 1 if len({steps[1] for steps in paths}) > 1 else 0


def _names(folder: Path, most: int) -> list[str]:
    try:
        names = sorted(name for name in os.listdir(folder) if not _is_junk(name))  # noqa: PTH208
    except OSError as error:
        raise UnusableFileError(say("cannot be read: {reason}", reason=reason_of(error))) from error
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


def _learner(name: str, parts: Collection[str], *, is_folder: bool) -> str:
    if found := platform_name(name):
        return found.learner
    if is_folder:
        return name
    named = student_and_part(name, parts)
    return named[0] if named else PurePosixPath(name).stem
