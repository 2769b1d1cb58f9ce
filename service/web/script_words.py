"""Translate the sentences in the pages' scripts: one dictionary for each language."""

# English needs none.

import json
from collections.abc import Iterable
from typing import Any, Final, NamedTuple

from service.regex import regex
from service.translations import Language

# A sentence in a script: the first argument of `worded`, or the first two of `wordedFor`.
_TEXT: Final = r"\s*(\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*')"
_WORDED: Final = regex(rf"\bworded\({_TEXT}")
_COUNTED: Final = regex(rf"\bwordedFor\({_TEXT},{_TEXT}")
# The place in words.js for the names of the dictionaries.
_PLACE: Final = "const FILES = {};"


class ScriptSentences(NamedTuple):
    """The English sentences of scripts; ``counted`` has pairs of a singular and a plural."""

    plain: tuple[str, ...]
    counted: tuple[tuple[str, str], ...]


def sentences_in(scripts: Iterable[str]) -> ScriptSentences:
    """Return the English sentences in all scripts."""
    # A vendored library is larger than all own scripts and has none.
    own = [script for script in scripts if "worded" in script]
    plain = (_unquoted(match[1]) for script in own for match in _WORDED.finditer(script))
    counted = (
        (_unquoted(match[1]), _unquoted(match[2]))
        for script in own
        for match in _COUNTED.finditer(script)
    )
    return ScriptSentences(tuple(plain), tuple(counted))


def dictionary(language: Language, sentences: ScriptSentences) -> str:
    """Return the JavaScript file with a language's translations of the sentences in scripts."""
    words: dict[str, str] = {}
    counts: dict[str, tuple[str, str]] = {}
    translation = language.translation_of_scripts
    if translation is not None:
        for text in sentences.plain:
            if (told := translation.gettext(text)) != text:
                words[text] = told
        for one, many in sentences.counted:
            forms = (translation.ngettext(one, many, 1), translation.ngettext(one, many, 2))
            if forms != (one, many):
                counts[one] = forms
    found: dict[str, Any] = {"tag": language.tag, "words": words, "counts": counts}
    return f"export default {json.dumps(found, ensure_ascii=False, sort_keys=True)};\n"


def with_dictionaries(script: str, names: dict[str, str]) -> str:
    """Return the script words.js with the addresses of the dictionaries inserted."""
    # ``script`` is the text of words.js, and ``names`` has the addresses by language.
    return script.replace(_PLACE, f"const FILES = {json.dumps(names)};")


def _unquoted(text: str) -> str:
    """Return the text of a string literal in JavaScript."""
    if text[0] == "'":
        text = '"' + text[1:-1].replace("\\'", "'").replace('"', '\\"') + '"'
    return str(json.loads(text))
