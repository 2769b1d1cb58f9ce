"""HTML from Jinja2 templates that escape every text.

A template is named by its path below ``service/``. Every value that a template prints becomes one
visible line and is escaped, unless it is HTML that the service itself made (``own_html``).
"""

import base64
import hashlib
from collections.abc import Container, Iterator
from dataclasses import dataclass
from functools import cache
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
from service.typeset import formulas, names

if TYPE_CHECKING:
    from jinja2 import Environment

_PACKAGE: Final = Path(__file__).parents[2]
_SHARED_STYLE: Final = Path(__file__).with_name("templates") / "report.css"


@dataclass(frozen=True, slots=True)
class StyleSheet:
    """A style sheet to print in a page, and its hash for the page's Content-Security-Policy."""

    html: Markup
    hash: str


def html(template: str, /, **values: object) -> bytes:
    """Return the document that a template makes, in UTF-8."""
    return environment().get_template(template).render(values).encode()


def html_pieces(template: str, /, **values: object) -> Iterator[bytes]:
    """Yield the document that a template makes, piece by piece. It may iterate lazily."""
    for piece in environment().get_template(template).generate(values):
        yield piece.encode()


def own_html(text: str) -> Markup:
    """Return HTML that templates do not escape. The service itself must have made it.

    There are four such texts: style sheets, statements (``statement_html``), formulas in MathML
    (``formula_html``, ``formula``) and texts with names in MathML (``typeset``).
    """
    return Markup(text)


def style_sheet(file: Path) -> StyleSheet:
    """Return the style of all reports, followed by the style in ``file``."""
    style = _SHARED_STYLE.read_text(encoding="utf-8") + file.read_text(encoding="utf-8")
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    return StyleSheet(own_html(style), f"sha256-{digest}")


def lines(text: str) -> Markup:
    """Return the text as HTML with its line breaks; each line of it is visible."""
    return escape("\n".join(map(visible, text.split("\n"))))


def typeset(text: object, symbols: Container[str] = ()) -> Markup:
    """Return the visible text as HTML with its names in MathML."""
    return own_html(names.typeset(visible(str(text)), symbols))


def in_unicode(text: str, symbols: Container[str] = ()) -> str:
    """Return the text with its names in Unicode, for the title of a page."""
    return names.in_unicode(text, symbols)


def formula(text: str) -> Markup:
    """Return a formula in MathML, or as visible text if it is unreadable."""
    return own_html(formulas.formula(visible(text)))


@cache
def environment() -> "Environment":
    """Return the Jinja2 environment; it compiles each template once in a process."""
    # Imported here, so that a program that writes no HTML starts without it.
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    made = Environment(
        loader=FileSystemLoader(_PACKAGE),
        autoescape=True,
        undefined=StrictUndefined,
        finalize=_finalize,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        auto_reload=False,
        cache_size=-1,
    )
    functions = (
        code_pieces,
        formula,
        in_unicode,
        lines,
        number,
        percent,
        typeset,
        whole_percent,
        whole_score,
    )
    made.filters |= {each.__name__: each for each in functions}
    return made


def _finalize(value: object) -> str:
    """Return a printed value unchanged if it is HTML, otherwise as visible text."""
    return value if isinstance(value, Markup) else visible(str(value))
