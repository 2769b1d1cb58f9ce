"""A pseudo-language: English with accents, and a third longer."""

# A text that the service shows without accents is not translatable. `python -m
# tests.translations.pseudo serve` starts the service with the pseudo-language.

import re
from gettext import NullTranslations
from typing import Final

import pytest
from dh_grader.translations import ENGLISH, LANGUAGES, Language

_ACCENTED: Final = str.maketrans(
    "aceinosuyzACEINOSUYZ", "áćéíñóśúýźÁĆÉÍÑÓŚÚÝŹ"
)  # Latin letters that all fonts have
# Places of values, tags, entities, code and escapes stay as they are.
_KEPT: Final = re.compile(r"(%\(\w+\)\w|\{\{|\}\}|\{\w*\}|<[^>]+>|&\w+;|`[^`]*`|\\?\[[^\]]*\])")
_MORE: Final = " ťéxť"


class PseudoTranslation(NullTranslations):
    """Translates each sentence by adding accents."""

    def gettext(self, message: str) -> str:
        pieces = _KEPT.split(message)
        told = "".join(
            each if i % 2 else each.translate(_ACCENTED) for i, each in enumerate(pieces)
        )
        letters = sum(map(len, pieces[::2]))
        return told + _MORE * max(1, round(letters / 3 / len(_MORE)))

    def ngettext(self, one: str, many: str, count: int) -> str:
        return self.gettext(one if count == 1 else many)


PSEUDO: Final = Language("qps", "Þśéúđó", "qps-Ploc")
vars(PSEUDO).update(
    translation=PseudoTranslation(),
    translation_of_scripts=PseudoTranslation(),
    translation_of_commands=PseudoTranslation(),
)


def offer_pseudo() -> None:
    """Offer the pseudo-language in this process."""
    LANGUAGES[PSEUDO.code] = PSEUDO  # type: ignore[index]


def without_others(monkeypatch: pytest.MonkeyPatch) -> None:
    # The last first: at the end of the test, they come back in their own order.
    for code in [code for code in reversed(list(LANGUAGES)) if code != ENGLISH.code]:
        monkeypatch.delitem(LANGUAGES, code)


if __name__ == "__main__":
    from dh_grader.cli import main

    offer_pseudo()
    main()
