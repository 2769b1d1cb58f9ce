"""A wrong number of arguments: atan2 of one value, atan(y, x), or cos(0,5) with a decimal comma."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.translations import paragraph, say


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
