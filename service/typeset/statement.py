"""Statements of exercises as HTML, from Markdown with LaTeX between dollar signs.

Authors write text, never HTML: tags and scripts in the text are shown as text. Names in the text
and fenced blocks ``matrix`` are typeset.
"""

# The library that converts formulas to MathML lets tags through (``\text{<b>}``, ``\href``), so
# only the plain MathML of its result is kept.

import re
import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence
from functools import cache, lru_cache
from html import escape
from typing import TYPE_CHECKING, Any, Final

from service.regex import regex
from service.typeset.formulas import matrix
from service.typeset.names import in_one_line, unbound

if TYPE_CHECKING:
    from markdown_it import MarkdownIt
    from markdown_it.rules_core import StateCore
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
# For model solutions, which are not written by strangers.
_LONGEST_SOLVED: Final = 20_000
_LINKS: Final = regex(r"(?:https?://|mailto:|#)", re.IGNORECASE)
# Characters that change the direction of text, so that it could be read as another text.
_TURNING: Final = regex("[\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]")


# The name of what the Markdown library passes to our rules.
_SYMBOLS: Final = "symbols"


@lru_cache(maxsize=256)
def statement_html(statement: str, symbols: frozenset[str] = frozenset()) -> str:
    """Return the statement as HTML that is safe in any page: no scripts, styles or pictures.

    ``symbols`` are the names that the exercise declares.
    """
    # A formula that cannot be converted to MathML is shown as it is written.
    shown = _TURNING.sub(lambda mark: f"[U+{ord(mark[0]):04X}]", statement)
    return in_one_line(_markdown().render(shown, {_SYMBOLS: symbols}))


def formula_html(latex: str, *, display: bool = False) -> str:
    """Return a formula of a model solution as MathML, or else as LaTeX."""
    return _formula(latex, {"display_mode": display, "longest": _LONGEST_SOLVED})


@cache
def _markdown() -> "MarkdownIt":
    # Imported with the first statement, so that startup does not wait for it.
    from markdown_it import MarkdownIt
    from mdit_py_plugins.dollarmath import dollarmath_plugin

    markdown = MarkdownIt("commonmark", {"html": False}).enable("table").disable("image")
    markdown.validateLink = lambda url: _LINKS.match(url) is not None  # type: ignore[method-assign]
    # The page aligns the cells of tables: the HTML must not contain styles.
    markdown.add_render_rule("th_open", lambda *_: "<th>")
    markdown.add_render_rule("td_open", lambda *_: "<td>")
    markdown.use(
        dollarmath_plugin,
        allow_labels=False,
        allow_space=False,
        double_inline=True,
        renderer=_formula,
    )
    # A paragraph must not contain a block.
    markdown.add_render_rule("math_inline_double", _displayed)
    markdown.add_render_rule("text", _text)
    markdown.core.ruler.push("joined_lines", _join_lines)
    markdown.add_render_rule("fence", _fence)
    return markdown


def _displayed(_renderer: object, tokens: "Sequence[Token]", i: int, *_: object) -> str:
    formula = _formula(tokens[i].content.strip(), {"display_mode": True})
    return f'<span class="math display">{formula}</span>'


def _join_lines(state: "StateCore") -> None:
    # Join the lines of a text: a name may depend on the next word, which is in the next line.
    for block in state.tokens:
        if block.type != "inline":
            continue
        joined: list[Token] = []
        for token in block.children or ():
            if token.type == "softbreak":
                token.type, token.content = "text", "\n"
            if joined and token.type == joined[-1].type == "text":
                joined[-1].content += token.content
            else:
                joined.append(token)
        block.children = joined


def _text(_renderer: object, tokens: "Sequence[Token]", i: int, _: object, env: Any) -> str:
    return unbound(tokens[i].content, env[_SYMBOLS])


def _fence(_renderer: object, tokens: "Sequence[Token]", i: int, *_: object) -> str:
    """Return a block of code as HTML; a block ``matrix`` is shown as a matrix."""
    kind, _blank, name = tokens[i].info.strip().partition(" ")
    text = tokens[i].content
    shown = matrix(text, name.strip()) if kind == "matrix" else None
    return shown or f"<pre><code>{escape(text)}</code></pre>\n"


def _formula(latex: str, options: Mapping[str, Any]) -> str:
    """Return a formula as MathML, or else as LaTeX."""
    from latex2mathml.converter import convert

    mode = "block" if options.get("display_mode") else "inline"
    longest = options.get("longest", _LONGEST)
    try:
        root = ET.fromstring(convert(latex, display=mode)) if len(latex) <= longest else None
    except Exception:  # noqa: BLE001 -- the library has no error that all others come from
        root = None
    if root is None or not _plain(root):
        return f"<code>{escape(latex)}</code>"
    for element in root.iter():
        for before, table, after in zip(element, element[1:], element[2:], strict=False):
            if table.tag == "mtable" and before.text == "[" and after.text == "]":
                # The style sheet draws its brackets: few fonts have some that grow.
                table.set("class", "matrix")
    return ET.tostring(root, encoding="unicode")


def _plain(root: ET.Element) -> bool:
    # This also removes the attributes that are not allowed.
    for element in root.iter():
        name = element.tag.removeprefix(f"{{{_MATHML}}}")
        if name not in _ELEMENTS:
            return False
        # Without a namespace, so that it is written without a prefix.
        element.tag = name
        for attribute in set(element.attrib) - _ATTRIBUTES:
            del element.attrib[attribute]
    return True
