"""What every repair rule is tested with: texts that it refuses, and near ones that are read."""

import pytest

from service.expressions import ExpressionError, read
from tests.expressions.corpus_files import ROBOT


def refuse(text: str, code: str, part: str, suggestion: str | None) -> None:
    """Check that `text` is refused with `code` at `part`, and that its repair can be read."""
    with pytest.raises(ExpressionError) as caught:
        read(text, ROBOT)
    error = caught.value
    assert (error.code, text[slice(*error.span)]) == (code, part), error.message
    assert error.suggestion == suggestion
    assert error.message[0].isupper() or not error.message[0].isalpha(), error.message
    assert error.message.endswith((".", "?")), error.message
    if suggestion is not None:
        read(suggestion, ROBOT)


def accept(text: str, meaning: str) -> None:
    """Check that `text` is read, as what the normal text `meaning` says."""
    assert read(text, ROBOT).text() == meaning
