"""Split a MATLAB matrix into rows at semicolons or line ends, and rows at commas or blanks."""

from service.expressions.errors import Note
from service.grids.cutting.blanks import split_blanks
from service.grids.cutting.grid import GridError
from service.grids.cutting.pairs import split
from service.grids.cutting.source_text import SourceText
from service.translations import say


def rows(content: SourceText) -> tuple[list[list[SourceText]], tuple[Note, ...]]:
    """Return the values of each row, with notes if the text is ambiguous.

    Raises GridError if splitting at commas and splitting at blanks give different matrices.
    """
    lines = split(content, ";\r\n")
    lines = [line.strip() for line in lines if line.text.strip(" \t,")]
    by_commas = [_without_last_empty(split(line, ",")) for line in lines]
    by_blanks, signs = _by_blanks(by_commas)
    if list(map(len, by_commas)) == list(map(len, by_blanks)):
        return by_commas, ()
    if all(len(row) == 1 for row in by_commas) or not _is_rectangle(by_commas):
        return by_blanks, _sign_notes(signs)
    if _is_rectangle(by_blanks):
        raise _ambiguous(by_commas, by_blanks)
    message = say(
        "Commas separate the values here, so spaces inside a value were read as products and sums."
    )
    return by_commas, (Note("commas_separate", message, content.whole),)


def _by_blanks(
    by_commas: list[list[SourceText]],
) -> tuple[list[list[SourceText]], list[SourceText]]:
    found: list[list[SourceText]] = []
    signs: list[SourceText] = []
    for row in by_commas:
        elements: list[SourceText] = []
        for piece in row:
            separated = split_blanks(piece)
            elements += separated.elements or (piece,)
            signs += separated.signs
        found.append(elements)
    return found, signs


def _without_last_empty(row: list[SourceText]) -> list[SourceText]:
    return row[:-1] if len(row) > 1 and not row[-1].text.strip() else row


def _is_rectangle(found: list[list[SourceText]]) -> bool:
    return len({len(row) for row in found}) == 1


def _sign_notes(signs: list[SourceText]) -> tuple[Note, ...]:
    if not signs:
        return ()
    sign = signs[0]
    message = say(
        "The space before {value} begins a new value, as in MATLAB; a difference has spaces on "
        "both sides of the sign, or none.",
        value=sign.text[:20],
    )
    return (Note("blank_before_sign", message, sign.whole),)


def _ambiguous(by_commas: list[list[SourceText]], by_blanks: list[list[SourceText]]) -> GridError:
    at = next(i for i, row in enumerate(by_commas) if len(row) != len(by_blanks[i]))
    row, longer = by_commas[at], by_blanks[at]
    return GridError(
        "mixed_separators",
        say(
            "This row has {few} values if only commas separate them, and {many} if spaces do, too. "
            "Write commas between all values.",
            few=len(row),
            many=len(longer),
        ),
        (row[0].whole[0], row[-1].whole[1]),
    )
