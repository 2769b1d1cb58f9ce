"""The values of an exercise file, as pydantic checks them.

A formula is text in the students' own notation (``"l1 + 0.1"``, ``"-90deg"``); whether it can be
read is checked in ``compile.py``, where the exercise's symbols are known.
"""

from typing import Annotated, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, StrictInt, StringConstraints
from pydantic.fields import FieldInfo


def _no_truth_value(value: object) -> object:
    if isinstance(value, bool):
        raise ValueError(f"is {str(value).lower()}; write a number or a formula")
    return value


def advice(text: str) -> FieldInfo:
    """What an author should write whose text has another pattern, as metadata of the field."""
    field: FieldInfo = Field(json_schema_extra={"advice": text})
    return field


NotBool = BeforeValidator(_no_truth_value)
Formula = Annotated[str | float, NotBool]
Text = Annotated[str, StringConstraints(strip_whitespace=True, min_length=1)]
IDENTIFIER = r"[a-z][a-z0-9]*(?:[-_][a-z0-9]+)*"
Identifier = Annotated[
    str,
    StringConstraints(pattern=f"^{IDENTIFIER}$"),
    advice('write small letters and digits, with - or _ between them, such as "link-2"'),
]
GivenOrFree = Literal["given", "free"]
Marking = Literal["content", "cells", "rows", "whole"]
FrameName = Literal["base", "tool"] | Annotated[StrictInt, Field(ge=0)]

Triple = tuple[Formula, Formula, Formula]
Four = tuple[Formula, Formula, Formula, Formula]
Homogeneous = tuple[Four, Four, Four, Four]
Screw = tuple[Formula, Formula, Formula, Formula, Formula, Formula]


class StrictModel(BaseModel):
    """A table of the file; an unknown key is a fault.

    The text below a key is its meaning, from which docs/exercise-fields.md is made.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
