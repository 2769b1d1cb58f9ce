"""Matrices of Eigen in C++: ``R << 1, 0, 0, 1;``, with or without the declaration of ``R``."""

import re
from typing import Final

from service.grids.cutting.grid import Grid, GridFormat, grid
from service.grids.cutting.source_text import SourceText, joined
from service.grids.matrices import lists
from service.grids.scripts.program_text import WrittenMatrix, text_around
from service.regex import regex

_COMMENT: Final = regex(r"//[^\n]*")
_MATRIX: Final = regex(
    r"(?:\s*(?:#include|using)\b[^\n]{0,80}\n)*"
    r"(?:\s*(?:Eigen::)?Matrix(?:(?P<size>[2-6])[df]|X[df]|"
    r"<\w{1,12}, ?(?P<rows>\d), ?(?P<columns>\d)>)"
    r"\s+(?P<declared>\w{1,40})(?: ?\((?P<height>\d), ?(?P<width>\d)\))?\s*;)?"
    r"\s*(?P<name>[A-Za-z]\w{0,40})\s*<<(?P<values>[^;<>=]+)"
)
_SHOWN: Final = r"[\s;]*(?:(?:std::)?cout\s?<<\s?{name}(?:\s?<<[^;<=]{{1,20}})?[\s;]*)?"


def _found(text: str) -> re.Match[str] | None:
    found = _MATRIX.match(text) if "<<" in text else None
    return found if found and "," in found["values"] else None


def _parse(source: SourceText) -> Grid:
    plain = joined(source.split(_COMMENT), source.at)
    found = _found(plain.text)
    if found is None or (found["declared"] or found["name"]) != found["name"]:
        raise text_around(plain)
    rest = plain.cut(found.end(), len(plain.text))
    if not re.fullmatch(_SHOWN.format(name=found["name"]), rest.text):
        raise text_around(rest.strip(" \n;"))
    content = plain.cut(*found.span("values"))
    height = found["size"] or found["rows"] or found["height"]
    width = found["size"] or found["columns"] or found["width"]
    if height:
        # Eigen fills row by row, wherever the lines end.
        rows = lists.flat(content, WrittenMatrix((), shape=(int(height), int(width))))
    else:
        rows = lists.rows([line for line in content.lines() if line.text.strip()])
    return grid("Eigen", rows, source.whole)


FORMAT: Final = GridFormat(lambda text: _found(_COMMENT.sub("", text)) is not None, _parse)
