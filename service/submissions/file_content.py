"""Read the content of a submitted file: JSON, TOML, or the answer to one part.

The answer to one part is a pasted text, or an excerpt of a file of an office program, a notebook or
a web editor (`office_files.py`).
"""

import datetime
import errno
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any, Final

from service.catalogue import read_regular
from service.regex import regex
from service.submissions.documents import around_rows, around_table, pasted_from
from service.submissions.office_files import (
    OFFICE_ENDINGS,
    Excerpt,
    UnusableFileError,
    decoded,
    excerpts,
    typed_text,
)
from service.submissions.strict_json import (
    MAX_BODY_SIZE,
    MAX_DEPTH,
    MalformedError,
    nested_deeper,
    read_json,
)
from service.translations import say

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
    ]
)
# Bytes of a file of an office program, which may hold pictures besides the answer.
MAX_OFFICE_SIZE: Final = 10 * 1024 * 1024


@dataclass(frozen=True, slots=True)
class FileContent:
    """The value of a JSON or TOML file, or the pasted text.

    If ``excerpts`` has several pieces, the answer may be any of them; ``value`` is the first.
    """

    value: object
    is_pasted: bool = False
    excerpts: tuple[Excerpt, ...] = ()


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
    return say("cannot be read: {reason}", reason=str(error.strerror))


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
            say("can only be graded by hand: a program cannot read {ending}", ending=kind)
        )
    if kind in OFFICE_ENDINGS:
        return _excerpted(data, kind)
    text = decoded(data)
    if not text.strip():
        raise UnusableFileError(say("is empty"))
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


def _excerpted(data: bytes, kind: str) -> FileContent:
    found = excerpts(data, kind)
    if (len(found) == 1 and found[0].text.startswith(("{", "["))) or '"answers"' in found[0].text:
        # JSON that was typed into the editor of a platform.
        return _recognised(found[0].text)
    return FileContent(found[0].text, is_pasted=True, excerpts=found)


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
        known = " ".join((*DATA_ENDINGS, *PASTED_ENDINGS))
        problem = (
            say("is a file of a kind that is not read ({ending})", ending=found)
            if found
            else say("is a file without an ending")
        )
        # Do not complain about JSON in a PDF or a photo.
        if text.lstrip().startswith("{"):
            problem = say("{first}, and {second}", first=problem, second=error.args[0])
        raise UnusableFileError(
            say("{problem}; known are {endings}", problem=problem, endings=known)
        ) from error


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
