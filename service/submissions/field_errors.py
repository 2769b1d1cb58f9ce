"""Pydantic's errors in words: a sentence for each type of error."""

from collections.abc import Mapping, Sequence
from typing import Any, Final

from service.regex import regex
from service.translations import Sentence, say, say_count, template

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
