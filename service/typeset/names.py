r"""Typeset the names in a text: theta1 becomes θ with the index 1.

`static/typeset/names.js` applies the same rules in a browser; the cases of
`tests/typeset/names.json` hold for both. These are names:

- the symbols that an exercise declares; ``a``, ``A`` and ``I`` in a longer text are English words,
- Greek letters, also their names in lower case: alpha, phi_2,
- a letter with an index or a superscript: x0, z_i, L1, R_2^0, R^T,
- a word with an index of one letter or of digits: Rot_z,
- frames in braces: {0}, {i-1}, {e},
- ``x``, ``y`` and ``z`` before "axis" or "axes".

Text in a web address, after a backslash or in a longer word is never a name.
"""

import re
from collections.abc import Container, Iterator
from html import escape
from typing import Final, NamedTuple

from service.expressions.characters import greek
from service.expressions.printing.mathml import scripted
from service.regex import regex

# These are also English words, or kinds of robots.
_WORDS: Final = {"a", "A", "I", "delta", "iota"}
_SPELLED: Final = [name for name in greek.LETTERS if name.islower() and name not in _WORDS]
_INDEX: Final = rf"[0-9A-Za-z{greek.CLASS}]+|\{{[^{{}}\s]{{1,8}}\}}"
_NAME: Final = regex(
    r"(?<!\w)\w{1,20}://\S+"
    r"|(?<![\w\\@#$'’}])(?:"
    r"(?P<frame>\{[0-9A-Za-z](?:[-−+]?[0-9])?\})"
    rf"|(?P<stem>[A-Za-z{greek.CLASS}]+)(?P<digits>[0-9₀-₉]*)"
    rf"(?:_(?P<below>{_INDEX}))?(?:\^(?P<above>{_INDEX}|\*))?"
    # In l’axe, the l is no symbol.
    r")(?![^\W²³]|[{@]|['’][^\W\d_]{2})"
)
# A hyphen that is a sign: before a number or a name, and after nothing that it could join.
_SIGN: Final = regex(
    rf"(?<![^\s(\[,;=])-(?=[0-9({greek.CLASS}]|[A-Za-z][0-9_]|(?:{'|'.join(_SPELLED)})(?![A-Za-z]))"
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
        return f"{greek.LETTERS.get(self.stem, self.stem)}{index if self.below else ''}{above}"


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
    if len(stem) == 1 and (name.below or above or stem in greek.NAMES):
        return name
    if _AXIS.match(match.string, match.start()) and not name.below:
        return name
    if stem in _SPELLED or (stem in greek.LETTERS and name.below):
        return name
    if len(below) == 1 or below.isdigit():
        return name
    written = match[0].partition("^")[0]
    is_word = written in _WORDS and written != match.string
    return name if written in symbols and not is_word else None
