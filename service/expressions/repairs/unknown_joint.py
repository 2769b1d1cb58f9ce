"""A variable that no joint has: q7 with six joints, theta12, theta3 if joint 3 slides."""

from service.expressions.characters import greek
from service.expressions.errors import Span
from service.expressions.parsing.lexing.words import split
from service.expressions.printing.symbol_names import symbol_latex
from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.expressions.vocabulary.symbols import Vocabulary, normal_form
from service.regex import regex
from service.translations import paragraph, say

_JOINT = regex(rf"(?P<stem>[A-Za-z{greek.CLASS}]+?)(?P<index>[0-9]+)(?P<rest>.*)")
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
