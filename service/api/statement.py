r"""Statements as HTML: Markdown, with LaTeX between dollars as MathML.

Whoever writes an exercise file writes text, never HTML: tags and scripts in it are shown as they
stand. Formulas are turned to MathML by a library that lets tags through (``\text{<b>}``,
``\href``), so its result is taken apart, and of it only plain MathML is kept.
"""

import re
import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence
from functools import cache, lru_cache
from html import escape
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from markdown_it import MarkdownIt
    from markdown_it.token import Token

_MATHML: Final = "http://www.w3.org/1998/Math/MathML"
_ELEMENTS: Final = frozenset({
    "math", "mrow", "mi", "mn", "mo", "ms", "mtext", "mspace", "mfrac", "msqrt", "mroot", "msub",
    "msup", "msubsup", "munder", "mover", "munderover", "mmultiscripts", "mprescripts", "none",
    "mtable", "mtr", "mtd", "mstyle", "mpadded", "mphantom",
})  # fmt: skip
_ATTRIBUTES: Final = frozenset({
    "display", "displaystyle", "scriptlevel", "mathvariant", "stretchy", "fence", "separator",
    "form", "accent", "accentunder", "lspace", "rspace", "minsize", "maxsize", "movablelimits",
    "largeop", "symmetric", "linethickness", "width", "height", "depth", "voffset", "columnalign",
    "rowspacing", "columnspacing",
})  # fmt: skip
_LONGEST: Final = 2_000
# Of a model solution, which no stranger writes.
_LONGEST_SOLVED: Final = 20_000
_LINKS: Final = re.compile(r"(?:https?://|mailto:|#)", re.IGNORECASE)
# Marks that turn the direction of what follows, so that a text reads as another one.
_TURNING: Final = re.compile("[\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]")


@lru_cache(maxsize=256)
def statement_html(statement: str) -> str:
    """The statement as HTML that may stand in any page: no scripts, no styles, no pictures.

    A formula that cannot be turned to MathML is shown as it is written.
    """
    shown = _TURNING.sub(lambda mark: f"[U+{ord(mark[0]):04X}]", statement)
    html: str = _markdown().render(shown)
    return html


def formula_html(latex: str, *, display: bool = False) -> str:
    """A formula of a model solution as MathML, or as it is written."""
    return _formula(latex, {"display_mode": display, "longest": _LONGEST_SOLVED})


@cache
def _markdown() -> "MarkdownIt":
    # Loaded with the first statement, not with the program.
    from markdown_it import MarkdownIt
    from mdit_py_plugins.dollarmath import dollarmath_plugin

    markdown = MarkdownIt("commonmark", {"html": False}).enable("table").disable("image")
    markdown.validateLink = lambda url: _LINKS.match(url) is not None  # type: ignore[method-assign]
    # The page that shows a table aligns it: no style stands in the HTML.
    markdown.add_render_rule("th_open", lambda *_: "<th>")
    markdown.add_render_rule("td_open", lambda *_: "<td>")
    markdown.use(
        dollarmath_plugin,
        allow_labels=False,
        allow_space=False,
        double_inline=True,
        renderer=_formula,
    )
    # In the midst of a paragraph no block may stand.
    markdown.add_render_rule("math_inline_double", _displayed)
    return markdown


def _displayed(_renderer: object, tokens: "Sequence[Token]", i: int, *_: object) -> str:
    formula = _formula(tokens[i].content.strip(), {"display_mode": True})
    return f'<span class="math display">{formula}</span>'


def _formula(latex: str, options: Mapping[str, Any]) -> str:
    """A formula as MathML, or as it is written."""
    from latex2mathml.converter import convert

    mode = "block" if options.get("display_mode") else "inline"
    longest = options.get("longest", _LONGEST)
    try:
        root = ET.fromstring(convert(latex, display=mode)) if len(latex) <= longest else None
    except Exception:  # noqa: BLE001 -- the library has no error that all others come from
        root = None
    if root is None or not _plain(root):
        return f"<code>{escape(latex)}</code>"
    return ET.tostring(root, encoding="unicode")


def _plain(root: ET.Element) -> bool:
    """Whether all elements are plain MathML; attributes that are not are taken away."""
    for element in root.iter():
        name = element.tag.removeprefix(f"{{{_MATHML}}}")
        if name not in _ELEMENTS:
            return False
        # In no namespace, so that it is written without a prefix.
        element.tag = name
        for attribute in set(element.attrib) - _ATTRIBUTES:
            del element.attrib[attribute]
    return True
