"""Split a symbol's name into stem and index: theta1 is θ with index 1."""

from typing import Final

from service.expressions.characters import greek
from service.expressions.vocabulary.symbols import Symbol
from service.regex import regex

_INDEXED: Final = regex(r"([A-Za-z]+?)_?([0-9]+)")
_UNDERSCORED: Final = regex(r"([A-Za-z0-9]+)_([A-Za-z0-9_]+)")


def stem_and_index(name: str) -> tuple[str, str]:
    """Return the stem and the index of ``name``; the index may be empty."""
    match = _INDEXED.fullmatch(name) or _UNDERSCORED.fullmatch(name)
    return (match[1], match[2].replace("_", "")) if match else (name, "")


def symbol_latex(symbol: Symbol) -> str:
    r"""Return the symbol in LaTeX: theta1 -> \theta_{1}."""
    if symbol.latex is not None:
        return symbol.latex
    stem, index = stem_and_index(symbol.name)
    if stem in greek.LETTERS:
        stem = f"\\{stem}"
    elif len(stem) > 1:
        stem = f"\\mathrm{{{stem}}}"
    if not index:
        return stem
    upright = len(index) > 1 and not index.isdigit()
    return f"{stem}_{{\\mathrm{{{index}}}}}" if upright else f"{stem}_{{{index}}}"
