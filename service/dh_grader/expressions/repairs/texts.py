"""Why a text as a whole cannot be read, and its repair: brackets, operators, prose, quotes.

The rules are in the order in which they are tried.
"""

import re
import unicodedata

from dh_grader.expressions.characters import CLOSE, LOOK_ALIKES, is_invisible
from dh_grader.expressions.errors import LIMITS, Span, quoted
from dh_grader.expressions.lexer import END, OPERAND_ENDS, PARTNERS, right_side
from dh_grader.expressions.repairs.failure import (
    Failure,
    Repair,
    error,
    for_causes,
    refusal,
)
from dh_grader.expressions.words import split
from dh_grader.regex import regex
from dh_grader.translations import paragraph, say

# --- A text that is too long, too large or nested too deep


@for_causes("beyond")
def repair_beyond_limits(failure: Failure) -> Repair:
    """Name the limit that is exceeded."""
    limit = failure.details["limit"]
    if limit == "characters":
        message = say(
            "This has {number:,} characters. A formula may have {most:,}.",
            number=failure.details["length"],
            most=LIMITS.characters,
        )
        return error(failure, "too_long", message)
    if limit == "nodes":
        message = say(
            "This has more than {most:,} operations and values. Write it shorter.",
            most=LIMITS.nodes,
        )
        return error(failure, "too_many_nodes", message)
    if limit == "terms":
        message = say("A sum or a product here is too long. Collect its terms.")
        return error(failure, "too_many_nodes", message)
    message = say(
        "More than {most} brackets, signs or functions stand inside each other. "
        "Write it with fewer.",
        most=LIMITS.depth,
    )
    return error(failure, "too_deep", message)


# --- A dash alone, which tables print for an empty cell or for zero


_DASH = regex(r"[-–—−‐‑‒―]+")


def repair_dash(failure: Failure) -> Repair:
    """Suggest 0, and say that a dash may mean zero or nothing."""
    if _DASH.fullmatch(failure.source.strip()) is None:
        return None
    message = say("A dash may mean zero or nothing. If the value is zero, write 0.")
    return error(failure, "dash", message, "0", (0, len(failure.source)))


# --- An empty text


repair_empty = refusal(
    "empty", "empty", say("Nothing is written here. If the value is zero, write 0.")
)


# --- A comment after the expression: % in MATLAB and LaTeX, # in Python, // and /* in C


_COMMENT = regex(r"(?<!\\)%|#|//|/\*|\(\*")
# A word of prose.
_COMMENT_WORD = regex(r"(?!(?:deg|rad|sin|cos|tan)\b)[^\W\d_]{3,}")
_BEGINS_WITH_OPERATOR = regex(r"[-+*/^=(,]")


def repair_comment(failure: Failure) -> Repair:
    """Suggest the text without the comment, or one slash instead of two."""
    match = _COMMENT.search(failure.source)
    if match is None:
        return None
    before, after = failure.source[: match.start()].rstrip(), failure.source[match.end() :].strip()
    if not before or (match.group() == "%" and not after):
        return None
    division = f"{before}/{after}"
    if match.group() == "//" and failure.repaired(division) == division:
        message = say(
            "// is a comment in some languages and a whole-number division in others. "
            "For a fraction, write one slash."
        )
        return error(failure, "comment", message, division, match.span())
    span = match.start(), len(failure.source)
    # The text after the sign seems to be part of the formula, not a comment.
    if (
        not _COMMENT_WORD.search(after)
        or _BEGINS_WITH_OPERATOR.match(after)
        or _BEGINS_WITH_OPERATOR.match(before[-1:])
    ):
        before = ""
    message = say(
        "The text after {sign} looks like a comment. Write only the formula.", sign=match.group()
    )
    return error(failure, "comment", message, before or None, span)


# --- Names in quotation marks, or declared as in a program: 'q1', Symbol('q1')


_QUOTED = regex(
    r"(?:\b(?:\w+\.)?(?:Symbol|symbols|sym|var|syms)\(\s*)?([\"'“”‘’])([^\"'“”‘’]*)[\"'“”‘’](\s*\))?"
)
# A mark between digits, as in 1’5, does not quote a name.
_BETWEEN_DIGITS = regex(r"[0-9][\"'“”‘’]+[0-9]")


def repair_quotes(failure: Failure) -> Repair:
    """Suggest the text without quotation marks."""
    match = _QUOTED.search(failure.source)
    if match is None or _BETWEEN_DIGITS.search(failure.source):
        return None
    suggestion = _QUOTED.sub(_inside, failure.source).strip()
    message = say("Write names without quotation marks.")
    return error(failure, "quotes", message, suggestion or None, match.span())


def _inside(found: re.Match[str]) -> str:
    called = "(" in found.group()[: found.start(1) - found.start()]
    return found[2] if called or found[3] is None else found[2] + found[3]


# --- An equation in place of a value: sin(q1) = 0.5, a = b = c


_EQUALS = regex(r":=|&?=+|≈|≡|≔|\\(?:approx|equiv|coloneqq)(?![A-Za-z])")
_NAME = regex(r"\s*\\?[^\W\d]\w{0,20}\s*")


def repair_equation(failure: Failure) -> Repair:
    """Suggest the right side of the equation if each left side is a name."""
    signs = list(_EQUALS.finditer(failure.source))
    if not signs or right_side(failure.source, failure.vocabulary)[1] is not None:
        return None
    starts = [0, *(sign.end() for sign in signs)]
    left = [failure.source[a : b.start()] for a, b in zip(starts, signs, strict=False)]
    value = failure.source[signs[-1].end() :].strip()
    suggestion = value if all(map(_NAME.fullmatch, left)) else None
    message = say("This is an equation. Write only the value.")
    return error(failure, "equation", message, suggestion or None, signs[0].span())


# --- Words instead of a value: variable, depends on theta, n/a


_WORD = regex(r"[A-Za-zÀ-ÿ]+")
_FORMULA = regex(r"[-+*/^=(){}\[\]_0-9\\]")
_PHRASES = {
    *("n/a", "n.a.", "na", "none", "null", "nil", "variable", "var", "unknown", "tbd", "idk"),
    *("any", "free", "same", "constant", "const", "undefined", "joint variable", "varies"),
    *("nothing", "not applicable", "empty", "yes", "no", "see above", "todo"),
    *("?", "??", "???", "...", "…"),
}
_NUMBERS = {"zero": "0", "one": "1", "two": "2", "ninety": "90", "half": "1/2", "nil": "0"}


def repair_prose(failure: Failure) -> Repair:
    """Ask the student for a number or a formula."""
    text = failure.source.strip().lower()
    number = _NUMBERS.get(text)
    if text not in _PHRASES and number is None and not _is_prose(failure):
        return None
    message = say("These are words. Write a number or a formula, such as 0 or theta1.")
    return error(failure, "prose", message, number, (0, len(failure.source)))


def _is_prose(failure: Failure) -> bool:
    if failure.cause != "name" or _FORMULA.search(failure.source):
        return False
    words = [word for word in _WORD.findall(failure.source) if len(word) > 1]
    return sum(split(word, failure.vocabulary) is None for word in words) > 1


# --- Invisible characters, which often come from pasting


@for_causes("invisible")
def repair_invisible_character(failure: Failure) -> Repair:
    """Name the character, and suggest the text without invisible characters."""
    letter = failure.written
    name = unicodedata.name(letter, f"U+{ord(letter):04X}").lower()
    if unicodedata.category(letter) in {"Mn", "Me"} and not "\ufe00" <= letter <= "\ufe0f":
        message = say(
            "There is a mark here that changes the letter before it ({name}). Delete it.",
            name=name,
        )
        return error(failure, "invisible_character", message)
    message = say(
        "There is an invisible character here ({name}), perhaps from pasting. Delete it.",
        name=name,
    )
    kept = (each for each in failure.source if each in "\t\n\r" or not is_invisible(each))
    return error(failure, "invisible_character", message, "".join(kept))


# --- Letters of another alphabet that look like Latin or Greek letters


@for_causes("look_alike")
def repair_look_alike_character(failure: Failure) -> Repair:
    """Name the letter, and suggest the text with all look-alike letters replaced."""
    letter = failure.written
    plain = LOOK_ALIKES[letter]
    message = say(
        "This looks like the letter {letter}, but is the {name}. Type {letter}.",
        letter=plain,
        name=unicodedata.name(letter).lower(),
    )
    repaired = "".join(LOOK_ALIKES.get(letter, letter) for letter in failure.source)
    return error(failure, "look_alike_character", message, repaired)


# --- A prime or an apostrophe: a transpose in MATLAB, a derivative or another symbol on paper


# A mark after a number may be its unit, such as minutes of an angle, so it must not be removed.
_NUMBER = regex(r"(?<![\w.])[0-9.]+\s*$")
_RAISED_T = regex(r"\^\s*\{?\s*(?:\\top|T)\s*\}?|\.'")


@for_causes("transpose", "name", "command", "character")
def repair_transpose(failure: Failure) -> Repair:
    """Suggest the text without the prime."""
    # There is no suggestion if this would join digits.
    span = failure.span
    if failure.cause != "transpose":
        match = _RAISED_T.search(failure.source)
        if match is None or match.end() < span[0] or match.start() > span[1]:
            return None
        span = match.span()
    mark = quoted(failure.source[slice(*span)].strip())
    message = say(
        "A single value has no transpose and no derivative here. Leave out {mark}.", mark=mark
    )
    before, after = failure.source[: span[0]], failure.source[span[1] :]
    if _NUMBER.search(before) or (before[-1:].isdigit() and after[:1].isdigit()):
        return error(failure, "transpose", message, None, span)
    return error(failure, "transpose", message, (before + after).strip() or None, span)


# --- A wrong number of arguments: atan2 of one value, atan(y, x), or cos(0,5)


@for_causes("arguments")
def repair_wrong_number_of_arguments(failure: Failure) -> Repair:
    """Say how many arguments the function takes, and suggest atan2 for atan(y, x)."""
    name, wanted = failure.details["name"], failure.details["wanted"]
    places = failure.details["places"]
    if len(places) == 2 * wanted and (point := _with_points(failure)) is not None:
        comma = say("A comma separates values. Write one number with a point.")
        return error(failure, "decimal_comma", comma, point, (places[0][1], places[1][0]))
    message = _counted(name, wanted, len(places))
    suggestion = None
    if name == "atan" and len(places) == 2:
        suggestion = failure.replaced("atan2", failure.details["function"])
    if name == "atan2":
        message = paragraph(message, say("Write atan2(y, x)."))
    return error(failure, "wrong_number_of_arguments", message, suggestion)


def _counted(name: str, wanted: int, found: int) -> str:
    if wanted == 1:
        return say(
            "The function {name} takes one value, and {found} values stand here.",
            name=name,
            found=found,
        )
    if found == 1:
        return say(
            "The function {name} takes {wanted} values, and one stands here.",
            name=name,
            wanted=wanted,
        )
    return say(
        "The function {name} takes {wanted} values, and {found} values stand here.",
        name=name,
        wanted=wanted,
        found=found,
    )


def _with_points(failure: Failure) -> str | None:
    places = failure.details["places"]
    source = failure.source
    for left, right in reversed(list(zip(places[::2], places[1::2], strict=True))):
        around = source[left[1] - 1], source[right[0]]
        if source[left[1] : right[0]] != "," or not all(map(str.isdigit, around)):
            return None
        source = f"{source[: left[1]]}.{source[right[0] :]}"
    return None if failure.details["name"] == "atan" else source


# --- A bracket that is closed by a bracket of another kind: (q1 + q2]


_COMMAND = regex(r"\\(?:[dtc]?frac|sqrt)\s{0,8}$")


@for_causes("mismatch")
def repair_mismatched_bracket(failure: Failure) -> Repair:
    """Name both brackets and say where they are. Suggest the closing bracket that fits."""
    opener, wanted = failure.details["opener"], failure.details["wanted"]
    first = quoted(failure.source[slice(*opener)])
    if wanted == CLOSE or failure.span[0] == failure.span[1]:
        message = say(
            "The {bracket} at character {place} has no closing bracket.",
            bracket=first,
            place=opener[0] + 1,
        )
        if command := _COMMAND.search(failure.source, 0, opener[0]):
            message = say(
                "Write braces after `{command}`, not {bracket}.",
                command=command[0].rstrip(),
                bracket=first,
            )
        return error(failure, "mismatched_bracket", message, span=opener)
    message = say(
        "{opening} at character {start} is closed by {closing} at character {end}. "
        "Use two brackets of one kind.",
        opening=first,
        start=opener[0] + 1,
        closing=quoted(failure.written),
        end=failure.span[0] + 1,
    )
    return error(failure, "mismatched_bracket", message, failure.replaced(wanted))


# --- A function without its argument: sin, sin(), sin * q1


@for_causes("grammar")
def repair_function_without_argument(failure: Failure) -> Repair:
    """Ask for the argument; suggest sin(-q1) for sin -q1."""
    if failure.terminal(1) == "FUNCTION":
        span = failure.place(1)
    elif [failure.terminal(back) for back in (2, 1, 0)] == ["FUNCTION", "LEFT", "RIGHT"]:
        span = failure.place(2)
    else:
        return None
    suggestion = None
    if failure.terminal() == "MINUS" and failure.terminal(-1) == "NAME":
        start, end = failure.span[0], failure.place(-1)[1]
        suggestion = failure.replaced(f"({failure.source[start:end]})", (span[1], end))
    message = say(
        "{function} has no argument. Write it in brackets, as in sin(x).",
        function=quoted(failure.source[slice(*span)]),
    )
    return error(failure, "function_without_argument", message, suggestion, span)


# --- A full stop or a comma at the end, as after a formula in a sentence


@for_causes("grammar", "character")
def repair_trailing_punctuation(failure: Failure) -> Repair:
    """Suggest the text without the final punctuation."""
    text = failure.source.rstrip().rstrip("$").rstrip()
    kept = text.rstrip(".,: ")
    if text[-1:] not in {".", ",", ":"} or not kept or failure.span[0] < len(kept):
        return None
    message = say("Leave out the {mark} at the end.", mark=quoted(text[-1]))
    span = (len(kept), len(text))
    suggestion = failure.replaced("", span).rstrip()
    return error(failure, "trailing_punctuation", message, suggestion, span)


# --- A text that ends with an operator


_OPERATORS = frozenset({"PLUS", "MINUS", "STAR", "SLASH", "POWER", "ROOT"})


@for_causes("grammar")
def repair_trailing_operator(failure: Failure) -> Repair:
    """Suggest the text without the operator."""
    if failure.terminal() != END or failure.terminal(1) not in _OPERATORS:
        return None
    start, end = span = failure.place(1)
    operator, before = failure.source[start:end], failure.source[:start].rstrip()
    message = say(
        "Something is missing after the {operator} at the end.", operator=quoted(operator)
    )
    return error(failure, "trailing_operator", message, before or None, span)


# --- A bracket without its partner


_BEFORE_BRACKET = OPERAND_ENDS | {"LEFT"}


@for_causes("unclosed", "grammar")
def repair_unbalanced_bracket(failure: Failure) -> Repair:
    """Suggest closing all brackets at the end of the text, or removing a superfluous one."""
    if failure.cause == "unclosed":
        return _without_partner(failure, failure.span, f"{failure.source}}}")
    if failure.terminal(1) and failure.terminal(1) not in _BEFORE_BRACKET:
        return None
    opened = _opened(failure)
    if failure.terminal() == "RIGHT" and not opened:
        return _without_partner(failure, failure.span, failure.replaced(""))
    if failure.terminal() == END and opened:
        closing = "".join(PARTNERS.get(failure.source[start], ")") for start, _ in opened[::-1])
        return _without_partner(failure, opened[-1], f"{failure.source.rstrip()}{closing}")
    return None


def _opened(failure: Failure) -> list[Span]:
    opened: list[Span] = []
    for terminal, _, start, end in failure.details["tokens"][: failure.details["index"]]:
        if terminal == "LEFT":
            opened.append((start, end))
        elif terminal == "RIGHT" and opened:
            opened.pop()
    return opened


def _without_partner(failure: Failure, span: Span, suggestion: str) -> Repair:
    bracket = failure.source[slice(*span)]
    message = say(
        "The {bracket} at character {place} has no closing bracket.",
        bracket=quoted(bracket),
        place=span[0] + 1,
    )
    if bracket in {")", "]", "}"}:
        message = say(
            "The {bracket} at character {place} has no opening bracket.",
            bracket=quoted(bracket),
            place=span[0] + 1,
        )
    return error(failure, "unbalanced_bracket", message, suggestion, span)


# --- An operator, a unit or brackets without an operand


_BEFORE_VALUE = _OPERATORS | {"LEFT", "OPEN", "COMMA", "TIGHT", "JOIN"}


@for_causes("grammar", "ambiguous_unit")
def repair_missing_operand(failure: Failure) -> Repair:
    """Say where a value is missing. Suggest pi for PI()."""
    before, terminal = failure.terminal(1), failure.terminal()
    if before and before not in _BEFORE_VALUE:
        return None
    span, suggestion = failure.span, None
    if before == "LEFT" and terminal == "RIGHT":
        span = failure.place(1)[0], span[1]
        suggestion = failure.replaced("", span) if failure.terminal(3) else None
    elif before and (before not in {"LEFT", "COMMA"} or terminal not in _OPERATORS):
        span = failure.place(1)
    message = say(
        "A value is missing next to {written}.", written=quoted(failure.source[slice(*span)])
    )
    return error(failure, "missing_operand", message, suggestion, span)


# --- A character that means nothing in a formula


def repair_unexpected_character(failure: Failure) -> Repair:
    """Name the character."""
    message = say(
        "The character {character} means nothing in a formula.", character=quoted(failure.written)
    )
    return error(failure, "unexpected_character", message)
