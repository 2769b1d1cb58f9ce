"""Names, formulas, matrices and statements of exercises as HTML with MathML."""

import re
import xml.etree.ElementTree as ET
from collections.abc import Container, Iterator, Mapping, Sequence
from functools import cache, lru_cache
from html import escape
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from dh_grader.expressions import Expression, ExpressionError, Symbol, Vocabulary, characters, read
from dh_grader.expressions.printing import row, scripted, to_text
from dh_grader.expressions.vocabulary import RESERVED, Binary, Node
from dh_grader.pasting import GridError, read_grid
from dh_grader.regex import regex

if TYPE_CHECKING:
    from markdown_it import MarkdownIt
    from markdown_it.rules_core import StateCore
    from markdown_it.token import Token


# --- Typeset the names in a text: theta1 becomes θ with the index 1
#
# `static/typeset/names.js` applies the same rules in a browser; the cases of
# `tests/typeset/names.json` hold for both. These are names:
#
# - the symbols that an exercise declares; ``a``, ``A`` and ``I`` are words in a longer text,
# - Greek letters, also their names in lower case: alpha, phi_2,
# - a letter with an index or a superscript: x0, z_i, L1, R_2^0, R^T,
# - a word with an index of one letter or of digits: Rot_z,
# - frames in braces: {0}, {i-1}, {e},
# - ``x``, ``y`` and ``z`` before "axis" or "axes".
#
# Text in a web address, after a backslash or in a longer word is never a name.


# These are also English words, or kinds of robots.
_WORDS: Final = {"a", "A", "I", "delta", "iota"}
_SPELLED: Final = [name for name in characters.LETTERS if name.islower() and name not in _WORDS]
_INDEX: Final = rf"[0-9A-Za-z{characters.CLASS}]+|\{{[^{{}}\s]{{1,8}}\}}"
_NAME: Final = regex(
    r"(?<!\w)\w{1,20}://\S+"
    r"|(?<![\w\\@#$'’}])(?:"
    r"(?P<frame>\{[0-9A-Za-z](?:[-−+]?[0-9])?\})"
    rf"|(?P<stem>[A-Za-z{characters.CLASS}]+)(?P<digits>[0-9₀-₉]*)"
    rf"(?:_(?P<below>{_INDEX}))?(?:\^(?P<above>{_INDEX}|\*))?"
    # In l’axe, the l is no symbol.
    r")(?![^\W²³]|[{@]|['’][^\W\d_]{2})"
)
# A hyphen that is a sign: before a number or a name, and after nothing that it could join.
_SIGN: Final = regex(
    rf"(?<![^\s(\[,;=])-(?=[0-9({characters.CLASS}]|[A-Za-z][0-9_]|(?:{'|'.join(_SPELLED)})(?![A-Za-z]))"
)
# An axis by its letter, in each language: the x axis, die x-Achse, x 轴, l’axe x, el eje x.
_AXIS: Final = regex(
    r"[xyz](?=[\s-]+(?:ax[ei]s|Achsen?)(?![A-Za-z])|\s?轴)"
    r"|(?:(?<=\baxe |\beje )|(?<=\baxes |\bejes )|(?<=\bAchse ))[xyz](?![\w'’])"
)
# A formula, an argument in brackets, and the signs that must stay in one line with them.
_FORMULA: Final = r'(?:<span class="math inline">)?<math[^>]*>(?:(?!</math>).)*</math>(?:</span>)?'
_RUN: Final = regex(
    rf"(?<![(\[−])[(\[−]{{1,20}}{_FORMULA}(?:\({_FORMULA})?[),.;:!?\]²³]*|{_FORMULA}(?:\({_FORMULA}[),.;:!?\]²³]*|[),.;:!?\]²³]+)"
)
_LOWERED: Final = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
_PLAIN: Final = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")


class TypesetName(NamedTuple):
    """A name in a text: a letter, a word or a frame, with an index and a superscript."""

    stem: str
    below: str = ""
    above: str = ""

    @property
    def mathml(self) -> str:
        """Return the name as a MathML element."""
        if not self.stem.startswith("{"):
            return scripted(self.stem, self.below, self.above)
        brace = '<mo stretchy="false">{}</mo>'.format
        return f"<mrow>{brace('{')}{scripted(self.stem[1:-1], '', '')}{brace('}')}</mrow>"

    @property
    def unicode(self) -> str:
        """Return the name in Unicode: θ₁."""
        index = self.below.translate(_LOWERED) if self.below.isdigit() else f"_{self.below}"
        above = f"^{self.above}" if self.above else ""
        return f"{characters.LETTERS.get(self.stem, self.stem)}{index if self.below else ''}{above}"


def typeset(text: str, symbols: Container[str] = ()) -> str:
    """Return a text as HTML with its names in MathML; everything else is escaped.

    ``symbols`` are the names that the exercise declares.
    """
    return in_one_line("".join(_html(text, symbols)))


def unbound(text: str, symbols: Container[str]) -> str:
    """Return a part of a line as HTML with its names in MathML."""
    # Pass the result to ``in_one_line``.
    return "".join(_html(text, symbols))


def in_one_line(html: str) -> str:
    """Return HTML in which no line break separates a formula from brackets or signs next to it."""
    return _RUN.sub(lambda run: f'<span class="maths">{run[0]}</span>', html)


def _html(text: str, symbols: Container[str]) -> Iterator[str]:
    for piece in pieces(text, symbols):
        yield escape(piece) if isinstance(piece, str) else f"<math>{piece.mathml}</math>"


def in_unicode(text: str, symbols: Container[str] = ()) -> str:
    """Return a text with its names in Unicode (θ₁), for places without HTML."""
    found = pieces(text, symbols)
    return "".join(piece if isinstance(piece, str) else piece.unicode for piece in found)


def pieces(text: str, symbols: Container[str] = ()) -> Iterator[str | TypesetName]:
    """Yield the names in a text and the texts between the names, in order."""
    text = _SIGN.sub("−", text)
    done = 0
    for match in _NAME.finditer(text):
        if (name := _name(match, symbols)) is not None:
            if match.start() > done:
                yield text[done : match.start()]
            yield name
            done = match.end()
    if done < len(text):
        yield text[done:]


def _name(match: re.Match[str], symbols: Container[str]) -> TypesetName | None:
    """Return the match as a name, or None if the match is an ordinary word."""
    if match["frame"]:
        return TypesetName(match["frame"].replace("-", "−"))
    stem, below, above = match["stem"], match["below"] or "", match["above"] or ""
    if stem is None:
        return None
    digits = match["digits"].translate(_PLAIN)
    below, above = (each.strip("{}").replace("-", "−") for each in (below, above))
    name = TypesetName(stem, digits + below, above)
    if len(stem) == 1 and (name.below or above or stem in characters.NAMES):
        return name
    if _AXIS.match(match.string, match.start()) and not name.below:
        return name
    if stem in _SPELLED or (stem in characters.LETTERS and name.below):
        return name
    if len(below) == 1 or below.isdigit():
        return name
    written = match[0].partition("^")[0]
    is_word = written in _WORDS and written != match.string
    return name if written in symbols and not is_word else None


# --- Formulas and matrices in MathML, made from plain text


# In characters of plain text; with more, a formula is too wide for a phone.
_LONGEST_TERM: Final = 36
# A matrix with more entries is shown as text.
_MOST_ENTRIES: Final = 64
# The e of 1e-3 is no name.
_NAME_IN_FORMULA: Final = regex(
    r"(?:(?<![0-9.])|(?![eE][-+]?[0-9]))[A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9]+)*"
)


def formula(text: str) -> str:
    """Return a formula as HTML with MathML, or as text if it is unreadable."""
    # Every word may be a name. Browsers do not break a formula into lines. So each term of a sum
    # becomes a separate formula, and a long term becomes text.
    try:
        tree = _read(text).tree
    except (ExpressionError, ValueError):
        return escape(text)
    return " ".join(reversed(list(_terms(tree))))


def _terms(tree: Node) -> Iterator[str]:
    """Yield the terms of a sum with their signs, the last term first."""
    while isinstance(tree, Binary) and tree.operator in "+-":
        sign = "−" if tree.operator == "-" else "+"
        last = tree.right
        if to_text(last)[0] == "-" or (isinstance(last, Binary) and last.operator in "+-"):
            # It needs brackets, which the printer sets.
            break
        yield _term(last, sign)
        tree = tree.left
    yield _term(tree)


def _term(tree: Node, sign: str = "") -> str:
    text = to_text(tree)
    if len(text) > _LONGEST_TERM:
        return f"{sign} {typeset(text.replace('*', ' ⋅ '), _names(text))}".lstrip()
    before = f'<mo form="infix">{sign}</mo>' if sign else ""
    return f"<math>{before}{row(tree)}</math>"


def matrix(text: str, name: str = "") -> str | None:
    """Return a matrix in brackets as HTML with MathML, or None if the text is not a matrix.

    Each line of the text is a row, with commas between the entries. ``name`` is shown before the
    matrix.
    """
    # Other forms of a pasted matrix are read, too.
    try:
        rows = [[row(_read(cell.text).tree) for cell in line] for line in read_grid(text).rows]
    except (ExpressionError, GridError, ValueError):
        return None
    if sum(map(len, rows)) > _MOST_ENTRIES or len(set(map(len, rows))) != 1:
        return None
    lines = "".join(f"<mtr>{''.join(map('<mtd>{}</mtd>'.format, each))}</mtr>" for each in rows)
    before = f"{typeset(name, {name})} = " if name else ""
    brackets = f'<mrow><mo>[</mo><mtable class="matrix">{lines}</mtable><mo>]</mo></mrow>'
    return f'<div class="display">{before}<math>{brackets}</math></div>\n'


def _read(text: str) -> Expression:
    # Read a formula in which every word that is no function, unit or constant is a name.
    # Raises ExpressionError, or ValueError if two names differ only in their underscores.
    symbols = [Symbol(name, "number") for name in sorted(_names(text))]
    return read(text, Vocabulary(symbols), repairs=False)


def _names(text: str) -> set[str]:
    return set(_NAME_IN_FORMULA.findall(text)) - RESERVED


# --- Statements of exercises as HTML, from Markdown with LaTeX between dollar signs
#
# Authors write text, never HTML: tags and scripts in the text are shown as text. Names in the text
# and fenced blocks ``matrix`` are typeset.
#
# The library that converts formulas to MathML lets tags through (``\text{<b>}``, ``\href``), so
# only the plain MathML of its result is kept.


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
