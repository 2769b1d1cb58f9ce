"""Untrusted JSON as a submission: limits, places of errors in words, nearest ids.

A number that JSON or a float cannot represent (NaN, 1e999) becomes text, so that it does not
make the other values unreadable.
"""

import difflib
import json
import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any, Final, Literal, TypeVar, cast

from pydantic import BaseModel, ConfigDict, Field, SkipValidation, StrictBool

from dh_grader.catalogue import Exercise, FeedbackLevel, least
from dh_grader.catalogue.kinds import posted_forms
from dh_grader.grading import Submission
from dh_grader.regex import regex
from dh_grader.translations import Sentence, paragraph, say, say_count, template
from dh_grader.variants import NoVariantError, variant_of

# --- Read untrusted JSON: limit its size, and report the place of an error
#
# A number that JSON or a float cannot represent (NaN, 1e999) becomes text, so that it does not make
# the other values unreadable.


MAX_BODY_SIZE: Final = 256 * 1024
# The deepest answer, a list of matrices, needs five levels.
MAX_DEPTH: Final = 64
# Seven link transforms have 36 lists; thousands would only take time.
MAX_BRACKETS: Final = 5_000
# The most commas, including those in texts. Sixty-four submissions with all answers to an exercise
# with seven joints have 13,000.
MAX_COMMAS: Final = 20_000

# What Python's own reader says; it has no templates.
_SYNTAX_ERRORS: Final = frozenset(
    (
        template("Expecting value."),
        template("Expecting property name enclosed in double quotes."),
        template("Expecting ':' delimiter."),
        template("Expecting ',' delimiter."),
        template("Illegal trailing comma before end of object."),
        template("Illegal trailing comma before end of array."),
        template("Extra data."),
        template("Unterminated string starting at."),
        template("Invalid control character at."),
        template("Invalid \\escape."),
        template("Invalid \\uXXXX escape."),
    )
)
_DIGITS_OF_A_FLOAT: Final = 308
_SURROGATE_ESCAPE: Final = regex(r"\\u[dD][89a-fA-F]")
_LONE_SURROGATE: Final = regex(r"[\ud800-\udfff]")


@dataclass(eq=False)
class MalformedError(ValueError):
    """The text is not valid JSON or exceeds a limit; ``line`` and ``column`` count from 1."""

    reason: str
    line: int | None = None
    column: int | None = None

    def __str__(self) -> str:
        """The reason, with its place if known."""
        if self.line is None:
            return self.reason
        return say(
            "{reason} (line {line}, column {column})",
            reason=self.reason,
            line=self.line,
            column=self.column or 1,
        )


def read_json(data: bytes) -> object:
    """Return the value of a JSON text in UTF-8. Raises MalformedError."""
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise MalformedError(
            say("This is not UTF-8 text: byte {byte} is wrong.", byte=error.start + 1)
        ) from error
    if not text.strip():
        raise MalformedError(say("There is nothing here; a JSON object is expected."))
    if text.count("[") + text.count("{") > MAX_BRACKETS:
        raise MalformedError(
            say("There are more than {most} lists and objects.", most=MAX_BRACKETS)
        )
    if text.count(",") > MAX_COMMAS:
        raise MalformedError(say("There are more than {most} commas.", most=MAX_COMMAS))
    try:
        value: object = _DECODER.decode(text)
    except json.JSONDecodeError as error:
        reason = f"{error.msg}."
        if reason in _SYNTAX_ERRORS:
            reason = Sentence(reason)
        raise MalformedError(reason, error.lineno, error.colno) from error
    except RecursionError:
        raise _too_deep() from None
    # Few brackets cannot be nested deep, so nearly every body skips the check of its values.
    if text.count("[") + text.count("{") > MAX_DEPTH and nested_deeper(value, MAX_DEPTH):
        raise _too_deep()
    return _without_surrogates(value) if _SURROGATE_ESCAPE.search(text) else value


def nested_deeper(value: object, depth: int) -> bool:
    """True if lists and objects are nested more than ``depth`` deep."""
    level: list[object] = [value]
    for _ in range(depth):
        level = list(chain.from_iterable(map(_inside, level)))
        if not level:
            return False
    return any(isinstance(inmost, dict | list) for inmost in level)


def _inside(value: object) -> Iterable[object]:
    if isinstance(value, dict):
        return value.values()
    return value if isinstance(value, list) else ()


def _too_deep() -> MalformedError:
    return MalformedError(
        say("Lists and objects are nested more than {most} deep.", most=MAX_DEPTH)
    )


def _unique(pairs: list[tuple[str, object]]) -> dict[str, object]:
    result = dict(pairs)
    if len(result) != len(pairs):
        [(repeated, _)] = Counter(key for key, _ in pairs).most_common(1)
        raise MalformedError(
            say("The key {key} appears twice in one object.", key=json.dumps(repeated[:60]))
        )
    return result


def _integer(digits: str) -> int | str:
    return int(digits) if len(digits) <= _DIGITS_OF_A_FLOAT else digits


def _float(text: str) -> float | str:
    value = float(text)
    return value if math.isfinite(value) else text


def _without_surrogates(value: object) -> object:
    if isinstance(value, str):
        return _LONE_SURROGATE.sub("\N{REPLACEMENT CHARACTER}", value)
    if isinstance(value, dict):
        return {
            _without_surrogates(key): _without_surrogates(child) for key, child in value.items()
        }
    return [_without_surrogates(child) for child in value] if isinstance(value, list) else value


_DECODER: Final = json.JSONDecoder(
    object_pairs_hook=_unique, parse_int=_integer, parse_float=_float, parse_constant=str
)


# --- Find an exercise by its id, or suggest the nearest id


_T = TypeVar("_T")

# Longer names are cut: comparing takes more time, and nobody mistypes a name of this length.
_LONGEST = 64


class UnknownExerciseError(LookupError):
    """No exercise has this id; ``suggestion`` is the nearest known id, or None."""

    def __init__(self, exercise_id: str, known: tuple[str, ...], reason: str = "") -> None:
        self.known = known
        self.suggestion = None if reason else nearest(exercise_id, known)
        unknown: str = say("There is no exercise {exercise!r}.", exercise=exercise_id[:_LONGEST])
        if self.suggestion:
            meant = say("Did you mean {suggestion!r}?", suggestion=self.suggestion)
            unknown = paragraph(unknown, meant)
        super().__init__(reason or unknown)


def find_exercise(catalogue: Mapping[str, _T], exercise_id: str) -> _T:
    """Return the exercise, or the variant ``<exercise>~<seed>``, with this id.

    Raises UnknownExerciseError.
    """
    try:
        return catalogue[exercise_id]
    except KeyError:
        plain_id, tilde, seed = exercise_id.partition("~")
        exercise = catalogue.get(plain_id) if tilde else None
    if not isinstance(exercise, Exercise):
        raise UnknownExerciseError(plain_id, tuple(catalogue))
    try:
        return cast("_T", variant_of(exercise, seed))
    except NoVariantError as error:
        raise UnknownExerciseError(exercise_id, tuple(catalogue), error.args[0]) from error


def nearest(name: str, known: Iterable[str]) -> str | None:
    """Return the known name that was probably meant, or None."""
    matches = difflib.get_close_matches(name[:_LONGEST].lower(), list(known), n=1, cutoff=0.5)
    return matches[0] if matches else None


# --- Pydantic's errors in words: a sentence for each type of error


# A longer pattern does not help a reader. It is the one of names, which are one visible line.
_LONGEST_PATTERN: Final = 200
_QUOTED: Final = regex(r"'([^']*)'")

_OBJECT: Final = template("This must be a JSON object.")
_TEXT: Final = template("This must be a text.")
_BOOLEAN: Final = template("This must be true or false.")
_INTEGER: Final = template("This must be a whole number.")
_NUMBER: Final = template("This must be a number.")
_MOMENT: Final = template("This must be a date with a time, such as 2026-10-01T08:00:00Z.")
_PLAIN: Final[Mapping[str, str]] = {
    "missing": template("This field is missing."),
    "extra_forbidden": template("This field is not known."),
    "model_type": _OBJECT,
    "model_attributes_type": _OBJECT,
    "dict_type": _OBJECT,
    "list_type": template("This must be a list."),
    "string_type": _TEXT,
    "bytes_type": _TEXT,  # in base64
    "bool_type": _BOOLEAN,
    "bool_parsing": _BOOLEAN,
    "int_type": _INTEGER,
    "int_parsing": _INTEGER,
    "int_parsing_size": _INTEGER,
    "int_from_float": _INTEGER,
    "float_type": _NUMBER,
    "float_parsing": _NUMBER,
    "finite_number": template("This must be a finite number."),
    "datetime_type": _MOMENT,
    "datetime_parsing": _MOMENT,
    "datetime_from_date_parsing": _MOMENT,
    "timezone_aware": template("This date needs a time zone, as in 2026-10-01T08:00:00Z."),
    "base64_decode": template("This is not base64."),
}
_LIMITS: Final[Mapping[str, str]] = {
    "greater_than": template("This must be greater than {limit}."),
    "greater_than_equal": template("This must be at least {limit}."),
    "less_than": template("This must be less than {limit}."),
    "less_than_equal": template("This must be at most {limit}."),
}


def field_error(detail: Mapping[str, Any], fields: Sequence[str] = ()) -> Sentence:
    """Return a sentence for an error that pydantic found; ``fields`` are all known fields."""
    message, kind, context = detail["msg"], detail["type"], detail.get("ctx", {})
    if kind == "value_error" and context["error"].args:
        message = context["error"].args[0]
    if isinstance(message, Sentence):
        return message
    if kind == "extra_forbidden" and fields:
        return say("This field is not known; the fields are {fields}.", fields=", ".join(fields))
    if kind in ("model_type", "model_attributes_type") and not detail["loc"]:
        return say("The body must be a JSON object.")
    if kind in _PLAIN:
        return Sentence(_PLAIN[kind])
    if kind in _LIMITS:
        # Pydantic writes 0 and not 0.0 at the end of its message.
        return Sentence(_LIMITS[kind], {"limit": message.rpartition(" ")[2]})
    found = _of_another_length(kind, context) or _of_another_form(kind, context)
    reason = message.removeprefix("Value error, ")
    return found or say("This value cannot be used ({reason}).", reason=reason)


def _of_another_length(kind: str, context: Mapping[str, Any]) -> Sentence | None:
    match kind:
        case "string_too_short":
            return say_count(
                "This must have at least {count} character.",
                "This must have at least {count} characters.",
                count=context["min_length"],
            )
        case "string_too_long":
            return say_count(
                "This may have at most {count} character.",
                "This may have at most {count} characters.",
                count=context["max_length"],
            )
        case "too_short":
            return say_count(
                "This must have at least {count} entry.",
                "This must have at least {count} entries.",
                count=context["min_length"],
            )
        case "too_long":
            return say_count(
                "This may have at most {count} entry, but has {here}.",
                "This may have at most {count} entries, but has {here}.",
                count=context["max_length"],
                here=context["actual_length"],
            )
    return None


def _of_another_form(kind: str, context: Mapping[str, Any]) -> Sentence | None:
    match kind:
        case "literal_error" | "enum":
            choices = ", ".join(_QUOTED.findall(context["expected"]))
            return say("This must be one of: {choices}.", choices=choices)
        case "string_pattern_mismatch" if len(context["pattern"]) > _LONGEST_PATTERN:
            return say("Write one line of visible characters, with single blanks between words.")
        case "string_pattern_mismatch":
            return say("This must match the pattern {pattern}.", pattern=context["pattern"])
        case "json_invalid":
            return say("This is not JSON: {reason}.", reason=context["error"])
    return None


# --- The pydantic models of a submission, as the body of a request or the content of a file


# With this number, the other limits of a body leave each submission 4 KiB and 78 lists and objects.
# All answers to an exercise with seven joints need 2 KiB and 52.
MAX_SUBMISSIONS: Final = 64


class GradeRequest(BaseModel):
    """Answers to the parts of one exercise. The grader parses them."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    answers: dict[str, Any] = Field(
        description="The answers by part id; other parts are missing. The form of an answer "
        f"depends on the kind of the part ({posted_forms()}). An entry is a number or a formula as "
        "text. A table or matrix may also be pasted as one text."
    )
    angle_unit: Literal["radians", "degrees"] = Field(
        "radians", description="The unit of angles without a unit."
    )
    feedback: Literal["full", "hints", "verdicts", "score"] | None = Field(
        None,
        description="The highest feedback level: `full` hints and corrections, `hints` hints "
        "without values, `verdicts` right and wrong entries, `score` only marks. All levels name "
        "unreadable entries. The exercise and the service may limit the level; the report names "
        "its level. Default: the highest that they allow.",
    )
    echo: StrictBool = Field(
        False, description="If true, the report shows how each cell was read, in its `read`."
    )

    def submission(self, ceiling: FeedbackLevel) -> Submission:
        """Return the submission for the grader, with at most the feedback level ``ceiling``."""
        asked = ceiling if self.feedback is None else FeedbackLevel(self.feedback)
        return Submission(self.answers, self.angle_unit, least(asked, ceiling), self.echo)


class ExerciseSubmission(GradeRequest):
    """Answers to the parts of one exercise, with the exercise's id."""

    exercise: str = Field(description="The id of the exercise.")


class GradeManyRequest(BaseModel):
    """Submissions of any learners to any exercises.

    Each is validated separately, so that an invalid one does not affect the others.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    submissions: list[SkipValidation[ExerciseSubmission]] = Field(
        max_length=MAX_SUBMISSIONS, description="The submissions; the results have their order."
    )
