"""A full stop or a comma at the end, as behind a formula in a sentence."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure


def repair(failure: Failure) -> ExpressionError | None:
    """Offer the text without it."""
    text = failure.source.rstrip().rstrip("$").rstrip()
    if failure.cause not in {"grammar", "character"} or text[-1:] not in {".", ",", ":"}:
        return None
    kept = text.rstrip(".,: ")
    if not kept or failure.span[0] < len(kept):
        return None
    return ExpressionError(
        "trailing_punctuation",
        f"The text ends in {text[-1]}; leave that out.",
        (len(kept), len(text)),
        failure.replaced("", (len(kept), len(text))).rstrip(),
    )
