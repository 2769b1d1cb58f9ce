"""Sentences and their translations.

``sentence`` makes sentences, ``languages`` has the catalogues of translations. Each language has a
folder with the sentences of reports (``sentences.po``), of pages (``pages.po``) and of the command
line (``commands.po``).
"""

# This is the lowest package: it imports no other.

from service.translations.languages import (
    ENGLISH,
    LANGUAGES,
    Language,
    accepted_language,
    language_named,
)
from service.translations.sentence import (
    Sentence,
    SentenceValue,
    bulleted,
    joined,
    listed,
    paragraph,
    say,
    say_count,
    template,
    told,
)

__all__ = [
    "ENGLISH",
    "LANGUAGES",
    "Language",
    "Sentence",
    "SentenceValue",
    "accepted_language",
    "bulleted",
    "joined",
    "language_named",
    "listed",
    "paragraph",
    "say",
    "say_count",
    "template",
    "told",
]
