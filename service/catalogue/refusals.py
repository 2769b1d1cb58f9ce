"""Pydantic's findings in an exercise file -> the field and the reason, as authors name them."""

import difflib
import re
import reprlib
from collections.abc import Mapping, Sequence
from typing import Any, Final

from pydantic import ValidationError

from service.catalogue.advice import advised

_Detail = Mapping[str, Any]

# Pydantic puts the form behind a field that may have several, with a finding for each form.
_FORM: Final = re.compile(r"(?:literal|str-enum)\[.*\]|str|float|constrained-int")
_CHOICES: Final = {"literal_error": "expected", "enum": "expected",
                   "union_tag_invalid": "expected_tags"}  # fmt: skip
_QUOTED: Final = re.compile(r"'([^']*)'")


def refusals(error: ValidationError) -> list[tuple[str, str]]:
    """The field and the reason of each fault; a value that fits none of several forms is one."""
    found: list[tuple[str, list[_Detail]]] = []
    for detail in error.errors(include_url=False):
        location = detail["loc"]
        is_form = len(location) > 2 and _FORM.fullmatch(str(location[-1])) is not None
        field = _path(location[:-1] if is_form else location)
        if detail["type"] == "union_tag_invalid":
            field = f"{field}.kind"
        if is_form and found and found[-1][0] == field:
            found[-1][1].append(detail)
        else:
            found.append((field, [detail]))
    return [(field, _reason(details)) for field, details in found]


def _reason(details: Sequence[_Detail]) -> str:
    """The reason why a value is refused; ``details`` has one finding for each form it may have."""
    known = [
        choice
        for detail in details
        if detail["type"] in _CHOICES
        for choice in _QUOTED.findall(detail["ctx"][_CHOICES[detail["type"]]])
    ]
    reasons = [advised(detail) for detail in details if detail["type"] not in _CHOICES]
    if known:
        value = details[0]["input"]
        tagged = details[0]["type"] == "union_tag_invalid"
        reasons.insert(0, _no_choice(value["kind"] if tagged else value, known))
    first, *more = reasons
    return first + "".join(f", or {reason[0].lower()}{reason[1:]}" for reason in more)


def _no_choice(value: object, known: Sequence[str]) -> str:
    """The reason for a value that is not among the known ones, with the nearest of them."""
    lowered = {choice.lower(): choice for choice in known}
    near = difflib.get_close_matches(str(value).lower(), lowered, n=1)
    meant = f"; did you mean {lowered[near[0]]!r}? Write" if near else "; write"
    *others, last = map(repr, known)
    listed = f"{', '.join(others)} or {last}" if others else last
    return f"is {reprlib.repr(value)}{meant} {listed}"


def _path(location: Sequence[int | str]) -> str:
    """A field as an author would name it: ``parts[0].points``.

    Behind the number of a part pydantic puts the part's kind, and behind the robot the way that it
    is given; neither is a field of the file.
    """
    inserted = {"parts": 2, "robot": 1}.get(str(location[0])) if location else None
    names = {"start": "from"}
    steps = [names.get(str(step), step) for i, step in enumerate(location) if i != inserted]
    path = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in steps)
    return path.lstrip(".") or "file"
