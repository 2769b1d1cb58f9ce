"""Pydantic's findings in an exercise file, with what to write instead."""

import difflib
from collections.abc import Mapping, Sequence
from typing import Any, get_args

from pydantic import BaseModel

from service.catalogue.check_schema import CheckSpec, ExpectSpec
from service.catalogue.schema import (
    ComponentSpec,
    ExerciseSpec,
    PartSpec,
    RobotSpec,
    ScrewRobotSpec,
    StepSpec,
    SymbolSpec,
)

Location = Sequence[int | str]

_PATTERNS: Mapping[str, str] = {
    "structure": "write one letter for each joint, R if it turns and P if it slides, at most 10",
    "id": 'write small letters and digits, with - or _ between them, such as "link-2"',
    "coordinates": 'write the coordinates that are asked for, such as "xy" or "xyz"',
}
_PARTS: Mapping[str, type[BaseModel]] = {
    get_args(spec.model_fields["kind"].annotation)[0]: spec
    for spec in get_args(get_args(PartSpec)[0])
}


def advised(detail: Mapping[str, Any]) -> str:
    """One of pydantic's findings, in a sentence that says what to write."""
    reason: str = detail["msg"].removeprefix("Value error, ")
    location: Location = detail["loc"]
    last = location[-1] if location else ""
    match detail["type"]:
        case "extra_forbidden":
            return _no_such_key(str(last), _model(location[:-1]))
        case "missing" if isinstance(last, int):
            return f"{reason}: write entry {last + 1} as well"
        case "missing":
            return f"{reason}: write {last} = …"
        case "string_pattern_mismatch":
            return f"{reason}: {_PATTERNS.get(str(last), 'write it so')}"
        case "union_tag_not_found":
            return f'{reason}: write kind = "…", one of {", ".join(_PARTS)}'
        case _:
            return reason


def _no_such_key(key: str, model: type[BaseModel]) -> str:
    known = [field.alias or name for name, field in model.model_fields.items()]
    matches = difflib.get_close_matches(key, known, n=1)
    meant = f"did you mean {matches[0]!r}? The keys are" if matches else "the keys are"
    return f"there is no key {key!r} here; {meant} {', '.join(known)}"


def _model(location: Location) -> type[BaseModel]:
    """The table of the file that a location lies in."""
    match list(location):
        case ["robot", tag, *_]:
            return ScrewRobotSpec if tag == "screws" else RobotSpec
        case ["symbols", *_]:
            return SymbolSpec
        case ["parts", int(), _, "steps", *_]:
            return StepSpec
        case ["parts", int(), _, "components", *_]:
            return ComponentSpec
        case ["parts", int(), str(kind), *_]:
            return _PARTS[kind]
        case ["checks", int(), "expect", *_]:
            return ExpectSpec
        case ["checks", *_]:
            return CheckSpec
        case _:
            return ExerciseSpec
