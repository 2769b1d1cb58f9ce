"""Check the texts in other languages against the English texts."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Final

from service.catalogue.files.schema import ExerciseSpec, TranslationSpec
from service.catalogue.robots.formulas import FieldError
from service.regex import regex
from service.translations import say

LANGUAGE_CODES: Final = ("de", "es", "fr", "zh")
_FORMULA: Final = regex(r"(?<!\\)(\$\$?)(.+?)(?<!\\)\1", re.DOTALL)


def check_translations(spec: ExerciseSpec) -> None:
    """Raise FieldError for a faulty translation, for example of an unknown part."""
    for code, texts in spec.translations.items():
        field = f"translations.{code}"
        if code not in LANGUAGE_CODES:
            known = ", ".join(LANGUAGE_CODES)
            raise FieldError(
                field, say("there is no such language; write one of {known}", known=known)
            )
        _require_known(f"{field}.parts", texts.parts, [part.id for part in spec.parts])
        joints = spec.robot.joints if spec.robot else []
        _require_known(f"{field}.symbols", texts.symbols, [*joints, *spec.symbols])
        for name, original, text in _pairs(spec, texts):
            if text is not None:
                _require_same_formulas(f"{field}.{name}", original, text)


def _require_known(field: str, named: Iterable[str], known: Iterable[str]) -> None:
    names = list(known)
    for name in named:
        if name not in names:
            reason = say("there is no such name; write one of {names}", names=", ".join(names))
            raise FieldError(f"{field}.{name}", reason)


def _pairs(spec: ExerciseSpec, texts: TranslationSpec) -> Iterator[tuple[str, str, str | None]]:
    for name in ("title", "summary", "statement"):
        yield name, getattr(spec, name), getattr(texts, name)
    for part in spec.parts:
        if translated := texts.parts.get(part.id):
            yield f"parts.{part.id}.title", part.title, translated.title
            yield f"parts.{part.id}.prompt", part.prompt, translated.prompt
    for name, text in texts.symbols.items():
        if symbol := spec.symbols.get(name):
            yield f"symbols.{name}", symbol.description, text


def _require_same_formulas(field: str, original: str, text: str) -> None:
    wanted, found = _formulas(original), _formulas(text)
    if missing := list((wanted - found).elements()):
        raise FieldError(
            field,
            say("lacks the formula ${formula}$ of the English text; write it", formula=missing[0]),
        )
    if further := list((found - wanted).elements()):
        reason = say(
            "has a formula ${formula}$ that the English text lacks; leave it out",
            formula=further[0],
        )
        raise FieldError(field, reason)


def _formulas(text: str) -> Counter[str]:
    return Counter(found[2].strip() for found in _FORMULA.finditer(text))
