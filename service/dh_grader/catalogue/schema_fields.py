"""The values that several tables of an exercise file have: levels, formulas, rules of attempts."""

from enum import StrEnum
from typing import Annotated, Final, Literal

from pydantic import (
    AfterValidator,
    AwareDatetime,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    StrictInt,
    StringConstraints,
    ValidatorFunctionWrapHandler,
    WrapValidator,
    model_validator,
)
from pydantic.fields import FieldInfo

from dh_grader.regex import regex
from dh_grader.translations import Sentence, say, template

# --- The keys of a file that do not affect grading


NOT_GRADING: Final = frozenset({
    "checks", "feedback", "attempts", "view", "level", "order", "minutes", "summary", "keywords",
    "translations",
})  # fmt: skip


# --- The levels of the catalogue


class ExerciseLevel(StrEnum):
    """The level of an exercise, from the first to the hardest."""

    START = "start"
    BASICS = "basics"
    ARMS = "arms"
    INDUSTRIAL = "industrial"


# --- The levels of feedback in a report


class FeedbackLevel(StrEnum):
    """The level of feedback in a report, from the most to the least.

    ``full``: hints and corrections. ``hints``: hints without values. ``verdicts``: right and wrong
    entries. ``score``: only marks. All levels name unreadable entries.
    """

    FULL = "full"
    HINTS = "hints"
    VERDICTS = "verdicts"
    SCORE = "score"


_FROM_THE_MOST = tuple(FeedbackLevel)


def least(*levels: FeedbackLevel) -> FeedbackLevel:
    """Return the level with the least feedback."""
    return max(levels, key=_FROM_THE_MOST.index)


# --- The pydantic types of values in an exercise file
#
# A formula is text in the students' notation (``"l1 + 0.1"``, ``"-90deg"``). ``exercise.py``
# reads it, because it needs the exercise's symbols.


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


# --- The rules for recorded attempts in an exercise file: how many, when, and the marks if late


Worth = Annotated[float, Field(ge=0, le=1)]
# The price of each step of a hint, as a share of the points of the exercise.
HintPrices = Annotated[list[Worth], Field(min_length=3, max_length=3)]


class AttemptsSpec(StrictModel):
    """The rules for recorded attempts: their limit, times and late marks."""

    limit: Annotated[int, Field(ge=1, strict=True)] | None = None
    """The most attempts of each learner. Default: no limit. An attempt in which nothing could be
    read does not count."""
    opens: AwareDatetime | None = None
    """The time from which attempts are accepted, with a time zone: 2026-10-01T08:00:00+02:00."""
    due: AwareDatetime | None = None
    """The time until which an attempt earns all its points."""
    closes: AwareDatetime | None = None
    """The time until which late attempts are accepted. Default: none is accepted after ``due``."""
    late_worth: Worth = 0.5
    """The share of its points that a late attempt earns."""
    counts: Literal["best", "last"] = "best"
    """The attempt of a learner that counts: the one with the most points, or the last one."""

    hint_prices: HintPrices | None = None
    """The price of the three steps of a hint, as shares of the points of the exercise:
    [0, 0.05, 0.1]. The hints that a learner takes reduce the points of the later attempts. Default:
    recorded attempts have no hints."""

    @model_validator(mode="after")
    def _in_order(self) -> "AttemptsSpec":
        if self.closes is not None and self.due is None:
            raise ValueError(say("closes says how long late attempts are taken, so it needs due"))
        moments = [moment for moment in (self.opens, self.due, self.closes) if moment is not None]
        if moments != sorted(moments):
            raise ValueError(say("opens, due and closes must follow each other in this order"))
        return self
