r"""A subscript that is a formula: c_{\theta_1+\theta_2}, c_{12-4}, θ₁₊₂."""

import re

from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.regex import regex
from service.translations import say

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
