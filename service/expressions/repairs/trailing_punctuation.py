"""A full stop or a comma at the end, as behind a formula in a sentence."""

from service.expressions.repairs.failure import Failure, Repair, answers, error


@answers("grammar", "character")
def repair(failure: Failure) -> Repair:
    """Offer the text without it."""
    text = failure.source.rstrip().rstrip("$").rstrip()
    kept = text.rstrip(".,: ")
    if text[-1:] not in {".", ",", ":"} or not kept or failure.span[0] < len(kept):
        return None
    message, span = f"The text ends in {text[-1]}; leave that out.", (len(kept), len(text))
    suggestion = failure.replaced("", span).rstrip()
    return error(failure, "trailing_punctuation", message, suggestion, span)
