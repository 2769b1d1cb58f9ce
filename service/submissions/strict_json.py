"""Read untrusted JSON: limit its size, and report the place of an error.

A number that JSON or a float cannot represent (NaN, 1e999) becomes text, so that it does not make
the other values unreadable.
"""

import json
import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import chain
from typing import Final

from service.regex import regex
from service.translations import Sentence, say, template

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
