"""All formats of grids, in the order in which they are tried."""

import re
from dataclasses import replace
from typing import Final

from service.grids.cutting.grid import Grid, GridError, GridFormat, too_many_cells
from service.grids.cutting.limits import GRID_LIMITS
from service.grids.cutting.line_ends import without_last_signs
from service.grids.cutting.once import remembers
from service.grids.cutting.source_text import SourceText
from service.grids.formats.columns import FORMAT as COLUMNS
from service.grids.formats.csv import FORMAT as CSV
from service.grids.formats.data_frame import without_frame
from service.grids.formats.decimal_commas import with_decimal_points
from service.grids.formats.html import FORMAT as HTML
from service.grids.formats.html import struck_out
from service.grids.formats.latex import FORMAT as LATEX
from service.grids.formats.markdown import FORMAT as MARKDOWN
from service.grids.formats.named_values import FORMAT as NAMED_VALUES
from service.grids.formats.semicolons import FORMAT as SEMICOLONS
from service.grids.formats.stacked import FORMAT as STACKED
from service.grids.formats.tsv import FORMAT as TSV
from service.grids.matrices.bracketed import FORMAT as BRACKETED
from service.grids.matrices.drawn_matrix import FORMAT as DRAWN_MATRIX
from service.grids.matrices.eigen import FORMAT as EIGEN
from service.grids.matrices.identity import identity
from service.grids.matrices.maple import FORMAT as MAPLE
from service.grids.matrices.matlab_rows import FORMAT as MATLAB_ROWS
from service.grids.matrices.word import FORMAT as WORD
from service.grids.scripts.given_values import (
    check_script,
    without_definitions,
    without_given_values,
)
from service.grids.scripts.later_statements import without_print, without_uses
from service.grids.scripts.named_columns import describes_columns, read_columns
from service.grids.scripts.program_text import without_function, without_title
from service.grids.scripts.renamed_symbols import with_own_symbols
from service.grids.scripts.robot_script import describes_robot, read_script
from service.grids.scripts.script import RobotTable
from service.grids.scripts.session import session_outputs
from service.grids.scripts.styled_names import without_styles
from service.grids.scripts.titles import (
    without_docstrings,
    without_fence,
    without_pictures,
    without_titles,
)
from service.grids.scripts.toolbox_print import describes_print, read_print
from service.regex import regex
from service.time_slices import checkpoint
from service.translations import say

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
# The formats in which a comma separates no cells.
_WITHOUT_COMMAS: Final = (HTML, MARKDOWN, TSV, SEMICOLONS)

_SEPARATORS: Final = (*",;&|│┃║\t\n\r\x85\u2028\u2029", "<t", "<T", "\\\\")

# Separators and signs of Chinese keyboards.
FULL_WIDTH: Final = str.maketrans("，；（）｜＝－＋：［］【】｛｝＆＠　", ",;()|=-+:[][]{}&@ ")

# The first line of a CSV file that names its separator to a spreadsheet.
_SEPARATOR_LINE: Final = regex(r"sep=[;,|\t]\r?\n", re.IGNORECASE)

# Struck-out text, as Markdown writes it. Readers of files write it in the same way.
_STRUCK_OUT: Final = regex(r"(?<!~)~~(?=[^\s~])[^~\n]{1,400}~~(?!~)")

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
    if describes_print(text) and not describes_robot(text):
        return read_print(_limited(text))
    if describes_robot(text):
        return read_script(_limited(text))
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
    if sum(map(text.count, _SEPARATORS)) - text.count(_THIN_SPACE) > GRID_LIMITS.separators:
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
