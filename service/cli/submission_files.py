"""Reading a submission from a file: the body of a request, or one part's answer alone."""

import datetime
import tomllib
from pathlib import Path
from typing import Any, Final

from pydantic import ValidationError

from service.submissions.body import GradeRequest
from service.submissions.strict_json import (
    MAX_BODY_SIZE,
    MAX_DEPTH,
    MalformedError,
    nested_deeper,
    read_json,
)

# Python reads TOML a hundred times slower than JSON, and a key of many dots takes memory that grows
# with their square.
MAX_TOML_SIZE: Final = 64 * 1024
MAX_TOML_DOTS: Final = 2_000


class UnusableFileError(Exception):
    """A file that holds no submission; the text says why."""


def read_submission(path: Path, part: str | None) -> GradeRequest:
    """The submission in a JSON file, or a TOML file if its name ends in ``.toml``.

    With ``part`` the file may also hold that part's answer alone, and of several answers only
    that part's is taken. Raises UnusableFileError.
    """
    content = _content(path)
    if not isinstance(content, dict) or "answers" not in content:
        if part is None:
            raise UnusableFileError(
                'holds no "answers"; write {"answers": {"PART": …}}, '
                "or name the part that it answers with --part"
            )
        content = {"answers": {part: content}}
    try:
        body = GradeRequest.model_validate(content)
    except ValidationError as error:
        raise UnusableFileError(_first(error)) from error
    if part is None:
        return body
    answers = {name: answer for name, answer in body.answers.items() if name == part}
    return body.model_copy(update={"answers": answers})


def _content(path: Path) -> object:
    try:
        with path.open("rb") as file:
            data = file.read(MAX_BODY_SIZE + 1)
    except OSError as error:
        raise UnusableFileError(f"cannot be read: {error.strerror}") from error
    if len(data) > MAX_BODY_SIZE:
        raise UnusableFileError(f"is larger than {MAX_BODY_SIZE // 1024} KiB")
    if path.suffix.lower() == ".toml":
        if len(data) > MAX_TOML_SIZE or data.count(b".") > MAX_TOML_DOTS:
            raise UnusableFileError(
                f"is more TOML than {MAX_TOML_SIZE // 1024} KiB or {MAX_TOML_DOTS:,} dots"
            )
        return _toml(data)
    try:
        return read_json(data)
    except MalformedError as error:
        raise UnusableFileError(f"is not usable JSON: {error}") from error


def _toml(data: bytes) -> object:
    try:
        content: object = tomllib.loads(data.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise UnusableFileError(f"is not UTF-8 text: byte {error.start + 1} is wrong") from error
    except RecursionError as error:
        raise UnusableFileError("has tables or lists too deep in each other") from error
    except ValueError as error:  # of TOML itself, or of a number with thousands of digits
        raise UnusableFileError(f"is not usable TOML: {error}") from error
    if nested_deeper(content, MAX_DEPTH):
        raise UnusableFileError("has tables or lists too deep in each other")
    return _as_json(content)


def _as_json(value: Any) -> Any:
    """The value with its dates and times, which JSON does not have, as the text that they are."""
    if isinstance(value, dict):
        return {key: _as_json(child) for key, child in value.items()}
    if isinstance(value, list):
        return [_as_json(child) for child in value]
    if isinstance(value, datetime.date | datetime.time):
        return value.isoformat()
    return value


def _first(error: ValidationError) -> str:
    detail = error.errors(include_url=False)[0]
    field = ".".join(str(step) for step in detail["loc"])
    if detail["type"] == "extra_forbidden":
        known = ", ".join(GradeRequest.model_fields)
        return f"has the unknown field {field!r}; the fields are {known}"
    return f"{field}: {detail['msg']}"
