"""Turn pydantic's errors into messages for the authors of exercise files."""

import difflib
import inspect
import reprlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Final, get_args

from pydantic import BaseModel, ValidationError

from service.catalogue.files.schema import (
    CheckSpec,
    ExerciseSpec,
    ExpectSpec,
    PartTextsSpec,
    RobotSpec,
    ScrewRobotSpec,
    SymbolSpec,
    TranslationSpec,
)
from service.catalogue.parts import SPECS
from service.catalogue.robots.formulas import FieldError
from service.regex import regex
from service.translations import Sentence, say, template

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
