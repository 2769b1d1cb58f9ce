"""Read a pasted table or matrix as a grid of cells.

This package knows how scripts describe robots, but nothing of kinematics. It imports only spans,
errors and function names from ``dh_grader.expressions``.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import Final

from dh_grader.pasting.around import (
    ASSIGNMENT,
    check_script,
    without_definitions,
    without_docstrings,
    without_fence,
    without_given_values,
    without_pictures,
    without_titles,
    without_tuples,
)
from dh_grader.pasting.latex import LATEX, named_matrices
from dh_grader.pasting.matrices import (
    BRACKETED,
    DRAWN_MATRIX,
    EIGEN,
    MAPLE,
    MATLAB_ROWS,
    WORD,
    identity,
    list_lines,
)
from dh_grader.pasting.named_columns import (
    describes_columns,
    describes_print,
    read_columns,
    read_print,
)
from dh_grader.pasting.program import (
    MAKERS,
    TAIL,
    session_outputs,
    with_own_symbols,
    without_function,
    without_harmless_lines,
    without_remarks,
    without_styles,
    without_title,
)
from dh_grader.pasting.robots import describes_robot, read_script
from dh_grader.pasting.source import (
    CLOSES,
    GRID_LIMITS,
    Grid,
    GridCell,
    GridError,
    GridFormat,
    GridLimits,
    RobotTable,
    SourceText,
    remembers,
    split,
    strict_pairs,
    too_many_cells,
    too_many_matrices,
    without_last_signs,
)
from dh_grader.pasting.tables import (
    COLUMNS,
    CSV,
    HTML,
    MARKDOWN,
    NAMED_VALUES,
    SEMICOLONS,
    STACKED,
    TSV,
    struck_out,
    with_decimal_points,
    without_frame,
)
from dh_grader.pasting.uses import without_print, without_uses
from dh_grader.regex import regex
from dh_grader.slices import checkpoint
from dh_grader.translations import say

__all__ = [
    "ASSIGNMENT",
    "FORMATS",
    "FULL_WIDTH",
    "GRID_LIMITS",
    "Grid",
    "GridCell",
    "GridError",
    "GridLimits",
    "NamedGrid",
    "RobotTable",
    "SourceText",
    "read_grid",
    "read_grids",
    "read_robot",
    "without_tuples",
]


# --- All formats of grids, in the order in which they are tried


# Formats with sure signs (tags, commands, brackets) come first, then separators, then blanks.
FORMATS: Final[tuple[GridFormat, ...]] = (
    NAMED_VALUES, STACKED, EIGEN, MAPLE, HTML, WORD,
    LATEX, DRAWN_MATRIX, BRACKETED, MARKDOWN, MATLAB_ROWS,
    TSV, SEMICOLONS, CSV, COLUMNS,
)  # fmt: skip

# The formats in which a sign separates cells.
_SEPARATED: Final = FORMATS[FORMATS.index(MARKDOWN) :]
# The formats in which any line may be a row.
_PLAIN: Final = (TSV, SEMICOLONS, CSV, COLUMNS)
# The formats in which a comma inside a cell separates nothing: the cells of CSV are quoted then.
_WITHOUT_COMMAS: Final = (HTML, MARKDOWN, TSV, SEMICOLONS, CSV)

_SEPARATORS: Final = (*",;&|│┃║\t\n\r\x85\u2028\u2029", "<t", "<T", "\\\\")

# Separators and signs of Chinese keyboards.
FULL_WIDTH: Final = str.maketrans("，；（）｜＝－＋：［］【】｛｝＆＠　", ",;()|=-+:[][]{}&@ ")

# The first line of a CSV file that names its separator to a spreadsheet.
_SEPARATOR_LINE: Final = regex(r"sep=[;,|\t]\r?\n", re.IGNORECASE)

# Struck-out text, as Markdown or LaTeX write it. Readers of files write it as Markdown does.
_STRUCK_OUT: Final = regex(
    r"(?<!~)~~(?=[^\s~])[^~\n]{1,400}~~(?!~)"
    r"|\\(?:sout|xout|st|hcancel|[bx]?cancel(?:to)?)(?![A-Za-z])\s{0,9}\{[^{}\n]{1,400}\}?"
)

# LaTeX's thin space, which is written between factors and contains a comma.
_THIN_SPACE: Final = "\\,"


@remembers
def read_grid(text: str, *, of_table: bool = False) -> Grid:
    """Return the grid in a pasted text, in linear time. Raises only GridError, for any text."""
    # The length of the text is bounded by ``GRID_LIMITS``. With ``of_table``, later statements of a
    # script may use the grid: it is the answer, and their results are not.
    source = pasted_source(text)
    if not of_table and (named := identity(source)):
        return named
    if NAMED_VALUES.matches(source.text):
        # The label of the first row would be a title.
        return NAMED_VALUES.parse(source)
    source = without_function(source)
    if of_table:
        source = without_print(without_uses(source))
    source, pictures = without_pictures(source)
    source, defined = without_definitions(source)
    source, titles = without_titles(without_frame(without_title(source)), of_table=of_table)
    source, values = without_given_values(source)
    notes = (*pictures, *defined, *titles, *values)
    found = grid_of(source)
    return replace(found, notes=(*notes, *found.notes)) if notes else found


@remembers
def read_robot(text: str) -> RobotTable | None:
    """Return the DH table of the robot that a pasted script describes; None for any other text.

    Raises GridError if the table is not certain. Takes linear time.
    """
    if describes_robot(text):
        return read_script(_limited(text))
    if describes_print(text):
        return read_print(_limited(text))
    return read_columns(_limited(text)) if describes_columns(text) else None


def pasted_source(text: str, *, named: bool = False) -> SourceText:
    """Return a pasted text without the prompts of an interpreter.

    Raises GridError if the text is empty or too long.
    """
    # With ``named``, the name typed at a prompt becomes a heading above its output.
    return without_styles(session_outputs(_limited(text), named=named))


def _limited(text: str) -> SourceText:
    if len(text) > GRID_LIMITS.characters:
        most = GRID_LIMITS.characters
        message = say(
            "A pasted text has at most {most:,} characters; yours has {found:,}.",
            most=most,
            found=len(text),
        )
        raise GridError("too_long", message, (most, len(text)))
    plain = SourceText.of(text)
    plain = replace(plain, text=text.translate(FULL_WIDTH))
    if struck := _STRUCK_OUT.search(plain.text):
        raise struck_out(plain.span(*struck.span()))
    source = without_fence(plain.strip("\ufeff"))
    if separator := _SEPARATOR_LINE.match(source.text):
        source = source.cut(separator.end(), len(source.text))
    if not source.text.strip():
        raise GridError("empty", say("Nothing is written here."), (0, len(text)))
    separators = sum(map(plain.text.count, _SEPARATORS)) - plain.text.count(_THIN_SPACE)
    if separators > GRID_LIMITS.separators:
        raise too_many_cells((0, len(text)))
    return with_own_symbols(without_docstrings(source))


def grid_of(source: SourceText) -> Grid:
    """Return the grid in a piece of a pasted text. Raises GridError if there is none."""
    found = _format_of(source)
    if found in _SEPARATED:
        source = without_last_signs(source)
        found = _format_of(source)
    if found in _PLAIN:
        check_script(source)
    if found in _WITHOUT_COMMAS:
        return with_decimal_points(found.parse(source))
    if found:
        return found.parse(source)
    raise GridError(
        "no_grid",
        say(
            "This was not recognised as a table or matrix. Write each row on a line of "
            "its own with commas between the values, or paste a table from a "
            "spreadsheet, Markdown, LaTeX, MATLAB or Python."
        ),
        source.whole,
    )


def _format_of(source: SourceText) -> GridFormat | None:
    for candidate in FORMATS:
        checkpoint()
        if candidate.matches(source.text):
            return candidate
    return None


# --- Several matrices in one pasted text, each with the name before it
#
# The text may be ``A1 = […]`` above ``A2 = […]``, a list of matrices, or LaTeX with several
# environments.


_HIDDEN: Final = "\x01"
# A name such as A_1, T(q1) or A{2}; the content of its brackets is masked.
_NAME: Final = (
    r"(?:\{\})?(?!\d+[.*\s])[\w\\{^]"
    rf"(?:[\w.^\\'*@→ \t]|[({{\[]{_HIDDEN}{{0,40}}[)}}\]]){{0,48}}"
)
_NUMBERED: Final = r"(?:[A-Za-z]{1,14}[ \t]{1,3}){0,3}[A-Za-z_^]{0,4}[\d_^→]{1,8}"
_HEADING: Final = regex(
    rf"(?:^|[;,\n])[ \t]*(?P<name>{_NAME})(?::=|[:=])(?!=)"
    rf"|(?:^|\n)[ \t]*(?P<line>{_NUMBERED})[ \t]*(?=\r?\n)"
)
_COMMENT: Final = regex(rf"^[ \t]*(?:%+|#+|//+)[ \t]*({_NUMBERED})[ \t:=]*$", re.MULTILINE)
_PRODUCT: Final = regex(r"(?:[A-Za-z]{1,12}\()?[^\W\d]\w{0,20}(?:\s?[*@.]\s?[^\W\d]\w{0,20})+\)?")
_PROSE: Final = regex(r"[^\W\d]{0,20}(?:[ \n,.:;]{1,3}[^\W\d]{1,20}){0,40}")
# The brackets of a matrix, of a list around it, and of a function around the list.
_NESTING: Final = 3
# Each row of each matrix may be in brackets of its own.
_MOST_GROUPS: Final = GRID_LIMITS.rows**2
_GROUP: Final = regex(
    rf"(?:(?<![\w.])(?P<maker>[A-Za-z_][\w.]{{0,60}})[ \t]*)?[\[({{]{_HIDDEN}*[\])}}]"
)
_BLANK_LINES: Final = regex(r"\n(?:[ \t]*\r?\n)+")


@dataclass(frozen=True, slots=True)
class NamedGrid:
    """One of several matrices, or the error if the matrix cannot be read.

    ``name`` is the name before the matrix, or "".
    """

    name: SourceText
    grid: Grid | GridError


@remembers
def read_grids(text: str) -> tuple[NamedGrid, ...]:
    """Return the matrices in a pasted text, in order.

    Raises GridError if the text cannot be split into matrices. Takes linear time.
    """
    source = pasted_source(text, named=True)
    is_latex = LATEX.matches(source.text)
    pieces = named_matrices(source) if is_latex else _named_pieces(source)
    # Names and products alone are no matrix: let the reader of a matrix refuse the text.
    pieces = pieces or [(source.cut(0, 0), source)]
    if len(pieces) > GRID_LIMITS.matrices:
        raise too_many_matrices(source.whole)
    found = [NamedGrid(name, _read(piece)) for name, piece in pieces]
    return tuple(each for i, each in enumerate(found) if not _is_made_later(each, found[i + 1 :]))


def _is_made_later(each: NamedGrid, later: Sequence[NamedGrid]) -> bool:
    # True if a later matrix has the same name, and ``each`` is only a formula for it.
    # ``A1 = trotz(q1)`` above ``A1 = […]`` is an example.
    name = each.name.text
    if not isinstance(each.grid, GridError) or each.grid.code != "no_grid" or not name:
        return False
    return any(name == other.name.text for other in later)


def _read(piece: SourceText) -> Grid | GridError:
    try:
        return identity(piece) or grid_of(piece)
    except GridError as error:
        return error


def _named_pieces(source: SourceText) -> list[tuple[SourceText, SourceText]]:
    source = without_remarks(_headings_out_of_comments(source))
    source = without_harmless_lines(source)
    nameless = source.cut(0, 0)
    return [
        (nameless if i else name, piece)
        for name, content in _labelled(source)
        for i, piece in enumerate(_listed(content))
    ]


def _headings_out_of_comments(source: SourceText) -> SourceText:
    """Return the text with each comment line ``% A1`` replaced by the heading ``A1``."""
    return source.replaced(_COMMENT, lambda text, comment: [text.cut(*comment.span(1))])


def _masked(source: SourceText) -> str:
    pieces, start, after = [], 0, 0
    text = source.text
    ends = strict_pairs(source)
    for at in sorted(ends):
        if at >= after:
            after = ends[at]
            pieces += [text[start : at + 1], _HIDDEN * (after - at - 2)]
            start = after - 1
    return "".join([*pieces, text[start:]])


def _labelled(source: SourceText) -> Iterator[tuple[SourceText, SourceText]]:
    name, start = source.cut(0, 0), 0
    for heading in _HEADING.finditer(_masked(source)):
        content = source.cut(start, heading.start())
        following = source.cut(*heading.span(heading.lastgroup or 0)).strip()
        if _holds_something(content):
            yield name, content
            name = following
        elif "\n" in source.text[start : heading.start() + 1] or not start:
            # T = A1*A2 = […] keeps its first name.
            name = following
        start = heading.end()
    content = source.cut(start, len(source.text))
    if not start or not _PRODUCT.fullmatch(content.text.strip(TAIL)):
        yield name, content


def _holds_something(content: SourceText) -> bool:
    # True unless the text is only prose or a product of named matrices.
    text = content.text.strip(TAIL)
    is_name = _PRODUCT.fullmatch(text) or _PROSE.fullmatch(text)
    return not is_name or identity(content) is not None


def _listed(content: SourceText) -> list[SourceText]:
    """Split a text without names into matrices: a list, consecutive brackets, or blocks."""
    inner = content
    for _ in range(_NESTING):
        groups = _groups(inner)
        if len(groups) > 1 and all(_is_matrix(group) for group in groups):
            return groups
        if len(groups) != 1:
            break
        inner = _content(groups[0])
    blocks = [block for block in content.split(_BLANK_LINES) if block.text.strip(TAIL)]
    if len(blocks) > 1 and all("\n" in block.text.strip() for block in blocks):
        return blocks
    return [content]


def _groups(content: SourceText) -> list[SourceText]:
    masked = _masked(content)
    groups = list(islice(_GROUP.finditer(masked), _MOST_GROUPS + 1))
    if len(groups) > _MOST_GROUPS or _GROUP.sub("", masked).strip(TAIL):
        return []
    return [content.cut(*group.span()) for group in groups]


def _content(group: SourceText) -> SourceText:
    opened = next(i for i, letter in enumerate(group.text) if letter in CLOSES)
    return group.cut(opened + 1, len(group.text) - 1)


def _is_matrix(group: SourceText) -> bool:
    """True if a bracket is a matrix and not a row."""
    # The bracket may be the argument of a function.
    content = _content(group)
    maker = group.text[: len(group.text) - len(content.text) - 2].strip().rpartition(".")[2]
    if maker:
        return maker in MAKERS
    return len(split(content, ";")) > 1 or list_lines(content) is not None
