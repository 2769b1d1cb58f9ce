"""Write a formula of Word's equation editor in one line."""

from collections.abc import Callable, Mapping
from typing import Final
from xml.etree import ElementTree as ET


def local_name(element: ET.Element) -> str:
    """Return the name of an element without its namespace."""
    return element.tag.rpartition("}")[2]


def written_formula(element: ET.Element) -> str:
    """Return a formula of Word's equation editor as one would type it."""
    name = local_name(element)
    if name == "t":
        return element.text or ""
    if name.endswith("Pr"):
        return ""
    written = _FORMULAS.get(name)
    if written is None:
        return "".join(map(written_formula, element))
    return written(_Parts(element))


class _Parts:
    """The written parts of a formula: numerator, index and so on, by Word's names."""

    def __init__(self, element: ET.Element) -> None:
        self.all: Final = [(local_name(each), each) for each in element]

    def __getitem__(self, name: str) -> str:
        return "".join(written_formula(each) for own, each in self.all if own == name)


def _power(parts: _Parts) -> str:
    return f"{parts['e']}°" if parts["sup"] in ("∘", "°") else f"{parts['e']}^({parts['sup']})"


def _root(parts: _Parts) -> str:
    degree = parts["deg"].strip()
    return f"sqrt({parts['e']})" if degree in ("", "2") else f"({parts['e']})^(1/({degree}))"


def _bracketed(parts: _Parts) -> str:
    inner = ", ".join(written_formula(each) for name, each in parts.all if name == "e")
    # A matrix has brackets of its own.
    return inner if inner.startswith("[[") else f"({inner})"


def _matrix(parts: _Parts) -> str:
    rows = (
        ", ".join(written_formula(each) for each in row if local_name(each) == "e")
        for name, row in parts.all
        if name == "mr"
    )
    return f"[{', '.join(f'[{row}]' for row in rows)}]"


def _index(text: str) -> str:
    return text if text.isalnum() else f"{{{text}}}"


# Other structures, such as sums, are no answers; their text must not be taken for one.
_FORMULAS: Final[Mapping[str, Callable[[_Parts], str]]] = {
    "f": lambda parts: f"({parts['num']})/({parts['den']})",
    "sSup": _power,
    "sSub": lambda parts: f"{parts['e']}_{_index(parts['sub'])}",
    "sSubSup": lambda parts: f"{parts['e']}_{_index(parts['sub'])}^({parts['sup']})",
    "rad": _root,
    "func": lambda parts: f"{parts['fName']}({parts['e']})",
    "d": _bracketed,
    "m": _matrix,
    **dict.fromkeys(
        ("nary", "limLow", "limUpp", "eqArr", "groupChr", "acc", "sPre"), lambda _: "(formula)"
    ),
}
