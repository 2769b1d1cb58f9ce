"""A joint variable of a joint that is not there: q7 on six joints, theta12, theta3 if 3 slides."""

import re

from service.expressions import greek
from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, shown
from service.expressions.vocabulary import Vocabulary, normal_form

_JOINT = re.compile(rf"(?P<stem>[A-Za-z{greek.CLASS}]+)(?P<index>[0-9]+)")
_STEMS = frozenset({"q", "theta", "θ", "th"})


def repair(failure: Failure) -> ExpressionError | None:
    """Say which joints there are; offer the sum of angles for theta12."""
    vocabulary = failure.vocabulary
    if failure.stop.cause != "name":
        return None
    match = _JOINT.fullmatch(normal_form(failure.details["run"]))
    if match is None or match["stem"] not in _STEMS or not _joints(vocabulary):
        return None
    index = match["index"]
    suggestion = None
    message = f"{shown(failure.written)}: {_reason(int(index[:4]), vocabulary)}."
    own = vocabulary.turning.get(int(index[:4]))
    if own is not None:
        suggestion = failure.replaced(own.name)
    parts = [vocabulary.turning.get(int(digit)) for digit in index]
    if 1 < len(index) < 7 and None not in parts and len(set(index)) == len(index):
        total = " + ".join(part.name for part in parts if part is not None)
        message += f" For the sum of angles write {total}."
        start, end = failure.span
        alone = failure.source[start - 1 : start] == "(" and failure.source[end : end + 1] == ")"
        suggestion = failure.replaced(total if alone else f"({total})")
    return ExpressionError("unknown_joint", message, failure.span, suggestion)


def _joints(vocabulary: Vocabulary) -> list[int]:
    return sorted(vocabulary.turning.keys() | vocabulary.sliding.keys())


def _reason(joint: int, vocabulary: Vocabulary) -> str:
    if joint in vocabulary.sliding:
        return f"joint {joint} slides, and its variable is {vocabulary.sliding[joint].name}"
    if joint in vocabulary.turning:
        return f"joint {joint}'s variable is {vocabulary.turning[joint].name} here"
    known = _joints(vocabulary)
    return f"there is no joint {joint}; this robot's joints are {known[0]} to {known[-1]}"
