"""Read the content of a submitted file: JSON, TOML, or the pasted answer to one part."""

import codecs
import datetime
import errno
import tomllib
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any, Final

from service.catalogue import read_regular
from service.submissions.documents import pasted_from
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
# Moodle exports online texts as web pages.
PASTED_ENDINGS: Final = (".csv", ".tsv", ".md", ".tex", ".m", ".py", ".txt", ".html", ".htm")


class UnusableFileError(Exception):
    """The file has no usable submission; the message says why."""


@dataclass(frozen=True, slots=True)
class FileContent:
    """The value of a JSON or TOML file, or the pasted text."""

    value: object
    is_pasted: bool = False


def ending(name: str) -> str:
    """The suffix of a file name in lower case: ``.json``."""
    return PurePosixPath(name).suffix.lower()


def read_file(path: Path) -> bytes:
    """Read a file up to the size limit of a request. Raises UnusableFileError."""
    try:
        return read_regular(path, MAX_BODY_SIZE)
    except OSError as error:
        raise UnusableFileError(_unread(error)) from error
    except ValueError as error:  # a zero byte in the name
        raise UnusableFileError(say("cannot be read: {reason}", reason=str(error))) from error


def _unread(error: OSError) -> str:
    if error.errno == errno.EFBIG:
        return _too_large()
    return say("cannot be read: {reason}", reason=str(error.strerror))


def _too_large() -> str:
    return say("is larger than {most} KiB", most=MAX_BODY_SIZE // 1024)


def read_content(data: bytes, name: str) -> FileContent:
    """Parse the content of a file with this name. Raises UnusableFileError.

    The suffix of the name determines the format. For ``.txt`` and standard input, the content
    determines it.
    """
    if len(data) > MAX_BODY_SIZE:
        raise UnusableFileError(_too_large())
    data = _in_utf_8(data)
    match ending(name):
        case ".toml":
            return FileContent(_toml(data))
        case ".txt":
            return _recognised(data)
        case known if known in PASTED_ENDINGS:
            return FileContent(pasted_from(_text(data), known), is_pasted=True)
        case _ if name == STANDARD_INPUT:
            return _recognised(data)
        case known if known in DATA_ENDINGS:
            return FileContent(_json(data))
        case other:
            return FileContent(_json_without_suffix(data, other))


def _in_utf_8(data: bytes) -> bytes:
    if not data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return data
    try:
        return data.decode("utf-16").encode()
    except UnicodeError as error:
        raise UnusableFileError(
            say("is not text: it begins like UTF-16, but is invalid")
        ) from error


def _text(data: bytes) -> str:
    if b"\0" in data:
        raise UnusableFileError(say("is not text: it has zero bytes"))
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise UnusableFileError(
            say("is not UTF-8 text: byte {byte} is wrong; save it as UTF-8", byte=error.start + 1)
        ) from error
    if not text.strip():
        raise UnusableFileError(say("is empty"))
    return text


def _json(data: bytes) -> object:
    _text(data)
    try:
        return read_json(data)
    except MalformedError as error:
        raise UnusableFileError(_json_reason(error)) from error


def _json_reason(error: MalformedError) -> str:
    return say("is not usable JSON: {reason}", reason=str(error))


def _json_without_suffix(data: bytes, found: str) -> object:
    try:
        return _json(data)
    except UnusableFileError as error:
        known = " ".join((*DATA_ENDINGS, *PASTED_ENDINGS))
        problem = (
            say("is a file of a kind that is not read ({ending})", ending=found)
            if found
            else say("is a file without an ending")
        )
        # Do not complain about JSON in a PDF or a photo.
        if data.lstrip().startswith(b"{"):
            problem = say("{first}, and {second}", first=problem, second=error.args[0])
        raise UnusableFileError(
            say("{problem}; known are {endings}", problem=problem, endings=known)
        ) from error


def _recognised(data: bytes) -> FileContent:
    text = _text(data).strip()
    if text.startswith(("{", "[")):
        try:
            return FileContent(read_json(data))
        except MalformedError as error:
            if '"answers"' in text:
                raise UnusableFileError(_json_reason(error)) from error
    if "answers" in text:
        try:
            value = _toml(data)
        except UnusableFileError:
            pass
        else:
            if isinstance(value, dict) and "answers" in value:
                return FileContent(value)
    return FileContent(text, is_pasted=True)


def _toml(data: bytes) -> object:
    if len(data) > MAX_TOML_SIZE or data.count(b".") > MAX_TOML_DOTS:
        raise UnusableFileError(
            say(
                "is more TOML than {size} KiB or {dots:,} dots",
                size=MAX_TOML_SIZE // 1024,
                dots=MAX_TOML_DOTS,
            )
        )
    try:
        content: object = tomllib.loads(data.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise UnusableFileError(
            say("is not UTF-8 text: byte {byte} is wrong", byte=error.start + 1)
        ) from error
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
