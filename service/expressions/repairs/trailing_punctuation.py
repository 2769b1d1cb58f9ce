"""A full stop or a comma at the end, as after a formula in a sentence."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.translations import say


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
