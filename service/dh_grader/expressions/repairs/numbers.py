"""Why a number, a unit or a power cannot be read, and its repair.

The rules are in the order in which they are tried.
"""

import re
import unicodedata

from dh_grader.expressions.errors import Span, quoted
from dh_grader.expressions.lexer import OPERAND_ENDS
from dh_grader.expressions.repairs.failure import (
    Failure,
    Repair,
    error,
    for_causes,
    refusal,
)
from dh_grader.expressions.vocabulary import IN_DEGREES
from dh_grader.regex import regex
from dh_grader.translations import say

# --- true or false instead of a number


repair_not_a_number = refusal(
    "boolean", "not_a_number", say("Write a number or a formula, not true or false.")
)


# --- ±, +/- and +-, which mean two values


_TYPED = regex(r"\+\s*/\s*-")


@for_causes("plus_minus", "grammar")
def repair_plus_minus(failure: Failure) -> Repair:
    """Ask the student for one of the two values."""
    typed = _TYPED.search(failure.source) if failure.cause == "grammar" else None
    if failure.cause == "grammar" and typed is None:
        return None
    message = say("This sign stands for two values. Write one of them, with + or with -.")
    return error(failure, "two_values", message, span=typed and typed.span())


# --- A range of values instead of one value: [0, pi], 0 < q1 < pi, -180..180


_BETWEEN = regex(
    r"[<>≤≥∈]|\.\.+|…|\\(?:leq?|geq?|lt|gt|in)(?![A-Za-z])|\bto\b|(?<=[0-9i])\s*:\s*(?=[-0-9])"
)
_LIST = regex(r"\s*(?:\[[^\[\]()]*,[^\[\]()]*[\])]|\([^\[\]()]*,[^\[\]()]*\])\s*")


def repair_interval(failure: Failure) -> Repair:
    """Ask the student for one value."""
    match = _LIST.fullmatch(failure.source) or _BETWEEN.search(failure.source)
    if match is None:
        return None
    message = say("This is a list or a range. Write one value.")
    return error(failure, "interval", message, span=match.span())


# --- NaN, infinity, or a number too large for a float


repair_not_finite = refusal(
    "not_finite",
    "not_finite",
    say("This number is infinite, undefined or too large. Write a finite number."),
)


# --- A number before a fraction, which may be a sum or a product: 2½, 2\frac{1}{2}


_NUMBER = regex(r"([0-9.]+)\s*$")


@for_causes("mixed_number")
def repair_mixed_number(failure: Failure) -> Repair:
    """Explain that 2½ may be a sum or a product, and suggest the sum."""
    fraction = failure.details["fraction"]
    start, end = failure.span
    number = _NUMBER.search(failure.source[:start])
    suggestion = None
    if number is not None:
        total = f"{number[1]} + {fraction}"
        alone = not number.start() and end == len(failure.source.rstrip())
        suggestion = failure.replaced(total if alone else f"({total})", (number.start(), end))
    message = say(
        "A number with {written} after it can mean a sum or a product. "
        "Write it out: + {fraction} or *({fraction}).",
        written=quoted(failure.written),
        fraction=fraction,
    )
    return error(failure, "two_values", message, suggestion)


# --- A comma or an apostrophe as decimal point, or a thousands separator: 1,5; 1’5; 1.000,5


_THOUSANDS = regex(r"(?<![0-9.,])[1-9][0-9]{0,2}(?:,000)+(?![0-9])")
# A number with an apostrophe as decimal mark, and one in which it may separate thousands.
_APOSTROPHE = regex(r"(?<![\w.,'’‘´`′°])[0-9]+(['’‘´`′])[0-9]+(?![0-9.,'’‘´`′])")
_IN_THOUSANDS = regex(r"[1-9][0-9]{0,2}\W[0-9]{3}")
# A number with a thousands separator, and perhaps another sign as decimal point.
_GROUPED = regex(
    r"(?<![\w.,'’])[1-9][0-9]{0,2}(?P<mark>[.,'’ \u00a0\u202f])[0-9]{3}"
    r"(?P<more>(?:(?P=mark)[0-9]{3})*)(?:(?!(?P=mark))[.,](?P<rest>[0-9]+))?"
    r"(?![0-9]|[.,'’][0-9])"
)


@for_causes("grammar", "transpose", "values")
def repair_decimal_comma(failure: Failure) -> Repair:
    """Suggest a decimal point, or explain that 1,000 is ambiguous."""
    if grouped := _grouped(failure):
        return grouped
    if failure.cause == "transpose":
        return _apostrophe(failure)
    start, end = failure.span
    left, right = failure.source[start - 1 : start], failure.source[end : end + 1]
    if failure.terminal() != "COMMA" or not (left.isdigit() and right.isdigit()):
        return None
    if any(match.start() < start < match.end() for match in _THOUSANDS.finditer(failure.source)):
        message = say("A comma separates values. Write a thousand as 1000 and one as 1.")
        return error(failure, "decimal_comma", message)
    message = say("A comma separates values. Write one number with a point.")
    point = re.sub(r"(?<=[0-9]),(?=[0-9])", ".", failure.source)
    return error(failure, "decimal_comma", message, point)


def _grouped(failure: Failure) -> Repair:
    numbers = (each for each in _GROUPED.finditer(failure.source) if _is_sure(each))
    start, end = failure.span
    number = next((each for each in numbers if each.start() <= end and start <= each.end()), None)
    if number is None:
        return None
    typed, rest = number[0], number["rest"]
    whole = typed[: len(typed) - len(rest) - 1] if rest else typed
    plain = re.sub(r"[^0-9]", "", whole) + (f".{rest}" if rest else "")
    message = say(
        "`{typed}` has a thousands separator. Write {number}.",
        # A no-break space looks like a space, but cannot be printed everywhere.
        typed=re.sub(r"\s", " ", typed),
        number=plain,
    )
    repaired = failure.source[: number.start()] + plain + failure.source[number.end() :]
    return error(failure, "decimal_comma", message, repaired, number.span())


def _is_sure(number: re.Match[str]) -> bool:
    # 1.000 is a number, and 1,000 or 1 000 may be two.
    if number["mark"] in "\u00a0\u202f":
        return True
    return bool(number["rest"] or (number["more"] and number["mark"] in ".'’"))


def _apostrophe(failure: Failure) -> Repair:
    numbers = _APOSTROPHE.finditer(failure.source)
    number = next((match for match in numbers if match.span(1) == failure.span), None)
    if number is None:
        return None
    message = say("An apostrophe is no decimal point. Write one number with a point.")
    point = None if _IN_THOUSANDS.fullmatch(number.group()) else failure.replaced(".")
    return error(failure, "decimal_comma", message, point)


# --- Roots other than the square root: ∛x, \sqrt[3]{x}


repair_cube_root = refusal(
    "cube_root",
    "cube_root",
    say("Write this root as a power: (x)^(1/3)."),
)


# --- Units after a length: 0.5 m, 30cm, \SI{0.5}{\metre}


_UNIT = regex(
    r"(?:k|c|m|d|µ|μ)?m|in|inch|inches|ft|foot|feet|(?:centi|milli)?met(?:er|re)s?|[°]?C|kg|s|N"
)
_METRES = frozenset({"m", "meter", "meters", "metre", "metres"})
_QUANTITY = regex(r"\\[A-Za-z]{2,3}\s{0,4}\{([^{}]*)\}\s{0,4}\{\s{0,4}\\?([^{}]*?)\s{0,4}\}")
# In l2 s(q1), s is the sine and not the second.
_FUNCTIONS = frozenset({"s", "C"})
_OPERANDS = OPERAND_ENDS - {"UNIT"}
_OPENING = regex(r"(?<=[\w.)}])\s{0,4}[(\[]\s{0,4}\Z")
_CLOSING = regex(r"\s{0,4}[)\]]")
_WITHOUT_UNIT = say("Write lengths without a unit, in the unit of the exercise.")


@for_causes("name", "quantity")
def repair_length_unit(failure: Failure) -> Repair:
    """Ask for a number without a unit; suggest this number if the unit is metres."""
    if failure.cause == "quantity":
        return _quantity(failure)
    written = unicodedata.normalize("NFKC", failure.written)
    brackets = _brackets(failure)
    is_after_value = failure.details["before"] in _OPERANDS or brackets != failure.span
    if not is_after_value or not _UNIT.fullmatch(written):
        return None
    if failure.details["called"] and failure.written in _FUNCTIONS:
        return None
    if written not in _METRES:
        message = say(
            "Write lengths without a unit, in the unit of the exercise. Convert {unit} first.",
            unit=written,
        )
        return error(failure, "length_unit", message)
    start, end = brackets
    number = failure.source[:start].rstrip() + failure.source[end:]
    return error(failure, "length_unit", _WITHOUT_UNIT, number)


def _brackets(failure: Failure) -> Span:
    start, end = failure.span
    opening = _OPENING.search(failure.source, 0, start)
    closing = _CLOSING.match(failure.source, end)
    return (opening.start(), closing.end()) if opening and closing else failure.span


def _quantity(failure: Failure) -> Repair:
    quantity = _QUANTITY.fullmatch(failure.written)
    if quantity is None or quantity[2] not in _METRES:
        message = say(
            "Write lengths without a unit, in the unit of the exercise. Convert this one first."
        )
        return error(failure, "length_unit", message)
    return error(failure, "length_unit", _WITHOUT_UNIT, failure.replaced(quantity[1]))


# --- tan2(y, x) instead of atan2(y, x)


_TAN2 = regex(r"\\?(?:tan|tang|a ?tan|atang|artan|arctan|arctang)[ _]?\{?2\}?(?=\s*(?:\\left)?\()")

_KNOWN = {"atan2", "arctan2", r"\atan2", r"\arctan2"}


@for_causes("name", "grammar")
def repair_tan_of_two(failure: Failure) -> Repair:
    """Suggest atan2."""
    match = _TAN2.search(failure.source)
    if match is None or match.end() > failure.span[1] or match.group() in _KNOWN:
        return None
    if failure.cause == "grammar" and failure.terminal() != "COMMA":
        return None
    message, span = say("Write the angle of a point (x, y) as atan2(y, x)."), match.span()
    return error(failure, "tan_of_two", message, failure.replaced("atan2", span), span)


# --- The text 2e1 if e1 is a symbol: it may be a power of ten or a product


@for_causes("ambiguous_number")
def repair_ambiguous_number(failure: Failure) -> Repair:
    """Explain that 2e1 is ambiguous, and suggest the product."""
    product = failure.details["product"]
    message = say(
        "{written} may be a power of ten or a product. For the product, write {product}.",
        written=quoted(failure.written),
        product=product,
    )
    return error(failure, "ambiguous_number", message, failure.replaced(product))


# --- A star after a joint variable that may mark the variable or be a product: k*q1*+s1


@for_causes("ambiguous_star")
def repair_ambiguous_star(failure: Failure) -> Repair:
    """Explain that the star is ambiguous, and suggest the text without the star."""
    (start, end) = failure.details["star"]
    variable = failure.source[failure.span[0] : start].strip()
    message = say(
        "The * after {written} may mark the joint variable. Delete it, or write the product as "
        "{variable}*(…).",
        written=quoted(variable),
        variable=variable,
    )
    return error(failure, "ambiguous_star", message, failure.replaced("", (start, end)))


# --- A unit of angles in brackets, as in headers: 90 [deg], 1.57 (rad)


_BRACKETED = regex(r"(?<=[\w.)}])\s{0,4}([(\[])\s{0,4}(°|deg|rad)\s{0,4}[)\]]")


@for_causes("grammar", "ambiguous_unit")
def repair_bracketed_unit(failure: Failure) -> Repair:
    """Suggest the unit without brackets."""
    found = _BRACKETED.search(failure.source)
    if found is None:
        return None
    unit = "°" if found[2] == "°" else f" {found[2]}"
    message = say("Write the unit without brackets.")
    return error(
        failure, "missing_operand", message, failure.replaced(unit, found.span()), found.span()
    )


# --- A unit that is ambiguous: 2deg(q1), degrees(90), π/2°, 180/2°


@for_causes("ambiguous_unit")
def repair_ambiguous_unit(failure: Failure) -> Repair:
    """Ask the student to write the unit after a number."""
    if "inside" in failure.details:
        return _inside(failure)
    if not failure.details["opens"]:
        return None
    message = say(
        "A unit before a bracket has two readings. Write an operator between them, "
        "as in 2deg*(3), or the unit after the bracket, as in (180/2)deg."
    )
    return error(failure, "ambiguous_unit", message)


def _inside(failure: Failure) -> Repair:
    (start, end), inside = failure.span, failure.details["inside"]
    value = failure.source[slice(*inside)]
    if failure.details["of_pi"]:
        message = say("With π, a unit of degrees has two readings: π/2 is already 90°.")
        value = value if start == inside[0] else f"({value})"
        return error(failure, "ambiguous_unit", message, failure.replaced(value))
    message = say("A unit after a quotient has two readings. Write brackets, as in (180/2)°.")
    unit = failure.source[inside[1] : end]
    return error(failure, "ambiguous_unit", message, failure.replaced(f"({value}){unit}"))


# --- Functions such as acosd and rad2deg, which return degrees, in a text with radians


_MODULE = regex(r"[A-Za-z]+\.$")


@for_causes("degrees")
def repair_degrees_function(failure: Failure) -> Repair:
    """Suggest the function that returns the angle in radians: acos for acosd."""
    plain = IN_DEGREES.get(failure.details["name"], "")
    start, end = failure.span
    if not plain and (module := _MODULE.search(failure.source[:start])):
        start = module.start()
    written = quoted(failure.written)
    message = say(
        "{written} gives a number of degrees, not an angle. Write the angle itself.",
        written=written,
    )
    if plain:
        message = say(
            "{written} gives a number of degrees, not an angle. "
            "Write {function}, which gives the angle.",
            written=written,
            function=plain,
        )
    return error(failure, "degrees_function", message, failure.replaced(plain, (start, end)))


# --- A unit after a variable: (q1 + 90)deg. Only numbers have units


_UNITS = {"°", "deg", "degree", "degrees", "rad", "radian", "radians"}
_IN_DEGREES = {"°", "deg", "degree", "degrees"}
# A number without a unit that is a term by itself.
_TERM = regex(
    r"(?<![\w.^*/°])(?:(?<=^)|(?<=[-+(\[{,;=\s]))((?:[0-9]+\.?[0-9]*|\.[0-9]+)(?![\w.^]))"
    r"(?=\s*(?:[-+)\]},;]|$))"
)
_BRACKETS = regex(r"[(\[{|\\]")


@for_causes("unit_on_variable")
def repair_unit_on_variable(failure: Failure) -> Repair:
    """Ask the student to write the unit after a number."""
    name = quoted(failure.source[slice(*failure.details["variable"])])
    message = say("A unit belongs after a number. Write it there, and not after {name}.", name=name)
    return error(failure, "unit_on_variable", message, _repaired(failure))


def _repaired(failure: Failure) -> str | None:
    # Return the text without the unit if it follows only the variable (q1° -> q1); else None.
    # In 90 + q1°, the unit belongs to the number, so it is moved to the number.
    start, end = failure.span
    inside = failure.details["variable"]
    rest = failure.source[inside[1] : end].strip()
    if inside[0] != start or rest not in _UNITS:
        return None
    before, after = failure.source[: inside[1]], failure.source[end:]
    if rest not in _IN_DEGREES or not (_TERM.search(before) or _TERM.search(after)):
        return before + after
    if _BRACKETS.search(failure.source):
        return None
    unit = "°" if rest == "°" else f" {rest}"
    return _TERM.sub(rf"\g<1>{unit}", before + after)


# --- A value with two units: 90 deg deg, deg(90°)


repair_two_units = refusal("two_units", "two_units", say("This has two units. Write one."))


# --- Powers of functions: sin^-1(x), which may mean asin(x) or 1/sin(x), and sin^k(x)


_INVERSE = regex(r"(-\s*1|[({]\s*-\s*1\s*[)}])(?![0-9.])")
# An exponent -1 in the source text, in any notation.
_END = regex(r"[\s^*]*(?:⁻\s*¹|[({]*\s*[-−–]\s*1(?:\s*[)}])*)")


@for_causes("function_power")
def repair_function_power(failure: Failure) -> Repair:
    """Suggest the inverse function for ^-1. Show how to write other powers: (sin(x))^p."""
    name, exponent = failure.details["name"], failure.details["exponent"]
    place = failure.details["function"]
    if not exponent.strip():
        message = say("The function {name} has no argument. Write {name}(x).", name=name)
        return error(failure, "function_without_argument", message, span=place)
    if _INVERSE.match(exponent) is None:
        message = say(
            "The power of a function is a whole number. Write another power as (sin(x))^p."
        )
        return error(failure, "function_power", message, span=(place[1], failure.span[1]))
    end = _END.match(failure.source, place[1])
    whole = (place[0], end.end() if end else failure.span[1])
    inverse = f"a{name}" if name in {"sin", "cos", "tan"} else None
    message = say("A negative power of a function has two readings. Write 1/{name}(x).", name=name)
    if inverse:
        message = say(
            "This has two readings. Write {inverse}(x) for the inverse function, or 1/{name}(x).",
            inverse=inverse,
            name=name,
        )
    suggestion = inverse and failure.replaced(inverse, whole)
    return error(failure, "function_power", message, suggestion, whole)


# --- A power of a power, such as 2^3^2, which is ambiguous


@for_causes("grammar")
def repair_chained_power(failure: Failure) -> Repair:
    """Ask the student to add brackets."""
    if failure.terminal() != "POWER" or failure.terminal(1) not in OPERAND_ENDS:
        return None
    message = say("A power of a power has two readings. Add brackets: (a^b)^c or a^(b^c).")
    return error(failure, "chained_power", message)


# --- A number with two points: 1.2.3


@for_causes("values")
def repair_malformed_number(failure: Failure) -> Repair:
    """Say that the number has more than one point."""
    if not failure.details["number"] or "." not in failure.written:
        return None
    message = say("{written} has more than one decimal point.", written=quoted(failure.written))
    return error(failure, "malformed_number", message)


# --- Two values instead of one: ``2 3``, ``q1, q2``, ``90° (π/2)``, or a second line


@for_causes("values", "grammar")
def repair_two_values(failure: Failure) -> Repair:
    """Ask the student for one value, or for an operator between the two values."""
    start, end = failure.span
    if failure.terminal(1) and failure.terminal() != "COMMA":
        start = failure.place(1)[0]
    message = say("Two values stand side by side. Write one value, or an operator between them.")
    return error(failure, "two_values", message, failure.details.get("instead"), (start, end))
