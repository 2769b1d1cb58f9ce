"""Why a name cannot be read, and its repair: unknown, misspelled, indexed or of no joint.

The rules are in the order in which they are tried.
"""

import re
from typing import Final

from dh_grader.expressions import characters
from dh_grader.expressions.characters import SUBSCRIPTS, known_prefix
from dh_grader.expressions.errors import Span, quoted
from dh_grader.expressions.lexer import OPERAND_ENDS
from dh_grader.expressions.printing import symbol_latex
from dh_grader.expressions.repairs.failure import (
    Failure,
    Repair,
    error,
    for_causes,
    nearest,
    other_case,
    undeclared,
)
from dh_grader.expressions.vocabulary import ARITY, REFUSED, Kind, Symbol, Vocabulary, normal_form
from dh_grader.expressions.words import Piece, split
from dh_grader.regex import regex
from dh_grader.translations import listed, paragraph, say

# --- LaTeX commands that are unknown or lack their argument


@for_causes("command", "argument")
def repair_unknown_command(failure: Failure) -> Repair:
    r"""Name the command; suggest \cos q for \cosq."""
    name = failure.details["name"]
    if failure.cause == "argument":
        example = r"\frac{a}{b}" if "frac" in name else rf"{name.strip()}{{a}}"
        message = say(
            "The command {command} has no argument. Write it as `{example}`.",
            command=quoted(name.strip()),
            example=example,
        )
        return error(failure, "missing_operand", message)
    prefix = known_prefix(name)
    suggestion = prefix and failure.replaced(f"\\{prefix} {name[len(prefix) :]}")
    message = say(
        "The command {command} is not known. Write it in plain text: (a)/(b), sqrt(x), cos(q1).",
        command=quoted(failure.written),
    )
    return error(failure, "unknown_command", message, suggestion)


# --- A subscript that is a formula: c_{\theta_1+\theta_2}, c_{12-4}, θ₁₊₂


_FUNCTIONS = {"c": "cos", "s": "sin", "C": "cos", "S": "sin"}
# Numbers in a subscript. In s_{1+2} they are joints; in a sum of angles they would be numbers.
_BARE = regex(r"(?:^|[^A-Za-z0-9_{])\s*[0-9]")
# Books write c_{12-4} for cos(θ1 + θ2 - θ4). In c_{1-23}, the minus may apply to 2 or to 23.
_MINUS = str.maketrans("−–", "--")
_JOINTS = regex(r"[1-9]{1,9}(?:\+[1-9]{1,9}|-[1-9](?![1-9])){1,9}")


@for_causes("subscript")
def repair_subscript(failure: Failure) -> Repair:
    r"""Ask for a plain index, and suggest a cosine such as cos(θ1+θ2) for c_{\theta_1+\theta_2}."""
    start, end = failure.span
    inside = failure.details["index"]
    letter = failure.source[start - 1 : start]
    suggestion = None
    alone = not failure.source[start - 2 : start - 1].isalpha() or start < 2
    of_joints = _sum_of_joints(inside, failure)
    plain = failure.written.startswith("_") and (of_joints or not _BARE.search(inside))
    if letter in _FUNCTIONS and alone and plain:
        argument = of_joints or inside
        cosine = f" {_FUNCTIONS[letter]}({argument})"
        suggestion = failure.replaced(cosine, (start - 1, end)).strip()
    message = say(
        "An index holds letters and digits only, as in c_{{12}}. Write the cosine of "
        "a sum as cos(theta1 + theta2)."
    )
    return error(failure, "subscript", message, suggestion)


def _sum_of_joints(inside: str, failure: Failure) -> str:
    index = "".join(inside.split()).translate(_MINUS)
    if _JOINTS.fullmatch(index) is None:
        return ""
    if any(letter.isdigit() and int(letter) not in failure.vocabulary.turning for letter in index):
        return ""
    terms = re.findall(r"([+-]?)([1-9])", index)
    return "".join(f"{sign or '+'}theta{joint}" for sign, joint in terms).removeprefix("+")


# --- A letter in braces, followed by its index: {\theta}_1, {c}_{12}


_LETTER = rf"\\?[A-Za-z]+|[{characters.CLASS}{''.join(characters.VARIANTS)}]"
_STYLED_LETTER = (
    rf"{_LETTER}|\\(?:{'|'.join(sorted(characters.STYLES))})"
    rf"\s*\{{\s*(?:{_LETTER})\s*\}}"
)
_INDEX = rf"(?:_(?:\{{[^{{}}]*\}}|[A-Za-z0-9]+)|[{''.join(SUBSCRIPTS)}]+|[0-9]+)"
_BRACED = regex(rf"\{{\s*({_STYLED_LETTER})\s*\}}(\s*{_INDEX})")
_WITHOUT_ARGUMENT = {*characters.FUNCTIONS, *characters.PLAIN, *characters.SPACES}
# After these, a brace encloses an index, a power or the argument of a command.
_TAKEN = regex(r"(?:[_^]|\\([A-Za-z]+))\s*$")


@for_causes("name")
def repair_braced_stem(failure: Failure) -> Repair:
    """Suggest the name without braces, if this is readable."""
    source, (start, end) = failure.source, failure.span
    for match in _BRACED.finditer(source):
        if not (match.start(1) <= start and end <= match.end(1)) or _is_taken(source, match):
            continue
        name = f"{match[1]}{match[2].lstrip()}"
        # Without a blank, the name would merge with a letter or a command before it.
        glued = source[: match.start()][-1:].isalnum() and name[0].isalpha()
        joined = failure.replaced(f" {name}" if glued else name, match.span())
        repaired = failure.repaired(joined)
        if repaired is None:
            return None
        message = say("Write the name and its index without the braces: {name}.", name=quoted(name))
        return error(failure, "braced_stem", message, repaired, match.span())
    return None


def _is_taken(source: str, match: re.Match[str]) -> bool:
    before = _TAKEN.search(source[: match.start()])
    return before is not None and before[1] not in _WITHOUT_ARGUMENT


# --- A raised 0 or o as degree sign: 90⁰, 90^0, 90^o


_LETTER_O = "[oO]"
_STYLED_O = rf"(?:\\[a-z]+\s*\{{\s*{_LETTER_O}\s*\}}|{_LETTER_O})"
# The second form, 90o, comes from copying a raised sign as plain text.
_RAISED = regex(rf"\^\s*(?:\{{\s*{_STYLED_O}\s*\}}|{_STYLED_O})|(?<=[0-9])\s*o")


@for_causes("raised_zero", "name")
def repair_raised_zero(failure: Failure) -> Repair:
    """Suggest the degree sign, or explain that 90^0 may also be a power."""
    span = _raised_letter(failure) if failure.cause == "name" else failure.span
    if span is None:
        return None
    message = say("Write degrees as 90° or 90deg.")
    if failure.details.get("power"):
        message = say(
            "A raised 0 looks like the sign of degrees. Write 90° or 90deg for degrees, "
            "and 1 for the power."
        )
    return error(failure, "raised_zero", message, failure.replaced("°", span), span)


def _raised_letter(failure: Failure) -> Span | None:
    if failure.written not in {"o", "O"}:
        return None
    start, end = failure.span
    matches = (match.span() for match in _RAISED.finditer(failure.source))
    return next((place for place in matches if place[0] <= start and end <= place[1]), None)


# --- q1(t): a joint variable as a function of time


_OF_TIME = regex(r"\s*(?:\\left)?\(\s*t\s*(?:\\right)?\)")


@for_causes("name")
def repair_function_of_time(failure: Failure) -> Repair:
    """Suggest the text without (t)."""
    without_time, count = _OF_TIME.subn("", failure.source)
    if failure.details["run"] != "t" or not count:
        return None
    message = say("Write joint variables without the time: q1, not q1(t).")
    return error(failure, "function_of_time", message, without_time)


# --- The letter x as product sign: 2 x q1


@for_causes("name")
def repair_letter_x(failure: Failure) -> Repair:
    """Suggest * for an x between two values."""
    run, (start, end) = failure.details["run"], failure.span
    after = failure.source[end - len(run) + 1 :].strip()
    if run[0] not in "xX" or not after or failure.details["before"] not in OPERAND_ENDS:
        return None
    message, span = say("The letter x is a name. Write * for a product."), (start, start + 1)
    return error(failure, "letter_x", message, failure.replaced("*", span), span)


# --- A name and its index with a space between them: theta 1, c 12


_DETACHED = regex(rf"([A-Za-z{characters.CLASS}]+)[ _]+([0-9]+)(?![0-9.])")


@for_causes("name")
def repair_detached_index(failure: Failure) -> Repair:
    """Suggest name and index without the space, if the result is a known name."""
    match = _DETACHED.match(failure.source, failure.span[0])
    if match is None or match.end(1) != failure.span[1]:
        return None
    joined = f"{match[1]}{match[2]}"
    pieces = split(joined, failure.vocabulary)
    if pieces is None or pieces[-1].kind not in {"symbol", "shorthand"}:
        return None
    message = say("Write the name and its index without a space: {name}.", name=joined)
    suggestion = failure.replaced(joined, match.span())
    return error(failure, "detached_index", message, suggestion, match.span())


# --- A variable that no joint has: q7 with six joints, theta12, theta3 if joint 3 slides


_JOINT = regex(rf"(?P<stem>[A-Za-z{characters.CLASS}]+?)(?P<index>[0-9]+)(?P<rest>.*)")
_STEMS = frozenset({"q", "theta", "θ", "th"})
_AS_TYPED = regex(r"[^0-9₀-₉]*(?:[0-9]+|[₀-₉]+)(?:\s*\})?")


@for_causes("name")
def repair_unknown_joint(failure: Failure) -> Repair:
    """List the robot's joints; suggest the sum of angles for theta12."""
    vocabulary = failure.vocabulary
    match = _JOINT.fullmatch(normal_form(failure.details["run"]))
    if match is None or match["stem"] not in _STEMS or not vocabulary.joints:
        return None
    if match["rest"] and split(match["rest"], vocabulary) is None:
        return None
    if match["rest"] and int(match["index"][:4]) in vocabulary.turning:
        # The joint exists; the run has another error: theta1_theta2.
        return None
    index, span = match["index"], _place(failure, bool(match["rest"]))
    written = failure.source[slice(*span)]
    suggestion = None
    message = _reason(quoted(written), int(index[:4]), vocabulary)
    variable = vocabulary.turning.get(int(index[:4]))
    if variable is not None:
        suggestion = failure.replaced(variable.name, span)
    total = _total(index, vocabulary, latex="\\" in written)
    if total is not None:
        message = paragraph(message, say("For the sum of angles write {total}.", total=total))
        start, end = span
        alone = failure.source[start - 1 : start] == "(" and failure.source[end : end + 1] == ")"
        suggestion = failure.replaced(total if alone else f"({total})", span)
    return error(failure, "unknown_joint", message, suggestion, span)


def _place(failure: Failure, goes_on: bool) -> Span:
    start, end = failure.span
    found = _AS_TYPED.match(failure.source, start, end) if goes_on else None
    return (start, found.end()) if found else (start, end)


def _total(index: str, vocabulary: Vocabulary, *, latex: bool) -> str | None:
    digits = [int(digit) for digit in index]
    if not 1 < len(digits) < 7 or len(set(digits)) < len(digits):
        return None
    turning = [vocabulary.turning[digit] for digit in digits if digit in vocabulary.turning]
    if len(turning) < 2 or not set(digits).issubset(vocabulary.joints):
        return None
    return " + ".join(symbol_latex(part) if latex else part.name for part in turning)


def _reason(written: str, joint: int, vocabulary: Vocabulary) -> str:
    if joint in vocabulary.sliding:
        return say(
            "{written}: joint {joint} slides, and its variable is {variable}.",
            written=written,
            joint=joint,
            variable=vocabulary.sliding[joint].name,
        )
    if joint in vocabulary.turning:
        return say(
            "{written}: joint {joint}'s variable is {variable} here.",
            written=written,
            joint=joint,
            variable=vocabulary.turning[joint].name,
        )
    return say(
        "{written}: there is no joint {joint}; this robot's joints are {first} to {last}.",
        written=written,
        joint=joint,
        first=vocabulary.joints[0],
        last=vocabulary.joints[-1],
    )


# --- Indices in brackets that name no symbol (q[6] with six joints) or have mixed styles


# A whole number in brackets; then the name before it is unknown, not the index.
_NUMBERED = regex(r"\[\s{0,8}\d+\s{0,8}\]")


@for_causes("index", "name")
def repair_index(failure: Failure) -> Repair:
    """Say how the index is counted, and suggest the name without brackets."""
    if failure.cause == "name":
        return _no_number(failure)
    details, written = failure.details, quoted(failure.written)
    if details["reason"] == "mixed":
        message = say("Two ways to count joints are mixed here. Write each index without brackets.")
        return error(failure, "mixed_index", message)
    if details["reason"] == "no_stem":
        message = say(
            "{written} may be an index or a factor. Write * before a factor.", written=written
        )
        return error(failure, "index", message, failure.replaced(f"*{details['digits']}"))
    run, digits = details["run"], details["digits"]
    if details["reason"] == "shorthand" and run == "S":
        message = say(
            "{written} is a number in SymPy, and may be a sine. Write {number} or s{number}.",
            written=written,
            number=digits,
        )
        return error(failure, "index", message)
    name = f"{run}{digits}"
    if details["reason"] == "shorthand":
        return error(failure, "index", _of_shorthand(failure, name), failure.replaced(name))
    if details["style"] == "(":
        message = say(
            "MATLAB counts from 1, so {written} would be {name}, which is no name here. "
            "Write the index without brackets.",
            written=written,
            name=name,
        )
        return error(failure, "index", message)
    plain = f"{run}{int(digits) - 1}"
    message = say(
        "Python counts from 0, so {written} would be {name}, which is no name here. "
        "If you mean {meant}, write it without brackets.",
        written=written,
        name=name,
        meant=plain,
    )
    return error(failure, "index", message, failure.replaced(plain))


def _of_shorthand(failure: Failure, name: str) -> str:
    """Return a sentence about a shorthand whose index is in brackets: c[1], s(2)."""
    written = quoted(failure.written)
    if failure.details["style"] == "[":
        return say(
            "Python counts from 0, so {written} would be {name}. "
            "Write the shorthand without brackets.",
            written=written,
            name=name,
        )
    return say(
        "MATLAB counts from 1, so {written} would be {name}. Write the shorthand without brackets.",
        written=written,
        name=name,
    )


def _no_number(failure: Failure) -> Repair:
    """Return the error for an index that is not a whole number: q[i], q[-1]."""
    start, end = failure.span
    if failure.source[end : end + 1] != "[" or _NUMBERED.match(failure.source, end):
        return None
    message = say("An index must be a positive whole number. Write the index without brackets.")
    return error(failure, "index", message, span=(start, end + 1))


# --- A known name in the wrong letter case: cOs for cos


@for_causes("name")
def repair_wrong_case(failure: Failure) -> Repair:
    """Suggest the name as it is declared."""
    known = other_case(failure.details["run"], failure.vocabulary, failure.details["called"])
    if known is None:
        return None
    message = say(
        "{written} is no name here, but {known} is: capital and small letters differ.",
        written=quoted(failure.written),
        known=known,
    )
    return error(failure, "wrong_case", message, failure.replaced(known))


# --- The letters e, i and j, which are not constants in a formula


_REASONS = {
    "e": say("Write a power of Euler's number as exp(x)."),
    "i": say("There are no complex numbers here."),
    "j": say("There are no complex numbers here."),
}
_POWER = regex(r"\s?(?:\^|\*\*)\s?(?:\(([^()]*)\)|\{([^{}]*)\}|([A-Za-z0-9]+))")


@for_causes("name")
def repair_euler_and_imaginary(failure: Failure) -> Repair:
    """Suggest exp(x) for a power of e; for i and j, say that there are no complex numbers."""
    reason = _REASONS.get(failure.details["run"])
    if reason is None:
        return None
    message = paragraph(undeclared(failure), reason)
    (start, end), suggestion = failure.span, None
    power = _POWER.match(failure.source, end) if failure.details["run"] == "e" else None
    if power is not None:
        exponent = power[power.lastindex or 0]
        suggestion = failure.replaced(f"exp({exponent})", (start, power.end()))
    return error(failure, "unknown_symbol", message, suggestion)


# --- Functions that no answer needs (log, sinh, max), and other names of known functions (cosine)


_RENAMED = {
    "tan2": "atan2", "arctg2": "atan2", "artan2": "atan2", "atang2": "atan2", "atan22": "atan2",
    "square_root": "sqrt", "squareroot": "sqrt", "root": "sqrt", "wurzel": "sqrt",
    "absolute": "abs", "betrag": "abs", "cosine": "cos", "sine": "sin", "tangent": "tan",
    "sinus": "sin", "cosinus": "cos", "kosinus": "cos", "coseno": "cos", "seno": "sin",
    "tangens": "tan", "tangente": "tan", "tang": "tan", "ArcCosine": "acos", "ArcSine": "asin",
    "c": "cos", "s": "sin", "t": "tan", "C": "cos", "S": "sin",
}  # fmt: skip
_SHORT = frozenset("csCS")
# Numbers in brackets: MATLAB's c(1, 2) is an element of an array, and SymPy's S(1) is a number.
_OF_NUMBERS = regex(r"\(\s*[0-9]+(?:\s*[,;]\s*[0-9]+)*\s*\)")


def _after_factor(failure: Failure) -> str | None:
    factor, letter = failure.details["run"][:-1], failure.details["run"][-1:]
    if letter not in _SHORT or not factor or _OF_NUMBERS.match(failure.source, failure.span[1]):
        return None
    return None if split(factor, failure.vocabulary) is None else f"{factor} {_RENAMED[letter]}"


@for_causes("name")
def repair_unknown_function(failure: Failure) -> Repair:
    """List the functions that can be used; for cosine, suggest the known name cos."""
    name = failure.details["run"].replace("_", "")
    if name in REFUSED:
        written = quoted(failure.written)
        message = say(
            "{written} is not needed here. The functions are {functions}.",
            written=written,
            functions=listed(list(ARITY)),
        )
        return error(failure, "unknown_function", message)
    run = failure.details["run"]
    if len(run) == 1 and _OF_NUMBERS.match(failure.source, failure.span[1]):
        if not failure.vocabulary.joints:
            return None
        advice = say("Write the shorthand without brackets, as in c12.")
        return error(failure, "unknown_function", paragraph(undeclared(failure), advice))
    renamed = _RENAMED.get(run) or _after_factor(failure)
    if renamed is None or not failure.details["called"]:
        return None
    message = say(
        "{written} is no function here. Did you mean {function}?",
        written=quoted(failure.written),
        function=renamed,
    )
    return error(failure, "unknown_function", message, failure.replaced(renamed))


# --- A name that is not declared


_INDEXED = regex(r"([^0-9]+)[0-9]+")
_STEM = regex(r"[^0-9_]+")
# The letters that textbooks use for lengths.
_OF_LENGTHS: Final = frozenset("abdhlrLADHR")
# A short name of a joint angle. It is not read as one: t may also be a time or a translation.
_SHORT_ANGLE: Final = regex(r"t([0-9]{1,2})")
_OF_JOINTS: Final = frozenset({"q", "theta", "θ"})
_LISTED: Final = 8


@for_causes("name")
def repair_unknown_symbol(failure: Failure) -> Repair:
    """Suggest the most similar declared name, or list the names that may be meant."""
    run, vocabulary = failure.details["run"], failure.vocabulary
    message = undeclared(failure)
    if (product := _product(run, vocabulary)) is not None:
        message = paragraph(message, say("For a product, write {product}.", product=product))
        return error(failure, "unknown_symbol", message)
    known = nearest(run, vocabulary, failure.details["called"]) or _angle(run, vocabulary)
    if known is not None:
        message = paragraph(message, say("Did you mean {name}?", name=known))
        return error(failure, "unknown_symbol", message, failure.replaced(known))
    message = paragraph(message, _names(normal_form(run), vocabulary))
    return error(failure, "unknown_symbol", message)


def _angle(run: str, vocabulary: Vocabulary) -> str | None:
    match = _SHORT_ANGLE.fullmatch(normal_form(run))
    angle = vocabulary.turning.get(int(match[1])) if match else None
    return angle.name if angle else None


def _product(run: str, vocabulary: Vocabulary) -> str | None:
    plain = run.replace("_", "")
    pieces = split(plain, vocabulary) if plain != run else None
    return None if pieces is None else "*".join(_written(piece, plain) for piece in pieces)


def _written(piece: Piece, run: str) -> str:
    return piece.symbols[0].name if piece.kind == "symbol" else run[piece.start : piece.end]


def _names(name: str, vocabulary: Vocabulary) -> str:
    siblings = _siblings(name, vocabulary)
    if name in _OF_JOINTS:
        siblings = [symbol for symbol in vocabulary.symbols if symbol.joint is not None]
    if siblings:
        return _all_names(siblings, vocabulary)
    kind = _kind(name)
    named = [symbol for symbol in vocabulary.symbols if symbol.kind == kind]
    constants = [symbol for symbol in named if symbol.joint is None]
    if kind is not None and (constants or not (named or vocabulary.of_books)):
        return _names_of_kind(kind, named, vocabulary)
    return _all_names(list(vocabulary.symbols), vocabulary) if vocabulary.symbols else ""


def _all_names(symbols: list[Symbol], vocabulary: Vocabulary) -> str:
    names = _joined(symbols)
    if vocabulary.of_books:
        # Translators: names of variables, after "There is no `x` here."
        return say("There are {names}.", names=names)
    # Translators: names of variables, after "This exercise has no `x`."
    return say("It has {names}.", names=names)


def _names_of_kind(kind: Kind, named: list[Symbol], vocabulary: Vocabulary) -> str:
    # Name the constants first, then the joint variables.
    names = _joined(sorted(named, key=lambda symbol: symbol.joint is not None))
    if vocabulary.of_books:
        if kind == "length":
            return say("The lengths are {names}.", names=names)
        return say("The angles are {names}.", names=names)
    # Translators: "its" and "it" are the exercise, as in "This exercise has no `x`."
    if kind == "length":
        return say("Its lengths are {names}.", names=names) if names else say("It has no lengths.")
    return say("Its angles are {names}.", names=names) if names else say("It has no angles.")


def _siblings(name: str, vocabulary: Vocabulary) -> list[Symbol]:
    match = _INDEXED.fullmatch(name)
    if match is None:
        return []
    stem = characters.NAMES.get(match[1], match[1])
    sibling = re.compile(rf"{re.escape(stem)}_?[0-9]+", re.IGNORECASE)
    return [symbol for symbol in vocabulary.symbols if sibling.fullmatch(symbol.name)]


def _kind(name: str) -> Kind | None:
    match = _STEM.match(name)
    if match is None:
        return None
    if match[0] in _OF_LENGTHS:
        return "length"
    return (
        "angle" if match[0] in characters.NAMES or match[0].lower() in characters.LETTERS else None
    )


def _joined(symbols: list[Symbol]) -> str:
    names = [symbol.name for symbol in symbols[:_LISTED]]
    return ", ".join(names) + (", …" if len(symbols) > _LISTED else "")


# --- Shorthand with a joint that has no angle: c3 if joint 3 slides, s7 if there is no joint 7


@for_causes("invalid_shorthand")
def repair_not_revolute(failure: Failure) -> Repair:
    """Say why the joint has no angle."""
    # There is no suggestion: the exercise may test whether students leave out the joint.
    joint = failure.details["joint"]
    if joint in failure.vocabulary.turning:
        return None
    message = say(
        "{written} is a cosine or sine of joint angles, but there is no joint {joint}.",
        written=quoted(failure.written),
        joint=joint,
    )
    if joint in failure.vocabulary.sliding:
        message = say(
            "{written} is a cosine or sine of joint angles, but joint {joint} slides, so it has no "
            "angle. Only joints that turn add to the angle.",
            written=quoted(failure.written),
            joint=joint,
        )
    return error(failure, "not_revolute", message)


# --- Shorthand that names one joint twice: c11


@for_causes("invalid_shorthand")
def repair_repeated_joint(failure: Failure) -> Repair:
    """Ask the student to write out the sum."""
    if failure.details["joint"] not in failure.vocabulary.turning:
        return None
    message = say(
        "{written} names one joint twice. Write the sum of the angles, as in cos(2*q1).",
        written=quoted(failure.written),
    )
    return error(failure, "repeated_joint", message)


# --- The text sin45, which may be the sine of 45 or of the sum of the joint angles 4 and 5


_GOES_ON = regex(r"\.?\w+")


@for_causes("ambiguous_shorthand")
def repair_ambiguous_shorthand(failure: Failure) -> Repair:
    """Suggest brackets for sin2q1; explain that sin45 is ambiguous."""
    function, names = failure.details["function"], failure.details["names"]
    digits = "".join(letter for letter in failure.written if letter.isdigit())
    start, end = failure.span
    if match := _GOES_ON.match(failure.source, end):
        whole = start, match.end()
        message = say(
            "Write the argument of {function} in brackets, as in {function}(2*x).",
            function=function,
        )
        in_brackets = f"{function}({digits}{match.group()})"
        suggestion = failure.replaced(in_brackets, whole)
        return error(failure, "ambiguous_shorthand", message, suggestion)
    message = say(
        "{written} has two readings. Write {function}({angles}) for the joint angles or "
        "{function}({number}) for the number.",
        written=quoted(failure.written),
        function=function,
        angles=names,
        number=digits,
    )
    # In cos12(q1), the bracket may be a factor or an argument.
    is_followed = failure.source[end : end + 1] in {"(", "[", "{"}
    plain = None if is_followed else failure.replaced(f"{function}({names})")
    return error(failure, "ambiguous_shorthand", message, plain)
