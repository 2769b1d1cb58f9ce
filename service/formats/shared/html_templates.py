"""HTML from Jinja2 templates, which are named by their path below ``service/``.

Only HTML that the service itself made (``own_html``) is not escaped. Each language has its own
Jinja2 environment.
"""

import base64
import hashlib
from collections.abc import Callable, Container, Iterator, Mapping
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

from markupsafe import Markup, escape

from service.formats.shared.plain_text import (
    code_pieces,
    number,
    percent,
    visible,
    whole_percent,
    whole_score,
)
from service.translations import ENGLISH, Language, told
from service.typeset import formulas, names

if TYPE_CHECKING:
    from jinja2 import Environment

_PACKAGE: Final = Path(__file__).parents[2]
_SHARED_STYLE: Final = Path(__file__).with_name("templates") / "report.css"


@dataclass(frozen=True, slots=True)
class StyleSheet:
    """The CSS to print in a page, and its hash for the page's Content-Security-Policy."""

    html: Markup
    hash: str


def html(template: str, /, *, language: Language = ENGLISH, **values: object) -> bytes:
    """Fill in a template in a language; return the document in UTF-8."""
    return environment(language).get_template(template).render(values).encode()


def html_pieces(
    template: str, /, *, language: Language = ENGLISH, **values: object
) -> Iterator[bytes]:
    """Fill in a template in a language, piece by piece. Values may be iterators."""
    for piece in environment(language).get_template(template).generate(values):
        yield piece.encode()


def own_html(text: str) -> Markup:
    """Mark a text as HTML of the service itself, which templates do not escape."""
    return Markup(text)


def style_sheet(file: Path) -> StyleSheet:
    """Return the style sheet of all reports, followed by the style in ``file``."""
    style = _SHARED_STYLE.read_text(encoding="utf-8") + file.read_text(encoding="utf-8")
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    return StyleSheet(own_html(style), f"sha256-{digest}")


def lines(text: str) -> Markup:
    """Return the text as HTML with its line breaks, without invisible characters."""
    return escape("\n".join(map(visible, text.split("\n"))))


def typeset(text: object, symbols: Container[str] = ()) -> Markup:
    """Return the text as HTML, with its symbols as MathML."""
    return own_html(names.typeset(visible(str(text)), symbols))


def in_unicode(text: str, symbols: Container[str] = ()) -> str:
    """Return the text with its symbols in Unicode, for the title of a page."""
    return names.in_unicode(text, symbols)


def formula(text: str) -> Markup:
    """Return a formula as MathML, or as plain text if it is unreadable."""
    return own_html(formulas.formula(visible(text)))


@cache
def environment(language: Language = ENGLISH) -> "Environment":
    """Return the Jinja2 environment of a language, which keeps its compiled templates."""
    # Imported here, so that a program that writes no HTML starts without it.
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    made = Environment(
        loader=FileSystemLoader(_PACKAGE),
        autoescape=True,
        undefined=StrictUndefined,
        finalize=partial(_finalize, language),
        extensions=["jinja2.ext.i18n"],
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        auto_reload=False,
        cache_size=-1,
    )
    functions = (
        code_pieces,
        formula,
        lines,
        number,
        percent,
        whole_percent,
        whole_score,
    )
    made.filters |= {each.__name__: each for each in functions}
    made.filters |= {
        "in_unicode": _telling(in_unicode, language),
        "typeset": _telling(typeset, language),
    }
    # A `{% trans %}` is one line, and its values are named.
    made.policies["ext.i18n.trimmed"] = True
    made.newstyle_gettext = True  # type: ignore[attr-defined]
    made.globals |= {
        "_": partial(_text, language),
        "gettext": partial(_markup, language),
        "ngettext": partial(_counted_markup, language),
        "language": language,
    }
    return made


def _finalize(language: Language, value: object) -> str:
    if isinstance(value, Markup):
        return value
    return visible(_told(value, language))


def _told(value: object, language: Language) -> str:
    return told(value, language.translation) if isinstance(value, str) else str(value)


def _telling(shown: Callable[..., str], language: Language) -> Callable[..., str]:
    def filtered(text: object, symbols: Container[str] = ()) -> str:
        return shown(_told(text, language), symbols)

    return filtered


def _text(language: Language, text: str, /, **values: object) -> Markup:
    return _filled(escape(_translated(language, text)), language, values)


def _markup(language: Language, text: str, /, **values: object) -> Markup:
    return _filled(_translated(language, text), language, values)


def _counted_markup(
    language: Language, one: str, many: str, count: int, /, **values: object
) -> Markup:
    translation = language.translation
    if translation is None:
        chosen = one if count == 1 else many
    else:
        chosen = translation.ngettext(one, many, count)
    return _filled(chosen, language, {"num": count, **values})


def _translated(language: Language, text: str) -> str:
    return language.translation.gettext(text) if language.translation else text


def _filled(text: str, language: Language, values: Mapping[str, object]) -> Markup:
    return own_html(text) % {name: _finalize(language, each) for name, each in values.items()}
