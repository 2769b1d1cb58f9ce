"""Advice to authors on each of pydantic's findings in an exercise file."""

import difflib
import inspect
from collections.abc import Mapping, Sequence
from typing import Any, get_args

from pydantic import BaseModel

from service.catalogue.parts import SPECS
from service.catalogue.schema import (
    CheckSpec,
    ExerciseSpec,
    ExpectSpec,
    RobotSpec,
    ScrewRobotSpec,
    SymbolSpec,
)

Location = Sequence[int | str]


def advised(detail: Mapping[str, Any]) -> str:
    """One of pydantic's findings, in a sentence with the repair."""
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
            return f"{reason}: {_advice(str(last), _model(location[:-1]))}"
        case "union_tag_not_found":
            return f'{reason}: write kind = "…", one of {", ".join(SPECS)}'
        case _:
            return reason


def _no_such_key(key: str, model: type[BaseModel]) -> str:
    known = [field.alias or name for name, field in model.model_fields.items()]
    matches = difflib.get_close_matches(key, known, n=1)
    meant = f"did you mean {matches[0]!r}? The keys are" if matches else "the keys are"
    return f"there is no key {key!r} here; {meant} {', '.join(known)}"


def _advice(key: str, model: type[BaseModel]) -> str:
    field = model.model_fields.get(key)
    extra = field.json_schema_extra if field else None
    return str(extra["advice"]) if isinstance(extra, dict) else "write it so"


def _model(location: Location) -> type[BaseModel]:
    """The table of the file that a location lies in."""
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
        case _:
            return ExerciseSpec


def table_in(annotation: object) -> type[BaseModel] | None:
    """The table that a list of tables holds, such as ``list[StepSpec] | None``."""
    if inspect.isclass(annotation) and issubclass(annotation, BaseModel):
        return annotation
    return next(filter(None, map(table_in, get_args(annotation))), None)
