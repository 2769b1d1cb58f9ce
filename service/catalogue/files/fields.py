"""The pydantic types of values in an exercise file.

A formula is text in the students' notation (``"l1 + 0.1"``, ``"-90deg"``). ``compile.py`` reads it,
because it needs the exercise's symbols.
"""

from typing import Annotated, Final, Literal

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    StrictInt,
    StringConstraints,
    ValidatorFunctionWrapHandler,
    WrapValidator,
)
from pydantic.fields import FieldInfo

from service.regex import regex
from service.translations import Sentence, say, template


def _no_boolean(value: object) -> object:
    if isinstance(value, bool):
        raise ValueError(say("is {value}; write a number or a formula", value=str(value).lower()))
    return value


# Control characters and the two others that XML forbids (XML 1.0, "Char"), which break a page or a
# figure; and marks that reorder text, so that it looks different (Unicode, annex 9, "embeddings").
_HIDDEN: Final = regex("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ufffe\uffff]")
# The longest statement of the shipped exercises has 1,500 characters. Rendering the formulas of a
# text of this length takes a quarter of a second.
_LONGEST: Final = 20_000


def _showable(text: str) -> str:
    if found := _HIDDEN.search(text):
        raise ValueError(
            say("holds U+{number:04X}, which no reader sees; leave it out", number=ord(found[0]))
        )
    if len(text) > _LONGEST:
        raise ValueError(
            say("has {count:,} characters; write at most {most:,}", count=len(text), most=_LONGEST)
        )
    return text


def _as_sentence(value: object, checked: ValidatorFunctionWrapHandler) -> object:
    text = checked(value)
    return value if isinstance(value, Sentence) and value == text else text


def advice(text: str) -> FieldInfo:
    """Return the advice that authors see if their text does not match the field's pattern."""
    field: FieldInfo = Field(json_schema_extra={"advice": text})
    return field


NotBool = BeforeValidator(_no_boolean)
Formula = Annotated[str | float, NotBool]
LooseText = Annotated[str, AfterValidator(_showable), WrapValidator(_as_sentence)]
Text = Annotated[
    str,
    StringConstraints(strip_whitespace=True, min_length=1),
    AfterValidator(_showable),
    WrapValidator(_as_sentence),
]
IDENTIFIER = r"[a-z][a-z0-9]*(?:[-_][a-z0-9]+)*"
Identifier = Annotated[
    str,
    StringConstraints(pattern=f"^{IDENTIFIER}$"),
    advice(template('write small letters and digits, with - or _ between them, such as "link-2"')),
]
GivenOrFree = Literal["given", "free"]
Marking = Literal["content", "cells", "rows", "whole"]
FrameName = Literal["base", "tool"] | Annotated[StrictInt, Field(ge=0)]

Triple = tuple[Formula, Formula, Formula]
Four = tuple[Formula, Formula, Formula, Formula]
Homogeneous = tuple[Four, Four, Four, Four]
Screw = tuple[Formula, Formula, Formula, Formula, Formula, Formula]


class StrictModel(BaseModel):
    """A TOML table that refuses unknown keys.

    docs/exercise-fields.md is generated from the strings below the keys.
    """

    # Built when first used: most models are used only within others, which build them again.
    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)
