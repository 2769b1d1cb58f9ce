"""Read a file of an author, and say what is wrong in it with field and line.

It knows TOML and pydantic's errors, and nothing about robots.
"""

import difflib
import errno
import inspect
import os
import re
import reprlib
import stat
import tempfile
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, TypeVar, get_args

from pydantic import BaseModel, ValidationError

from dh_grader.catalogue.kinds import SPECS
from dh_grader.catalogue.robot import FieldError
from dh_grader.catalogue.schema import (
    CheckSpec,
    ExerciseSpec,
    ExpectSpec,
    PartTextsSpec,
    RobotSpec,
    ScrewRobotSpec,
    SymbolSpec,
    TranslationSpec,
)
from dh_grader.regex import regex
from dh_grader.translations import Sentence, joined, reason_of, say, template

# --- Choose the place for temporary folders that several processes share


# A folder in memory, which is writable even in a container with a read-only file system.
_MEMORY: Final = Path("/dev/shm")


def temporary_place() -> Path:
    """Return a folder for temporary files, in memory if possible."""
    if os.access(_MEMORY, os.W_OK):
        return _MEMORY
    try:
        return Path(tempfile.gettempdir())
    except OSError:
        return Path.cwd()


# --- Read regular files only


def read_regular(file: Path, most: int) -> bytes:
    """Return the bytes of a regular file.

    Raises OSError for a pipe, for a device, and for more than ``most`` bytes.
    """
    with open(file, "rb", opener=_open_nonblocking) as opened:
        status = os.fstat(opened.fileno())
        if stat.S_ISDIR(status.st_mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        if not stat.S_ISREG(status.st_mode):
            raise OSError(errno.EINVAL, "it is a pipe or device")
        # The file may grow during the read.
        content = b"" if status.st_size > most else opened.read(most + 1)
        if max(status.st_size, len(content)) > most:
            raise OSError(errno.EFBIG, f"it is larger than {most // 1024} KiB")
        return content


def _open_nonblocking(name: str, flags: int) -> int:
    return os.open(name, flags | getattr(os, "O_NONBLOCK", 0))


# --- Turn pydantic's errors into messages for the authors of exercise files


_Detail = Mapping[str, Any]
_Location = Sequence[int | str]
TableAt = Callable[[_Location], type[BaseModel]]

# For a field of several types, pydantic has a finding for each, with the type at the end of its
# location.
_FORM: Final = regex(r"(?:literal|str-enum)\[.*\]|str|float|constrained-int")
_CHOICES: Final = {"literal_error": "expected", "enum": "expected",
                   "union_tag_invalid": "expected_tags"}  # fmt: skip
# What pydantic says; the program adds advice.
_MESSAGES: Final = frozenset(
    (
        template("Field required"),
        template("Input should be a valid string"),
        template("Input should be a valid number"),
        template("Input should be a valid string, or input should be a valid number"),
        template("Input should be a valid integer"),
        template("Input should be a valid boolean"),
        template("Input should be a valid list"),
        template("Input should be a valid dictionary"),
        template("Input should be a valid tuple"),
        template("String should have at least 1 character"),
        template("List should have at least 1 item after validation, not 0"),
    )
)
_RANGES: Final[Mapping[str, str]] = {
    "greater_than": template("is {value}; write a number greater than {limit}"),
    "greater_than_equal": template("is {value}; write a number greater than or equal to {limit}"),
    "less_than": template("is {value}; write a number less than {limit}"),
    "less_than_equal": template("is {value}; write a number less than or equal to {limit}"),
}
_QUOTED: Final = regex(r"'([^']*)'")


def refusals(
    error: ValidationError | FieldError | ExceptionGroup[FieldError], table_at: TableAt
) -> list[tuple[str, str]]:
    """Return the field and the reason of each fault that was found in an exercise file."""
    if isinstance(error, ExceptionGroup):
        return [fault for each in error.exceptions for fault in refusals(each, table_at)]
    if isinstance(error, FieldError):
        return [(error.field, error.reason)]
    found: list[tuple[str, list[_Detail]]] = []
    for detail in error.errors(include_url=False):
        location = detail["loc"]
        is_form = len(location) > 2 and _FORM.fullmatch(str(location[-1])) is not None
        field = _path(location[:-1] if is_form else location)
        if detail["type"] == "union_tag_invalid":
            field = f"{field}.kind"
        # If a value may have several types, pydantic has an error for each type.
        if is_form and found and found[-1][0] == field:
            found[-1][1].append(detail)
        else:
            found.append((field, [detail]))
    return [(field, _reason(details, table_at)) for field, details in found]


def _reason(details: Sequence[_Detail], table_at: TableAt) -> str:
    known = [
        choice
        for detail in details
        if detail["type"] in _CHOICES
        for choice in _QUOTED.findall(detail["ctx"][_CHOICES[detail["type"]]])
    ]
    others = (detail for detail in details if detail["type"] not in _CHOICES)
    reasons = [_advised(detail, table_at) for detail in others]
    if known:
        value = details[0]["input"]
        tagged = details[0]["type"] == "union_tag_invalid"
        reasons.insert(0, _no_choice(value["kind"] if tagged else value, known))
    first, *more = reasons
    if not more:
        return first
    every = first + "".join(f", or {reason[0].lower()}{reason[1:]}" for reason in more)
    return Sentence(every) if every in _MESSAGES else every


def _no_choice(value: object, known: Sequence[str]) -> str:
    lowered = {choice.lower(): choice for choice in known}
    near = difflib.get_close_matches(str(value).lower(), lowered, n=1)
    names = alternatives(map(repr, known))
    if not near:
        return say("is {value}; write {names}", value=reprlib.repr(value), names=names)
    return say(
        "is {value}; did you mean {meant!r}? Write {names}",
        value=reprlib.repr(value),
        meant=lowered[near[0]],
        names=names,
    )


def alternatives(names: Iterable[str]) -> str:
    """Return the names in words: "a, b or c"."""
    *others, last = names
    return say("{first} or {last}", first=", ".join(others), last=last) if others else last


def _path(location: _Location) -> str:
    # Pydantic inserts the kind of a part after its number, and the form of the robot after "robot".
    inserted = {"parts": 2, "robot": 1}.get(str(location[0])) if location else None
    names = {"start": "from"}
    steps = [names.get(str(step), step) for i, step in enumerate(location) if i != inserted]
    path = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in steps)
    return path.lstrip(".") or "file"


def _advised(detail: _Detail, table_at: TableAt) -> str:
    reason = _message(detail)
    location: _Location = detail["loc"]
    last = location[-1] if location else ""
    match detail["type"]:
        case "extra_forbidden":
            return _no_such_key(str(last), table_at(location[:-1]))
        case "missing" if isinstance(last, int):
            return say("{reason}: write entry {number} as well", reason=reason, number=last + 1)
        case "missing":
            return say("{reason}: write {key} = …", reason=reason, key=last)
        case "string_pattern_mismatch":
            return say(
                "String should match pattern '{pattern}': {advice}",
                pattern=detail["ctx"]["pattern"],
                advice=_advice(str(last), table_at(location[:-1])),
            )
        case "float_type" | "bool_type" if isinstance(detail["input"], str):
            return say("{reason}: write it without quotation marks", reason=reason)
        case "bool_type":
            return say("{reason}: write true or false", reason=reason)
        case "string_type" if isinstance(detail["input"], bool | int | float):
            return say("{reason}: write it in quotation marks", reason=reason)
        case "greater_than" | "greater_than_equal" | "less_than" | "less_than_equal":
            return _out_of_range(detail, _is_share(str(last), table_at(location)))
        case "union_tag_not_found":
            return say(
                '{reason}: write kind = "…", one of {kinds}', reason=reason, kinds=", ".join(SPECS)
            )
        case _:
            return reason


def _message(detail: _Detail) -> str:
    if detail["type"] == "value_error":
        reason: str = detail["ctx"]["error"].args[0]
        return reason
    message: str = detail["msg"]
    return Sentence(message) if message in _MESSAGES else message


def _out_of_range(detail: _Detail, is_share: bool) -> str:
    value = detail["input"]
    shown = reprlib.repr(value)
    if not is_share:
        limit = detail["msg"].rpartition(" ")[2]
        return Sentence(_RANGES[detail["type"]], {"value": shown, "limit": limit})
    if not 1 < value <= 100:
        return say("is {value}; write a share from 0 to 1", value=shown)
    return say(
        "is {value}; write a share from 0 to 1, so {share} for {percentage} %",
        value=shown,
        share=f"{value / 100:g}",
        percentage=f"{value:g}",
    )


def _is_share(key: str, model: type[BaseModel]) -> bool:
    field = model.model_fields.get(key)
    limits = field.metadata if field else []
    return any(getattr(each, "ge", None) == 0 for each in limits) and any(
        getattr(each, "le", None) == 1 for each in limits
    )


def _no_such_key(key: str, model: type[BaseModel]) -> str:
    known = [field.alias or name for name, field in model.model_fields.items()]
    matches = difflib.get_close_matches(key, known, n=1)
    if not matches:
        return say(
            "there is no key {key!r} here; the keys are {keys}", key=key, keys=", ".join(known)
        )
    return say(
        "there is no key {key!r} here; did you mean {meant!r}? The keys are {keys}",
        key=key,
        meant=matches[0],
        keys=", ".join(known),
    )


def _advice(key: str, model: type[BaseModel]) -> str:
    field = model.model_fields.get(key)
    extra = field.json_schema_extra if field else None
    return Sentence(str(extra["advice"])) if isinstance(extra, dict) else say("write it so")


def exercise_table(location: _Location) -> type[BaseModel]:
    """Return the pydantic model of the TOML table that contains ``location``."""
    match list(location):
        case ["robot", tag, *_]:
            return ScrewRobotSpec if tag == "screws" else RobotSpec
        case ["symbols", *_]:
            return SymbolSpec
        case ["parts", int(), str(kind), str(key), int(), *_]:
            field = SPECS[kind].model_fields.get(key)
            return table_in(field.annotation if field else None) or SPECS[kind]
        case ["parts", int(), str(kind), *_]:
            return SPECS[kind]
        case ["checks", int(), "expect", *_]:
            return ExpectSpec
        case ["checks", *_]:
            return CheckSpec
        case ["translations", _, "parts", *_]:
            return PartTextsSpec
        case ["translations", *_]:
            return TranslationSpec
        case _:
            return ExerciseSpec


def table_in(annotation: object) -> type[BaseModel] | None:
    """Return the pydantic model in an annotation such as ``list[StepSpec] | None``, if any."""
    if inspect.isclass(annotation) and issubclass(annotation, BaseModel):
        return annotation
    return next(filter(None, map(table_in, get_args(annotation))), None)


# --- Find the line of each value in a TOML text
#
# The text must be valid TOML: this module does not check its syntax.


_BLANK: Final = regex(r"(?:[ \t\r\n]|#[^\n]*)*")
_KEY: Final = regex(r"""[ \t]*("(?:[^"\\\n]|\\.)*"|'[^'\n]*'|[A-Za-z0-9_-]+)[ \t]*""")
_STRINGS: Final = (
    r'"""(?:[^\\]|\\.)*?"{3,5}(?!")',
    r"'''.*?'{3,5}(?!')",
    r'"(?:[^"\\\n]|\\.)*"',
    r"'[^'\n]*'",
)
_SCALAR: Final = regex("|".join((*_STRINGS, r"[^,\]}#\n]*")), re.DOTALL)


def with_line(field: str, line: int | None) -> str:
    """Return the field with its line, if known, as in "points (line 12)"."""
    return field if line is None else say("{field} (line {line})", field=field, line=line)


def line_of(field: str, lines: dict[str, int]) -> int | None:
    """Return the line of a field such as ``parts[1].points``.

    If the field has no line, return the line of the table or list that contains it. ``lines`` comes
    from ``value_lines``.
    """
    while field and field not in lines:
        field = field[: max(field.rfind("."), field.rfind("["), 0)]
    return lines.get(field)


def value_lines(text: str) -> dict[str, int]:
    """Map the path of each value of a TOML text to its line: ``{"parts[1].points": 31, …}``."""
    return _LineFinder(text).found()


class _LineFinder:
    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0
        self._lines: dict[str, int] = {}
        # The index of the last table in each array of tables.
        self._counts: dict[str, int] = {}

    def found(self) -> dict[str, int]:
        prefix = ""
        self._skip()
        while self._at < len(self._text):
            if self._text.startswith("[", self._at):
                prefix = self._header()
            else:
                self._pair(prefix)
            self._skip()
        return self._lines

    def _skip(self, pattern: re.Pattern[str] = _BLANK) -> None:
        match = pattern.match(self._text, self._at)
        assert match is not None
        self._at = match.end()

    def _header(self) -> str:
        array = self._text.startswith("[[", self._at)
        line = self._line()
        self._at += 1 + array
        path = self._keys("", tables=True)
        if array:
            self._counts[path] = self._counts.get(path, -1) + 1
            path = f"{path}[{self._counts[path]}]"
        self._lines.setdefault(path, line)
        self._at += 1 + array
        return path

    def _pair(self, prefix: str) -> None:
        line = self._line()
        path = self._keys(prefix)
        self._lines.setdefault(path, line)
        self._at += 1  # the =
        self._value(path)

    def _keys(self, prefix: str, *, tables: bool = False) -> str:
        path = prefix
        while match := _KEY.match(self._text, self._at):
            if tables and path in self._counts:
                path = f"{path}[{self._counts[path]}]"
            name = match[1].strip("\"'")
            path = f"{path}.{name}" if path else name
            self._at = match.end()
            if not self._text.startswith(".", self._at):
                break
            self._at += 1
        return path

    def _value(self, path: str) -> None:
        self._skip()
        self._lines.setdefault(path, self._line())
        if self._text.startswith("[", self._at):
            self._inside("]", path)
        elif self._text.startswith("{", self._at):
            self._inside("}", path)
        else:
            self._skip(_SCALAR)

    def _inside(self, closing: str, path: str) -> None:
        self._at += 1
        index = 0
        self._skip()
        while self._at < len(self._text) and not self._text.startswith(closing, self._at):
            if closing == "]":
                self._value(f"{path}[{index}]")
            else:
                self._pair(path)
            index += 1
            self._skip()
            if self._text.startswith(",", self._at):
                self._at += 1
            self._skip()
        self._at += 1

    def _line(self) -> int:
        return self._text.count("\n", 0, self._at) + 1


# --- Read a tutor's TOML file and report faults with field and line


# The largest shipped exercise has 8 kB.
_LARGEST: Final = 1024 * 1024

Built = TypeVar("Built")


@dataclass(frozen=True, slots=True)
class Fault:
    """A fault in a tutor's file: its place and its reason."""

    file: Path
    field: str
    reason: str
    line: int | None = None

    def __str__(self) -> str:
        """File, field and reason on one line."""
        place = with_line(self.field, self.line)
        return joined(": ", list(filter(None, (str(self.file), place, self.reason))))


class CatalogueError(Exception):
    """One or more files of a tutor cannot be used; ``faults`` are the reasons."""

    def __init__(self, faults: list[Fault]) -> None:
        super().__init__(joined("\n", list(map(str, faults))))
        self.faults = faults


def load_toml(file: Path, build: Callable[[dict[str, Any]], Built], table_at: TableAt) -> Built:
    """Read a TOML file, and return what ``build`` makes of its content. Raises CatalogueError."""
    return built_of(file, toml_content(file), build, table_at)


def toml_content(file: Path) -> bytes:
    """Return the bytes of a TOML file. Raises CatalogueError."""
    try:
        return read_regular(file, _LARGEST)
    except OSError as error:
        raise CatalogueError([Fault(file, "", fault_reason(error))]) from error


def built_of(
    file: Path, content: bytes, build: Callable[[dict[str, Any]], Built], table_at: TableAt
) -> Built:
    """Return what ``build`` makes of the bytes of a TOML file. Raises CatalogueError."""
    try:
        text = content.decode()
    except ValueError as error:
        raise CatalogueError([Fault(file, "", fault_reason(error))]) from error
    return read_toml(file, text, build, table_at)


def read_toml(
    file: Path, text: str, build: Callable[[dict[str, Any]], Built], table_at: TableAt
) -> Built:
    """Return what ``build`` makes of a TOML text. Raises CatalogueError, which names ``file``."""
    # Normalize line ends as in a file that is opened in text mode.
    text = text.replace("\r\n", "\n")
    try:
        return build(tomllib.loads(text))
    except (ValidationError, FieldError, ExceptionGroup) as error:
        lines = value_lines(text)
        found = refusals(error, table_at)
        faults = [Fault(file, *fault, line_of(fault[0], lines)) for fault in found]
        raise CatalogueError(faults) from error
    except (ValueError, RecursionError) as error:
        raise CatalogueError([Fault(file, "", fault_reason(error))]) from error


def fault_reason(error: Exception) -> str:
    """Return the reason why a file cannot be read, or is not TOML."""
    match error:
        case OSError():
            return say("cannot be read: {reason}", reason=reason_of(error))
        case UnicodeDecodeError():
            return say("is not UTF-8 text: {reason}", reason=error.reason)
        case RecursionError():
            return say("has tables or lists nested too deep")
        case _:  # of TOML itself, or of a number with thousands of digits
            return say("is not TOML: {reason}", reason=str(error))
